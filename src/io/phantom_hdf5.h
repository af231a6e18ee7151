// Dumps of the SPH code Phantom in HDF5.
#pragma once

#include <memory>

#include "io/hdf5_file.h"
#include "io/reader.h"

namespace motes {

bool is_phantom_hdf5(const Hdf5File& file);

/// `file` is open and Phantom's. Lengths are in code units, whose size `length_unit` tells. `h` is
/// the code's smoothing length, `radius` 0.548 h: its kernel ends at 2h; both are negative for
/// particles that were accreted. Sink particles are left
/// out, with a warning.
std::unique_ptr<Trajectory> open_phantom_hdf5(Hdf5File file, const ReadOptions& options);

}  // namespace motes
