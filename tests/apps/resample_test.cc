// motes resample: the program's grids read back, its options and refusals.
#include <cmath>

#include "apps/command_line.h"
#include "io/grid_reader.h"

namespace motes {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

class ResampleCommand : public CommandLine {
 protected:
  ResampleCommand() {
    workspace_.write("two.json", R"({"version": 1, "data": {"path": "a.xyz"}, "fields": [
        {"name": "Si", "select": {"species": ["Si"]}, "radius": 1},
        {"name": "an O", "select": {"species": ["O"]}, "radius": 0.5}]})");
  }
  std::vector<Grid> grids(const std::string& name) { return read_grids(workspace_.path(name), {}); }
};

TEST_F(ResampleCommand, CoversTheVolumeWithTheField) {
  succeed("resample one.xyz -o a.vti --radius 1 --voxel-size 0.5");
  const auto read = grids("a.vti");
  ASSERT_EQ(read.size(), 1u);
  const Grid& grid = read[0];
  EXPECT_EQ(grid.name, "all");
  EXPECT_EQ(grid.dims, (std::array<std::size_t, 3>{9, 9, 9}));
  EXPECT_EQ(grid.origin, (Point3d{-2, -2, -2}));
  EXPECT_EQ(grid.steps[1], (Vector3d{0, 0.5, 0}));
  EXPECT_NEAR(grid.values[grid.index(4, 4, 4)], 1, 1e-6);
  EXPECT_NEAR(grid.values[grid.index(5, 4, 3)], std::exp(-0.25), 1e-6);
  EXPECT_EQ(grid.values[grid.index(8, 8, 8)], 0);
}

TEST_F(ResampleCommand, WritesTheSameInBothFormats) {
  for (const std::string options :
       {"--voxels 30", "--voxels 30x20x10 --kernel wendland_c4", "", "--support-factor 3"}) {
    succeed("resample a.xyz -o a.nrrd " + options);
    succeed("resample a.xyz -o a.vti --threads 1 " + options);
    const Grid nrrd = grids("a.nrrd")[0], vti = grids("a.vti")[0];
    EXPECT_EQ(nrrd.dims, vti.dims);
    EXPECT_EQ(nrrd.origin, vti.origin);
    EXPECT_EQ(nrrd.length_unit, "angstrom");
    EXPECT_TRUE(nrrd.values == vti.values);
  }
}

TEST_F(ResampleCommand, CountsAlongTheLongestOrAllSides) {
  succeed("resample a.xyz -o a.vti --radius 1 --voxels 17");
  EXPECT_EQ(grids("a.vti")[0].dims, (std::array<std::size_t, 3>{17, 9, 9}));
  EXPECT_EQ(grids("a.vti")[0].steps[2], (Vector3d{0, 0, 0.5}));
  succeed("resample a.xyz -o a.vti --radius 1 --voxels 3x4x5");
  EXPECT_EQ(grids("a.vti")[0].dims, (std::array<std::size_t, 3>{3, 4, 5}));
}

TEST_F(ResampleCommand, GivesEachFieldOfASceneItsGrid) {
  succeed("resample two.json -o a.vti --voxels 20");
  const auto vti = grids("a.vti");
  ASSERT_EQ(vti.size(), 2u);
  EXPECT_EQ(vti[0].name, "Si");
  EXPECT_EQ(vti[1].name, "an O");
  const std::size_t files = workspace_.num_files();
  succeed("resample two.json -o a.nrrd --voxels 20");
  EXPECT_EQ(workspace_.num_files(), files + 2);
  EXPECT_TRUE(grids("a_Si.nrrd")[0].values == vti[0].values);
  EXPECT_TRUE(grids("a_an_O.nrrd")[0].values == vti[1].values);
  EXPECT_EQ(grids("a_an_O.nrrd")[0].name, "an O");
}

TEST_F(ResampleCommand, RefusesWhatDoesNotFitIntoMemory) {
  EXPECT_THAT(
      failure("resample a.xyz -o a.nrrd --radius 1 --voxel-size 0.01 --memory 1MB", 1),
      HasSubstr("a.xyz: a grid of 801 x 401 x 401 samples takes 515 MB of memory, there are 1 MB; "
                "voxels of "));
  EXPECT_FALSE(workspace_.exists("a.nrrd"));
  succeed("resample a.xyz -o a.nrrd --radius 1 --voxel-size 0.1 --memory 1MB");
  // More than any machine has.
  EXPECT_THAT(failure("resample a.xyz -o b.nrrd --voxels 16777216", 1), HasSubstr("would fit"));
  EXPECT_THAT(failure("resample a.xyz -o b.nrrd --voxel-size 1e-30", 1),
              HasSubstr("expected at most 16777216"));
  EXPECT_FALSE(workspace_.exists("b.nrrd"));
}

TEST_F(ResampleCommand, AWrongCommandLineIsStatus2) {
  EXPECT_THAT(failure("resample a.xyz", 2), HasSubstr("--output"));
  EXPECT_THAT(failure("resample a.xyz -o a.png", 2), HasSubstr("ends in .nrrd or .vti"));
  for (const std::string bad : {"--voxel-size 0",
                                "--voxel-size -1",
                                "--voxel-size x",
                                "--voxel-size inf",
                                "--voxels 1",
                                "--voxels 0x5x5",
                                "--voxels 5x5",
                                "--voxels 5x5x5x5",
                                "--voxels 5x",
                                "--voxels x",
                                "--voxels 99999999",
                                "--voxels -5",
                                "--voxels 5 --voxel-size 1",
                                "--memory x",
                                "--memory 5XB",
                                "--memory ''",
                                "--memory nan",
                                "--memory -1",
                                "--threads 0",
                                "--size 5x5"}) {
    failure("resample a.xyz -o a.vti " + bad, 2);
  }
  EXPECT_FALSE(workspace_.exists("a.vti"));
}

TEST_F(ResampleCommand, WarnsOfVoxelsThatShowNothing) {
  EXPECT_EQ(run("resample a.xyz -o a.vti").err, "");
  const std::string err = run("resample a.xyz -o a.vti --voxel-size 1000").err;
  EXPECT_THAT(err, HasSubstr("motes: warning: the grid is a single voxel of 1000, for the volume"));
  EXPECT_THAT(err, HasSubstr("motes: warning: all 2 x 2 x 2 samples of the field 'all' are 0: they "
                             "are 1000 apart, its kernels"));
}

TEST_F(ResampleCommand, FailsWithoutHarm) {
  workspace_.write("a.vti", "old");
  workspace_.write("same.json", R"({"version": 1, "data": {"path": "a.xyz"},
      "fields": [{"name": "a/b"}, {"name": "a?b"}]})");
  EXPECT_THAT(failure("resample none.xyz -o a.vti", 1), StartsWith("motes: error: none.xyz: "));
  EXPECT_THAT(failure("resample a.xyz -o none/a.vti", 1), HasSubstr("none/a.vti: cannot write"));
  EXPECT_THAT(failure("resample a.xyz -o a.vti --radius none", 1), HasSubstr("--radius"));
  EXPECT_THAT(failure("resample a.xyz -o a.vti --kernel-scale 1e-50", 1),
              HasSubstr("expected a kernel_scale around"));
  succeed("resample a.xyz -o grid.vti --voxels 5");
  EXPECT_THAT(failure("resample grid.vti -o a.vti", 1), HasSubstr("is a grid already"));
  EXPECT_THAT(failure("resample same.json -o a.nrrd", 1), HasSubstr("'a_b'"));
  EXPECT_EQ(workspace_.read("a.vti"), "old");
  succeed("resample same.json -o b.vti --voxels 5");
  EXPECT_EQ(grids("b.vti").size(), 2u);
}

}  // namespace
}  // namespace motes
