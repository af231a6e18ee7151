// Looks along a coarse grid of rays, so that transfer functions can be fitted to what a view shows.
#pragma once

#include <vector>

#include "core/report.h"
#include "field/kernel_set.h"
#include "render/grid_fields.h"
#include "scene/camera.h"
#include "scene/fit.h"

namespace motes {

/// One profile a field, for the picture of that camera and size. Deterministic. Where many kernels
/// overlap it takes fewer points. Outside of a grid its field counts as 0.
std::vector<RayProfiles> sample_view(const KernelSet& kernels, const Camera& camera, int width,
                                     int height, Progress* progress = nullptr,
                                     const GridFields& grids = {});

}  // namespace motes
