// Bonds between atoms: those of a file, or by distance where it has none.
#pragma once

#include <vector>

#include "core/report.h"
#include "particles/particle_set.h"

namespace motes {

/// Bonds by distance: two atoms are bonded where the distance d of the one to an image of the other
/// is
///
///     0.4 A < d <= r_i + r_j + 0.45 A
///
/// with the covalent radii of their elements (Cordero et al. 2008), but never two hydrogens: the
/// rule of OpenEye's OEDetermineConnectivity and of Open Babel. The file's length unit is taken for
/// angstrom. Species that are no elements, and positions that are not finite, have no bonds. In a
/// small periodic cell an atom may be bonded to several images of another, and to its own.
///
/// Sorted by `first`, then `second`, then `image`. In parallel, n log n; the result does not depend
/// on the number of threads. Takes 48 bytes a particle while it works, and 12 a bond. Precondition:
/// fewer than 2^32 particles.
std::vector<Bond> find_bonds(const ParticleSet& particles);

/// The bonds that the particles came with, each once, sorted as above. Those of a particle to
/// itself are left out, with a warning that counts them.
std::vector<Bond> file_bonds(const ParticleSet& particles, Warnings& warnings);

}  // namespace motes
