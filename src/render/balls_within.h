// Balls inside of isosurfaces, which hide far light in their place.
#pragma once

#include <optional>
#include <vector>

#include "field/kernel_set.h"
#include "scene/isosurface.h"
#include "surface/surface.h"

namespace motes {

/// Where a kernel alone exceeds an opaque level, a field of kernels that are all positive does too:
/// balls there, a little smaller, are within the isosurface, and what meets one meets that first.
/// nullopt if there are none: no such fields, levels or peaks. Tabulated kernels have none, which
/// may rise again. In parallel.
std::optional<Surface> balls_within(const KernelSet& kernels,
                                    const std::vector<ResolvedIsosurface>& isosurfaces);

}  // namespace motes
