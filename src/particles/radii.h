// The radius that a particle gets when nobody gives one.
#pragma once

#include <string>
#include <vector>

#include "core/report.h"
#include "particles/particle_set.h"

namespace motes {

/// Whether particles have sizes of their own, as those of SPH and N-body codes do: the property
/// "radius", or one to be found from neighbours.
bool has_sizes(const ParticleSet& particles);

struct DefaultRadii {
  std::vector<float> radius;  ///< standard deviations: one a particle, or one for all
  std::string source;         ///< where they come from, a phrase for the user
};

/// The first of these that there is:
/// - where has_sizes(): the property "radius", which readers derive from smoothing lengths; and
///   with `radii_from_neighbors`, for particles without one, the standard deviation of the cubic
///   spline that reaches the 32nd nearest of the particles of the same species that are without one
///   too (0 where those coincide). That takes seconds a million particles, so it is done for those
///   `wanted` alone (all, where that is empty) and reports `progress`; the others without one get
///   NaN;
/// - the covalent radii of the species, where their names are elements and lengths are angstrom (or
///   unknown); species that are no elements get the mean of the others, with a warning, as long as
///   they are fewer than half of the particles;
/// - half the mean distance of nearest neighbours, over a sample of the particles: one value for
///   all, and 1 where no two particles lie apart.
DefaultRadii default_radii(const ParticleSet& particles, Warnings& warnings,
                           const std::vector<bool>& wanted = {}, Progress* progress = nullptr);

/// The `source` of default_radii(), without the search for neighbours that `radii_from_neighbors`
/// asks for.
std::string default_radii_source(const ParticleSet& particles);

/// Mean distance of particles to their nearest neighbour, over a sample that is always the same;
/// particles at one place are left out. 0 where no two particles lie apart. Length unit of the
/// particles.
double mean_neighbor_distance(const ParticleSet& particles);

}  // namespace motes
