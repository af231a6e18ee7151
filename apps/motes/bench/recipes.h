// How the benchmark's particles are made: from a few bundled blocks and boxes, always the same
// ones. Lengths are angstroms where nothing else is said. docs/bench.md tells what each stands for.
#pragma once

#include <cstddef>

#include "particles/particle_set.h"

namespace motes {

/// A molecule of tryptophan in the middle of a membrane of 40 lipids with water on both sides, laid
/// out by code: 6,830 atoms. The property "molecule" is 0, 1 or 2 for the three.
ParticleSet make_membrane();

/// The innermost `num_atoms` atoms of a hollow sphere carved from copies of `block`, a periodic
/// one; the inner radius is 0.55 of the outer one.
ParticleSet make_nanosphere(const ParticleSet& block, std::size_t num_atoms);

/// 13 x 5 x 4 copies of `block`, which is periodic, so that they join without seams; torn open
/// along a rough plane, with cavities ahead of the crack's front and thermal noise.
ParticleSet make_fractured_silica(const ParticleSet& block);

/// Three aluminium particles of 46 nm with a shell carved from copies of `alumina`, in a row, in
/// oxygen gas that brings the total to `num_atoms`. Species Al (core), AlO (shell's aluminium) and
/// O.
ParticleSet make_nanoparticles(const ParticleSet& alumina, std::size_t num_atoms);

/// Splits each particle of a cosmological box into `children`, spread around it by half the local
/// distance of particles, so that clustering and density stay those of the box. Lengths are in
/// units of the children's mean distance. `box` needs a cell and the property "h".
ParticleSet make_cosmology(const ParticleSet& box, std::size_t children);

}  // namespace motes
