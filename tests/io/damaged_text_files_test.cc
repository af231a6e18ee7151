// Damaged files of the text formats.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "io/reader.h"
#include "support/shared_data.h"

namespace motes {
namespace {

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
    for (const std::string& line : warnings.lines()) {
      EXPECT_THAT(line, testing::Not(testing::HasSubstr("has no end"))) << "the error says it";
    }
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
        DamagedFile{"bad/MnO.misnumbered.poscar", ":32: the file ends after 24 of 36 atoms"},
        DamagedFile{"bad/made/cif_cut_in_loop.cif", ":159: Wrong number of values in the loop"},
        DamagedFile{"bad/made/dump_cut.dump.gz", "", 2},
        DamagedFile{"bad/made/dump_second_frame_cut.dump", "", 1},
        DamagedFile{"bad/made/dump_zero_box.dump", ":5: expected a box with a volume"},
        DamagedFile{"bad/made/extxyz_cut_mid_line.xyz", ":140: the file ends after 137 of 192"},
        DamagedFile{"bad/made/gro_count_too_small.gro", ":1003: expected the 3 or 9 numbers"},
        DamagedFile{"bad/made/xyz_count_too_big.xyz", ":6: the file ends after 3 of 999999999"},
        DamagedFile{"bad/made/xyz_nan_inf.xyz", "", 1}));

}  // namespace
}  // namespace motes
