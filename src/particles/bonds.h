// Bonds between atoms: those of a file, or by distance where it has none.
#pragma once

#include <vector>

#include "core/report.h"
#include "particles/particle_set.h"

namespace motes {

/// Bonds by distance: two atoms are bonded where the distance d of the one to the nearest image of
/// the other is
///
///     0.4 A < d <= r_i + r_j + 0.45 A
///
/// with the covalent radii of their elements (Cordero et al. 2008), but never two hydrogens: the
/// rule of OpenEye's OEDetermineConnectivity and of Open Babel. The file's length unit is taken for
/// angstrom. Species that are no elements, and positions that are not finite, have no bonds. Of an
/// atom that is within reach of several images of another the nearest counts, and of its own images
/// none.
///
/// Sorted by `first`, then `second`. In parallel, n log n; the result does not depend on the number
/// of threads. Takes 48 bytes a particle while it works, and 8 a bond. Precondition: fewer than
/// 2^32 particles.
std::vector<Bond> find_bonds(const ParticleSet& particles);

/// The bonds that the particles came with, each once, sorted as above. Those of a particle to
/// itself are left out, with a warning that counts them.
std::vector<Bond> file_bonds(const ParticleSet& particles, Warnings& warnings);

}  // namespace motes
