// The formats that the table lists; each is defined in the file that reads it.
#pragma once

#include "io/format.h"

namespace motes {

const Format& cif_format();
const Format& csv_format();
const Format& cube_format();
const Format& gro_format();
const Format& hdf5_format();
const Format& lammps_data_format();
const Format& lammps_dump_format();
const Format& npy_format();
const Format& pdb_format();
const Format& vasp_format();
const Format& xyz_format();

}  // namespace motes
