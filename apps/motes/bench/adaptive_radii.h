// Particles whose radii differ by orders of magnitude, made by code, always the same ones. Lengths
// are in units of the mean distance of particles.
#pragma once

#include <cstddef>
#include <span>
#include <string_view>

#include "particles/particle_set.h"

namespace motes {

/// One way for radii to differ.
struct AdaptiveRadii {
  std::string_view name, description;
  /// `count` particles in a cube, with the property "radius".
  ParticleSet (*make)(std::size_t count);
};

/// All ways: as in a cosmological run, as in a bad file, and a few huge kernels among small ones.
std::span<const AdaptiveRadii> adaptive_radii();

}  // namespace motes
