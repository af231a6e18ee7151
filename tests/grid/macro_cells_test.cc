// Macro-cells bound the field in them, and not by much more than it takes.
#include "grid/macro_cells.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "grid/grids.h"

namespace motes {
namespace {

TEST(MacroCells, BoundTheField) {
  for (const bool periodic : {false, true}) {
    const Grid grid = random_grid({21, 9, 30}, periodic, 2);
    for (const Reconstruction reconstruction : all_reconstructions) {
      const GridSampler sampler(grid, reconstruction);
      const MacroCells cells(sampler);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        EXPECT_EQ(cells.dims()[axis], (sampler.num_cells()[axis] + 7) / 8);
      }
      for (const auto& x : hull_points(sampler, 5000, 1)) {
        const double value = sampler.sample(sampler.to_world({x[0], x[1], x[2]}))->value;
        // A point on a face belongs to the blocks on either side.
        for (const double side : {-1e-9, 1e-9}) {
          std::array<int, 3> block{};
          for (std::size_t axis = 0; axis < 3; ++axis) {
            block[axis] = std::clamp(static_cast<int>((x[axis] + side) / MacroCells::size), 0,
                                     cells.dims()[axis] - 1);
          }
          const auto& range = cells.at(block[0], block[1], block[2]);
          EXPECT_LE(range.min, value);
          EXPECT_GE(range.max, value);
        }
      }
    }
  }
}

TEST(MacroCells, OfTrilinearAreThoseOfTheirSamples) {
  const Grid grid = random_grid({17, 20, 11}, false, 2);
  const MacroCells cells(GridSampler(grid, Reconstruction::trilinear));
  float low = 1, high = -1;
  for (std::size_t k = 8; k < 11; ++k) {
    for (std::size_t j = 8; j <= 16; ++j) {
      for (std::size_t i = 0; i <= 8; ++i) {
        low = std::min(low, grid.values[grid.index(i, j, k)]);
        high = std::max(high, grid.values[grid.index(i, j, k)]);
      }
    }
  }
  EXPECT_NEAR(cells.at(0, 1, 1).min, low, 1e-5);
  EXPECT_NEAR(cells.at(0, 1, 1).max, high, 1e-5);
}

// A single sample that is not zero: no block that it reaches into may count as empty.
TEST(MacroCells, SeeWhatReachesIntoThemFromOutside) {
  for (std::size_t spike = 0; spike < 21; ++spike) {
    for (const bool periodic : {false, true}) {
      Grid grid = grid_of({21, 2, 2}, [](const Point3d&) { return 0; });
      grid.periodic = periodic;
      for (std::size_t k = 0; k < 2; ++k) {
        for (std::size_t j = 0; j < 2; ++j) grid.values[grid.index(spike, j, k)] = 1;
      }
      for (const Reconstruction reconstruction : all_reconstructions) {
        const GridSampler sampler(grid, reconstruction);
        const MacroCells cells(sampler);
        for (int n = 0; n < 20 * sampler.num_cells()[0]; ++n) {
          const double x = n / 20. + 0.01;
          const double value = sampler.sample(sampler.to_world({x, 0.5, 0.5}))->value;
          const auto& range = cells.at(static_cast<int>(x) / MacroCells::size, 0, 0);
          EXPECT_LE(range.min, value) << x;
          EXPECT_GE(range.max, value) << x;
        }
      }
    }
  }
}

TEST(MacroCells, OfNothingAreZeroExactly) {
  const Grid grid = grid_of({20, 20, 20}, [](const Point3d&) { return 0; });
  const MacroCells cells(GridSampler(grid, Reconstruction::tricubic));
  EXPECT_EQ(cells.at(1, 1, 1).min, 0);
  EXPECT_EQ(cells.at(1, 1, 1).max, 0);
}

}  // namespace
}  // namespace motes
