// The table of formats; a new format is one line here and one in formats.h.
#include "io/formats.h"

namespace motes {

const std::vector<Format>& formats() {
  // Formats with an unmistakable mark come first, those that are guessed from a few lines last.
  // clang-format off
  static const std::vector<Format> table{
      hdf5_format(), npy_format(),         cif_format(),  pdb_format(),  lammps_dump_format(),
      gro_format(),  lammps_data_format(), cube_format(), vasp_format(), xyz_format(),
      csv_format(),
  };
  // clang-format on
  return table;
}

}  // namespace motes
