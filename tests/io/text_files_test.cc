// Real files of the text formats, and damaged ones.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "io/reader.h"
#include "support/shared_data.h"

namespace motes {
namespace {

/// A file, and what its collection's description says of it.
struct RealFile {
  const char* path;
  const char* format;
  std::size_t num_particles;  ///< in the first frame
  std::size_t num_frames;
};

void PrintTo(const RealFile& file, std::ostream* out) { *out << file.path; }

class RealTextFiles : public testing::TestWithParam<RealFile> {};

TEST_P(RealTextFiles, OpenWithAllParticlesAndFrames) {
  const auto path = shared_file(GetParam().path);
  if (!path) GTEST_SKIP() << "no " << GetParam().path << " beside the checkout";
  const ReadOptions options;
  const auto trajectory = open_trajectory(*path, options);
  EXPECT_EQ(trajectory->format(), GetParam().format);
  const ParticleSet first = trajectory->read_frame(0);
  EXPECT_EQ(first.size(), GetParam().num_particles);
  EXPECT_EQ(trajectory->num_frames(), GetParam().num_frames);
  for (std::size_t frame = 1; frame < GetParam().num_frames; ++frame) {
    const ParticleSet particles = trajectory->read_frame(frame);
    EXPECT_FALSE(particles.bounds().empty());
    EXPECT_EQ(particles.species.empty(), first.species.empty());
  }
}

INSTANTIATE_TEST_SUITE_P(
    Shared, RealTextFiles,
    testing::Values(
        RealFile{"files/lammps_dump/CuZr_metallic_glass.dump.gz", "LAMMPS dump", 108000, 1},
        RealFile{"files/lammps_dump/NanocrystallinePd.dump.gz", "LAMMPS dump", 218901, 1},
        RealFile{"files/lammps_dump/albite_triclinic.dump", "LAMMPS dump", 17, 1},
        RealFile{"files/lammps_dump/chain_dump_1.lammpstrj", "LAMMPS dump", 22, 6},
        RealFile{"files/lammps_dump/crlf_wat.lammpstrj", "LAMMPS dump", 24, 3},
        RealFile{"files/lammps_dump/detect_best_pos_repr.lammpstrj", "LAMMPS dump", 854, 5},
        RealFile{"files/lammps_dump/nacl.lammpstrj", "LAMMPS dump", 512, 6},
        RealFile{"files/lammps_dump/ovito_simulation.dump", "LAMMPS dump", 7071, 1},
        RealFile{"files/lammps_dump/properties.lammpstrj", "LAMMPS dump", 4000, 4},
        RealFile{"files/lammps_dump/spce_all_coords.lammpstrj.bz2", "LAMMPS dump", 4500, 11},
        RealFile{"files/lammps_generated/ortho_lost_atoms.dump.gz", "LAMMPS dump", 147, 5},
        RealFile{"files/lammps_generated/tri_atom_scaled.dump", "LAMMPS dump", 864, 5},
        RealFile{"files/lammps_generated/tri_atom_unscaled_image.dump", "LAMMPS dump", 864, 5},
        RealFile{"files/lammps_generated/tri_cols_reordered.dump", "LAMMPS dump", 864, 5},
        RealFile{"files/lammps_generated/tri_no_id.dump", "LAMMPS dump", 864, 5},
        RealFile{"files/lammps_generated/tri_units_time.dump", "LAMMPS dump", 864, 5},
        RealFile{"files/lammps_generated/tri.data", "LAMMPS data", 864, 1},
        RealFile{"files/lammps_generated/charge.data", "LAMMPS data", 38, 1},
        RealFile{"files/lammps_data/additional_columns.data", "LAMMPS data", 10, 1},
        RealFile{"files/lammps_data/albite_triclinic.data", "LAMMPS data", 17, 1},
        RealFile{"files/lammps_data/data.body", "LAMMPS data", 100, 1},
        RealFile{"files/lammps_data/deletedatoms.data", "LAMMPS data", 10, 1},
        RealFile{"files/lammps_data/ifabp_apo_100mM.data.bz2", "LAMMPS data", 12421, 1},
        RealFile{"files/lammps_data/image_vf.data", "LAMMPS data", 7, 1},
        RealFile{"files/lammps_data/molid.lmp", "LAMMPS data", 12, 1},
        RealFile{"files/lammps_data/solvated.lmp", "LAMMPS data", 7772, 1},
        RealFile{"files/lammps_data/triclinic-2.lmp", "LAMMPS data", 0, 1},
        RealFile{"files/lammps_data/whitespaces.lmp", "LAMMPS data", 1, 1},
        RealFile{"files/xyz/2r9r-1b.xyz.bz2", "XYZ", 1284, 10},
        RealFile{"files/xyz/extended.xyz", "XYZ", 192, 3},
        RealFile{"files/xyz/methane.xyz", "XYZ", 5, 1}, RealFile{"files/xyz/mini.xyz", "XYZ", 3, 1},
        RealFile{"files/xyz/trajectory.xyz", "XYZ", 9, 2},
        RealFile{"files/xyz/water.6.xyz.gz", "XYZ", 297, 100},
        RealFile{"files/xyz/water.multistream.7.xyz.gz", "XYZ", 297, 100},
        RealFile{"files/xyz/water.xyz.xz", "XYZ", 297, 100},
        RealFile{"files/lammps_generated/tri_traj.xyz", "XYZ", 864, 5},
        RealFile{"files/gro/1vln-triclinic.gro", "GRO", 14520, 1},
        RealFile{"files/gro/YiiP_lipids.gro.gz", "GRO", 43480, 1},
        RealFile{"files/gro/bigbox.gro.bz2", "GRO", 132303, 1},
        RealFile{"files/gro/cod_4020641.gro", "GRO", 81, 1},
        RealFile{"files/gro/lysozyme.gro", "GRO", 1960, 3},
        RealFile{"files/gro/martini_dppc_chol_bilayer.gro", "GRO", 5040, 1},
        RealFile{"files/gro/residwrap.gro", "GRO", 126, 1},
        RealFile{"files/gro/sample_velocity_file.gro", "GRO", 6, 1},
        RealFile{"files/gro/two_water_gro_multiframe.gro", "GRO", 6, 2},
        RealFile{"files/gro/two_water_gro_widebox.gro", "GRO", 6, 1}));

/// A damaged file and a part of its Error; or "" and how many frames can be read.
struct DamagedFile {
  const char* path;
  const char* message;
  std::size_t num_frames = 0;
};

void PrintTo(const DamagedFile& file, std::ostream* out) { *out << file.path; }

class DamagedTextFiles : public testing::TestWithParam<DamagedFile> {};

TEST_P(DamagedTextFiles, AreRefusedOrReadUpToTheFault) {
  const auto path = shared_file(GetParam().path);
  if (!path) GTEST_SKIP() << "no " << GetParam().path << " beside the checkout";
  Warnings warnings;
  ReadOptions options;
  options.warnings = &warnings;
  const std::string expected = GetParam().message;
  const auto read = [&] {
    const auto trajectory = open_trajectory(*path, options);
    trajectory->read_frame(0);
    EXPECT_EQ(trajectory->num_frames(), GetParam().num_frames);
  };
  if (!expected.empty()) {
    EXPECT_THAT(read,
                testing::ThrowsMessage<Error>(testing::AllOf(
                    testing::StartsWith(path->string() + ":"), testing::HasSubstr(expected))));
  } else {
    EXPECT_NO_THROW(read());
  }
}

INSTANTIATE_TEST_SUITE_P(
    Shared, DamagedTextFiles,
    testing::Values(
        DamagedFile{"files/lammps_dump/spce_no_coords.lammpstrj.bz2",
                    ":9: expected columns with positions"},
        DamagedFile{"bad/atom-duplicated-id.lammpstrj", "", 1},
        DamagedFile{"bad/atom-no-item.lammpstrj", ":9: expected a line that begins with 'ITEM:'"},
        DamagedFile{"bad/atom-not-enough-lines.lammpstrj", ":12: the file ends after 2 of 3 atoms"},
        DamagedFile{"bad/box-item-name.lammpstrj", ":5: expected ITEM:"},
        DamagedFile{"bad/box-not-numbers.lammpstrj", ":6: expected a number of the box"},
        DamagedFile{"bad/box-wrong-size.lammpstrj", ":6: expected 3 numbers of the box, found 2"},
        DamagedFile{"bad/timestep-item-name.lammpstrj", ":1: expected ITEM:"},
        DamagedFile{"bad/extended_bad.xyz", ":3: expected 5 columns"},
        DamagedFile{"bad/helium_bad.xyz", ":7: the file ends after 4 of 8 atoms"},
        DamagedFile{"bad/empty_atom.gro", ":3: expected 1 atoms from here on, found 0"},
        DamagedFile{"bad/missing_atomname.gro", ":3: expected an atom name"},
        DamagedFile{"bad/test_incomplete_vel.gro", ":4: expected a velocity"},
        DamagedFile{"bad/truncated.gro", ":559: the file ends after 556 of 1405 atoms"},
        DamagedFile{"bad/made/dump_cut.dump.gz", "", 2},
        DamagedFile{"bad/made/dump_second_frame_cut.dump", "", 1},
        DamagedFile{"bad/made/dump_zero_box.dump", ":5: expected a box with a volume"},
        DamagedFile{"bad/made/extxyz_cut_mid_line.xyz", ":140: the file ends after 137 of 192"},
        DamagedFile{"bad/made/gro_count_too_small.gro", ":1003: expected the 3 or 9 numbers"},
        DamagedFile{"bad/made/xyz_count_too_big.xyz", ":6: the file ends after 3 of 999999999"},
        DamagedFile{"bad/made/xyz_nan_inf.xyz", "", 1}));

}  // namespace
}  // namespace motes
