// The search for bonds by distance, through the tree that rays meet the atoms in.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "field/kernel_set.h"
#include "particles/particle_set.h"

namespace motes {

/// The bonds by BondRule among some of the particles: those with among[particle] that are in
/// `kernels`, of which `particle_of` is what particles_in_order() gives. In a small periodic cell
/// an atom may be bonded to several images of another, and to its own.
///
/// Sorted. In parallel; the result depends neither on the number of threads nor on the order of the
/// kernels. Takes a byte a particle while it works, and 24 a bond.
std::vector<Bond> find_bonds(const ParticleSet& particles, const std::vector<bool>& among,
                             std::span<const std::uint32_t> particle_of, const KernelSet& kernels);

}  // namespace motes
