// Particles to a file that Motes reads fast: a structured NPY array.
#pragma once

#include "core/atomic_file.h"
#include "particles/particle_set.h"

namespace motes {

/// Writes x, y, z as 32-bit floats, species as text and properties as 32-bit floats; does not
/// commit. Precondition: the origin is zero.
void write_npy_particles(AtomicFile& file, const ParticleSet& particles);

}  // namespace motes
