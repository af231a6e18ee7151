// From a scene with open ends to one that can be rendered.
#pragma once

#include <vector>

#include "core/report.h"
#include "field/kernel_set.h"
#include "render/grid_fields.h"
#include "scene/fit.h"
#include "scene/scene.h"

namespace motes {

/// What cameras are fitted to: all that is seen (visible_spheres()), or, where that is nothing, the
/// ends of the particles' box. `kernels` are those of the sources.
std::vector<VisibleSphere> spheres_of_view(const ParticleSet& particles,
                                           const std::vector<FieldSource>& sources,
                                           const GeometrySource& geometry,
                                           const std::vector<Field>& fields,
                                           const KernelSet& kernels,
                                           const std::vector<ClipPlane>& clip_planes);

/// Fills in what `scene` leaves open: camera from the fields and `geometry`, step size from the
/// fields, transfer functions from what the view shows of them. `fields` are those that the scene
/// comes to and that are visible, `sources`, `kernels` and `grids` theirs. Throws Error for a
/// camera or a transfer function that cannot be.
ResolvedScene resolve(const Scene& scene, const ParticleSet& particles,
                      const std::vector<Field>& fields, const std::vector<FieldSource>& sources,
                      const GeometrySource& geometry, const KernelSet& kernels,
                      Progress* progress = nullptr, const GridFields& grids = {});

}  // namespace motes
