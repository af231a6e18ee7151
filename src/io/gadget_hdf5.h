// Snapshots in the HDF5 layout of GADGET: GADGET-2 to 4, AREPO, SWIFT, GIZMO; and bare tables of
// coordinates.
#pragma once

#include <memory>

#include "io/hdf5_file.h"
#include "io/reader.h"

namespace motes {

/// Whether the file has groups PartType0 to PartType6, or a dataset Coordinates at the root.
bool is_gadget_hdf5(const Hdf5File& file);

/// Opens the snapshot that `file` is (or is a part of: x.0.hdf5 opens all of x.N.hdf5). Particle
/// types become species: "gas", "dark matter", "disk", "bulge", "stars", "black holes",
/// "neutrinos". Lengths stay in the file's unit, comoving where the file's are. The file's
/// smoothing length is the property `h`; `radius` is the standard deviation of the code's kernel:
/// h/2 for SWIFT, else h/3.651, h being the radius of support. Without one it comes from mass and
/// density, else `radii_from_neighbors` is set: the 32nd nearest neighbour of the same type.
std::unique_ptr<Trajectory> open_gadget_hdf5(Hdf5File file, const ReadOptions& options);

}  // namespace motes
