// The radius that a particle gets when nobody gives one.
#pragma once

#include <string>
#include <vector>

#include "core/report.h"
#include "particles/particle_set.h"

namespace motes {

struct DefaultRadii {
  std::vector<float> radius;  ///< standard deviations: one a particle, or one for all
  std::string source;         ///< where they come from, a phrase for the user
};

/// The first of these that there is:
/// - the property "radius", which readers derive from smoothing lengths;
/// - the covalent radii of the species, where their names are elements and lengths are angstrom (or
///   unknown); species that are no elements get the mean of the others, with a warning, as long as
///   they are fewer than half of the particles;
/// - half the mean distance of nearest neighbours, over a sample of the particles: one value for
///   all, and 1 where no two particles lie apart.
DefaultRadii default_radii(const ParticleSet& particles, Warnings& warnings);

/// Mean distance of particles to their nearest neighbour, over a sample that is always the same;
/// particles at one place are left out. 0 where no two particles lie apart. Length unit of the
/// particles.
double mean_neighbor_distance(const ParticleSet& particles);

}  // namespace motes
