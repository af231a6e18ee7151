// What is written as a grid is read back the same.
#include "grid/write_grid.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "core/error.h"
#include "io/grid_reader.h"
#include "support/temporary_directory.h"

namespace motes {
namespace {

/// Values of any bits but NaN, in a skew lattice of up to `most` samples along each axis.
Grid random_grid(std::uint64_t seed, std::size_t most) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> number(-10, 10);
  Grid grid;
  grid.name = "field " + std::to_string(random() % 100);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    grid.dims[axis] = 1 + random() % most;
    const int a = static_cast<int>(axis);
    grid.origin[a] = 1e3 * number(random);
    grid.steps[axis] = {number(random), number(random), number(random)};
    grid.steps[axis][a] = std::copysign(40, grid.steps[axis][a]);  // volume, whatever the others
  }
  grid.values.resize(grid.size());
  std::uniform_real_distribution<float> exponent(-40, 40);
  for (float& v : grid.values) {
    v = std::pow(10.0F, exponent(random)) * (random() % 2 == 0 ? 1.0F : -1.0F);
  }
  grid.length_unit = random() % 2 == 0 ? "angstrom" : "unknown";
  return grid;
}

/// `steps`: to this relative precision.
void expect_same(const Grid& read, const Grid& written, double steps) {
  EXPECT_EQ(read.name, written.name);
  EXPECT_EQ(read.dims, written.dims);
  EXPECT_EQ(read.origin, written.origin);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    EXPECT_LE(length(read.steps[axis] - written.steps[axis]), steps * length(written.steps[axis]));
  }
  EXPECT_TRUE(read.values == written.values);
  EXPECT_FALSE(read.periodic);
}

class Sizes : public testing::TestWithParam<std::size_t> {};

// The larger ones are several blocks of compression and base64.
TEST_P(Sizes, OfNrrdComeBack) {
  const TemporaryDirectory directory;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const Grid grid = random_grid(seed, GetParam());
    for (const NrrdEncoding encoding : {NrrdEncoding::raw, NrrdEncoding::gzip}) {
      write_nrrd(directory / "a.nrrd", grid, encoding);
      const auto read = read_grids(directory / "a.nrrd", {});
      ASSERT_EQ(read.size(), 1u);
      expect_same(read[0], grid, 0);
      EXPECT_EQ(read[0].length_unit, grid.length_unit);
    }
  }
}

TEST_P(Sizes, OfVtiComeBack) {
  const TemporaryDirectory directory;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    std::vector<Grid> grids(1 + seed % 3, random_grid(seed, GetParam()));
    for (std::size_t i = 0; i < grids.size(); ++i) {
      grids[i].name += " & <\"" + std::to_string(i) + "\">";
      for (float& v : grids[i].values) v *= static_cast<float>(i + 1);
    }
    for (const VtiEncoding encoding : {VtiEncoding::raw, VtiEncoding::base64}) {
      write_vti(directory / "a.vti", grids, encoding);
      const auto read = read_grids(directory / "a.vti", {});
      ASSERT_EQ(read.size(), grids.size());
      // A step is the product of a length and a direction: four roundings.
      for (std::size_t i = 0; i < grids.size(); ++i) expect_same(read[i], grids[i], 1e-15);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Samples, Sizes, testing::Values(3, 100));

TEST(WriteGrid, KeepsNamesInOneLine) {
  const TemporaryDirectory directory;
  Grid grid = random_grid(1, 3);
  grid.name = "a\nb\"c";
  write_nrrd(directory / "a.nrrd", grid);
  EXPECT_EQ(read_grids(directory / "a.nrrd", {})[0].name, "a b c");
  write_vti(directory / "a.vti", std::span(&grid, 1));
  EXPECT_EQ(read_grids(directory / "a.vti", {})[0].name, "a b\"c");
}

TEST(WriteGrid, LeavesNothingWhereItCannotWrite) {
  const TemporaryDirectory directory;
  const Grid grid = random_grid(1, 3);
  EXPECT_THROW(write_nrrd(directory / "none" / "a.nrrd", grid), Error);
  EXPECT_THROW(write_vti(directory / "none" / "a.vti", std::span(&grid, 1)), Error);
  EXPECT_EQ(directory.num_entries(), 0u);
}

}  // namespace
}  // namespace motes
