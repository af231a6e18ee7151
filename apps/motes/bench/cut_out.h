// Cubes cut out of particles, with an exact number of them.
#pragma once

#include <cstddef>
#include <vector>

#include "core/vec.h"
#include "particles/particle_set.h"

namespace motes {

/// A point about which cubes that should hold `counts` particles at the mean density of the whole
/// hold about as many: neither a void nor a cluster. Precondition: there are particles.
Point3d typical_center(const ParticleSet& particles, const std::vector<std::size_t>& counts);

/// The `count` particles that a cube around `center` comes to hold as it grows, in their order,
/// with species and properties. Precondition: there are as many.
ParticleSet cut_out(const ParticleSet& particles, const Point3d& center, std::size_t count);

}  // namespace motes
