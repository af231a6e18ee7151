// Trajectories in H5MD (de Buyl et al. 2014, https://www.nongnu.org/h5md/h5md.html).
#pragma once

#include <memory>

#include "io/hdf5_file.h"
#include "io/reader.h"

namespace motes {

bool is_h5md(const Hdf5File& file);

/// `file` is open and H5MD. Frames are read when asked for. Of several groups of particles all are
/// read, one after the other, and must have as many frames; without species, each group is a
/// species named as the group. Lengths in nm or pm become angstrom; others keep the file's unit.
/// Numbers of species get their names from `options`, the file (an enumeration, or an attribute
/// `names`), or, where the numbers are too large to be mere labels, as atomic numbers.
std::unique_ptr<Trajectory> open_h5md(Hdf5File file, const ReadOptions& options);

}  // namespace motes
