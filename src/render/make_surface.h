// Balls and sticks over the particles of a tree.
#pragma once

#include <optional>
#include <vector>

#include "field/kernel_set.h"
#include "particles/particle_set.h"
#include "scene/geometry.h"
#include "scene/scene.h"
#include "surface/surface.h"

namespace motes {

/// What draws `geometry`, whose particles are all in `kernels`; these were built from `sources` in
/// `order`, and must outlive the surface. A particle that several fields have is drawn once.
Surface make_surface(const ParticleSet& particles, const GeometrySource& geometry,
                     const std::vector<FieldSource>& sources, const KernelOrder& order,
                     const KernelSet& kernels);

/// What the tree needs to have the drawn particles that no field has, or nothing if there are none.
std::optional<FieldSource> find_drawn_only(const ParticleSet& particles,
                                           const GeometrySource& geometry,
                                           const std::vector<FieldSource>& sources);

}  // namespace motes
