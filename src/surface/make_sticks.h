// From bonds between particles to the sticks that are drawn of them.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/aligned.h"
#include "field/kernel_set.h"
#include "particles/particle_set.h"
#include "scene/scene.h"
#include "surface/surface.h"

namespace motes {

/// Which particle each kernel of a set is, in leaf order. `fields` and `order` are those that the
/// set was built with.
UninitializedVector<std::uint32_t> particles_in_order(const std::vector<FieldSource>& fields,
                                                      const KernelOrder& order);

/// Half of each bond for each kernel that is one of its ends; `particle_of` is what
/// particles_in_order() gives. In a periodic cell each half goes towards the nearest image of the
/// other end. Bonds between particles in one place have no direction and are left out.
/// radius: of all sticks, internal length.
Sticks make_sticks(const ParticleSet& particles, std::span<const Bond> bonds,
                   std::span<const std::uint32_t> particle_of, const KernelSet& kernels,
                   float radius);

}  // namespace motes
