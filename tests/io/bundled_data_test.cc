// The files that the repository brings with it: they open everywhere, with the numbers of
// data/README.md.
#include <gtest/gtest.h>

#include <filesystem>

#include "io/reader.h"

namespace motes {
namespace {

struct BundledFile {
  const char* path;
  const char* format;
  std::size_t num_particles;  ///< of the first frame
  std::size_t num_frames;
};

class BundledData : public testing::TestWithParam<BundledFile> {};

TEST_P(BundledData, OpensWithItsParticlesAndFrames) {
  const BundledFile& file = GetParam();
  Warnings warnings;
  ReadOptions options;
  options.warnings = &warnings;
  const auto trajectory =
      open_trajectory(std::filesystem::path(MOTES_SOURCE_DIR) / "data" / file.path, options);
  EXPECT_EQ(trajectory->format(), file.format);
  EXPECT_EQ(trajectory->read_frame(0).size(), file.num_particles);
  EXPECT_EQ(trajectory->num_frames(), file.num_frames);
}

INSTANTIATE_TEST_SUITE_P(
    Files, BundledData,
    testing::Values(BundledFile{"formats/charge.data", "LAMMPS data", 38, 1},
                    BundledFile{"formats/ortho_lost_atoms.dump.gz", "LAMMPS dump", 147, 5},
                    BundledFile{"formats/swift_cosmo_0002.hdf5", "SWIFT HDF5", 16000, 1},
                    BundledFile{"formats/tri_frame_00000.dump", "LAMMPS dump", 864, 1},
                    BundledFile{"demo/cosmo_64.hdf5", "GADGET HDF5", 262144, 1},
                    BundledFile{"demo/nanobowl_sio2_21k.xyz.gz", "XYZ", 21000, 1},
                    BundledFile{"demo/nanosphere_c_92k.lammpstrj.xz", "LAMMPS dump", 92000, 1},
                    BundledFile{"demo/silica_pull.lammpstrj.xz", "LAMMPS dump", 18075, 10},
                    BundledFile{"demo/zeolite_mfi_3494.xyz", "XYZ", 3494, 1}),
    [](const auto& param_info) {
      std::string name;
      for (const char c : std::string(param_info.param.path)) name += std::isalnum(c) ? c : '_';
      return name;
    });

}  // namespace
}  // namespace motes
