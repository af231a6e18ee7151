// Finding the format of a grid, and real files.
#include "io/grid_reader.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "io/grid_fixture.h"
#include "io/reader.h"
#include "support/shared_data.h"

namespace motes {
namespace {

using testing::HasSubstr;

TEST(ReadGrids, RefusesWhatIsNone) {
  EXPECT_EQ(grid_error("a.nrrd", ""), "a.nrrd: is empty; expected a grid");
  EXPECT_EQ(grid_error("a.xyz", "1\n\nH 0 0 0\n"),
            "a.xyz: is no grid of a known format; expected one of NRRD, VTI, cube, VASP");
  EXPECT_THAT(grid_error("a.cube.gz", "what is this\n"), HasSubstr("a.cube.gz:2:"))
      << "by its name";
  EXPECT_THROW(read_grids("/no/such/file", {}), Error);
}

TEST(IsGridFile, GoesByContentAndThenByName) {
  const TemporaryFile named("a.vti.xz", "damaged"), other("a.xyz", "1\n\nH 0 0 0\n"),
      empty("a.vti");
  EXPECT_TRUE(is_grid_file(named.path()));
  EXPECT_FALSE(is_grid_file(other.path()));
  EXPECT_FALSE(is_grid_file(empty.path()));
  EXPECT_THROW(is_grid_file("/no/such/file"), Error);
}

TEST(OpenTrajectory, SaysThatAGridHasNoParticles) {
  const TemporaryFile file("a.nrrd", "NRRD0004\n");
  EXPECT_THAT([&] { open_trajectory(file.path(), {}); },
              testing::ThrowsMessage<Error>(HasSubstr("a.nrrd: is a grid without particles")));
}

/// A grid of a real file, and what its description says.
struct KnownGrid {
  const char* path;
  std::size_t num_grids, index;  ///< which of them
  const char* name;
  std::array<std::size_t, 3> dims;
  bool periodic;
  double lowest, highest;  ///< values
  double integral;  ///< over the grid, or of the square; values per cubic bohr where a cube's are
  bool squared;
};

void PrintTo(const KnownGrid& grid, std::ostream* out) { *out << grid.path << " " << grid.name; }

/// Reads the file at `path`.
void expect_known(const std::filesystem::path& path, const KnownGrid& known) {
  EXPECT_TRUE(is_grid_file(path));
  const auto grids = read_grids(path, {});
  ASSERT_EQ(grids.size(), known.num_grids);
  const Grid& grid = grids[known.index];
  EXPECT_EQ(grid.name, known.name);
  EXPECT_EQ(grid.dims, known.dims);
  EXPECT_EQ(grid.periodic, known.periodic);
  const auto [low, high] = std::minmax_element(grid.values.begin(), grid.values.end());
  // The descriptions have two to four digits.
  EXPECT_NEAR(*low, known.lowest, 1e-2 * std::abs(known.lowest));
  EXPECT_NEAR(*high, known.highest, 1e-2 * known.highest);
  double sum = 0;
  for (const float v : grid.values) sum += known.squared ? double{v} * v : v;
  const double voxel = std::abs(dot(grid.steps[0], cross(grid.steps[1], grid.steps[2])));
  EXPECT_NEAR(sum * voxel, known.integral, 1e-3 * known.integral);
}

class BundledGrids : public testing::TestWithParam<KnownGrid> {};

TEST_P(BundledGrids, AreAsTheyAreDescribed) {
  expect_known(std::filesystem::path(MOTES_SOURCE_DIR) / "data" / GetParam().path, GetParam());
}

class SharedGrids : public testing::TestWithParam<KnownGrid> {};

TEST_P(SharedGrids, AreAsTheyAreDescribed) {
  const auto path = shared_file(GetParam().path);
  if (!path) GTEST_SKIP() << "no " << GetParam().path << " beside the checkout";
  expect_known(*path, GetParam());
}

constexpr double cubic_bohr = 0.529177210903 * 0.529177210903 * 0.529177210903;

INSTANTIATE_TEST_SUITE_P(Data, BundledGrids,
                         testing::Values(KnownGrid{"density/CHGCAR_iron.xz",
                                                   2,
                                                   0,
                                                   "density",
                                                   {30, 30, 30},
                                                   true,
                                                   0.190924,
                                                   5.99238,
                                                   16,
                                                   false},
                                         KnownGrid{"density/CHGCAR_iron.xz",
                                                   2,
                                                   1,
                                                   "spin",
                                                   {30, 30, 30},
                                                   true,
                                                   -0.0050 / cubic_bohr,
                                                   0.514 / cubic_bohr,
                                                   4.628,
                                                   false},
                                         KnownGrid{"density/quartz_density.cube.xz",
                                                   1,
                                                   0,
                                                   "value",
                                                   {45, 45, 54},
                                                   true,
                                                   0.00105,
                                                   0.976,
                                                   48 * cubic_bohr,
                                                   false},
                                         KnownGrid{"density/silicon_angstrom.cube.xz",
                                                   1,
                                                   0,
                                                   "value",
                                                   {32, 32, 32},
                                                   true,
                                                   0.00107,
                                                   0.0859,
                                                   8 * cubic_bohr,
                                                   false},
                                         KnownGrid{"density/caffeine_orbitals.cube.xz",
                                                   2,
                                                   1,
                                                   "orbital_38",
                                                   {45, 40, 25},
                                                   false,
                                                   -0.277,
                                                   0.277,
                                                   1.026 * cubic_bohr,
                                                   true}));

INSTANTIATE_TEST_SUITE_P(Shared, SharedGrids,
                         testing::Values(KnownGrid{"density/CHGCAR_quartz",
                                                   1,
                                                   0,
                                                   "density",
                                                   {45, 45, 54},
                                                   true,
                                                   0.00105 / cubic_bohr,
                                                   0.976 / cubic_bohr,
                                                   48,
                                                   false},
                                         KnownGrid{"density/silicon_density.cube",
                                                   1,
                                                   0,
                                                   "value",
                                                   {32, 32, 32},
                                                   true,
                                                   0.00107,
                                                   0.0859,
                                                   8 * cubic_bohr,
                                                   false},
                                         KnownGrid{"density/caffeine_density.cube.gz",
                                                   1,
                                                   0,
                                                   "value",
                                                   {90, 80, 50},
                                                   false,
                                                   3.0e-9,
                                                   1.172,
                                                   74 * cubic_bohr,
                                                   false},
                                         KnownGrid{"density/caffeine_homo.cube.gz",
                                                   1,
                                                   0,
                                                   "value",
                                                   {90, 80, 50},
                                                   false,
                                                   -0.278,
                                                   0.279,
                                                   1 * cubic_bohr,
                                                   true},
                                         KnownGrid{"density/iron_spin.cube.gz",
                                                   1,
                                                   0,
                                                   "value",
                                                   {30, 30, 30},
                                                   true,
                                                   -0.0050,
                                                   0.514,
                                                   4.628 * cubic_bohr,
                                                   false}));

}  // namespace
}  // namespace motes
