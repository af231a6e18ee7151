// The hot path on every instruction set against the brute-force truth.
#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <utility>

#include "grid/grids.h"
#include "grid/instruction_sets.h"
#include "grid/sample_points.h"
#include "reference/grid.h"

namespace motes {
namespace {

PointSamples as_floats(const std::vector<std::array<double, 3>>& points) {
  PointSamples out;
  for (const auto& x : points) {
    out.x.push_back(static_cast<float>(x[0]));
    out.y.push_back(static_cast<float>(x[1]));
    out.z.push_back(static_cast<float>(x[2]));
  }
  return out;
}

class HotPath : public testing::TestWithParam<std::array<std::size_t, 3>> {};

TEST_P(HotPath, IsTheTruth) {
  for (const bool periodic : {false, true}) {
    const Grid grid = random_grid(GetParam(), periodic, 3);
    for (const Reconstruction reconstruction : all_reconstructions) {
      const GridSampler sampler(grid, reconstruction);
      const reference::GridField truth(grid, reconstruction);
      PointSamples points = as_floats(hull_points(sampler, 333, 5));
      std::vector<std::array<double, 4>> expected;
      for (std::size_t n = 0; n < points.x.size(); ++n) {
        const std::array<double, 3> x{points.x[n], points.y[n], points.z[n]};
        expected.push_back(
            {truth.value(x), truth.slope(x, 0), truth.slope(x, 1), truth.slope(x, 2)});
      }
      on_all_instruction_sets([&] {
        for (const bool gradients : {false, true}) {
          sample_points(sampler.view(), gradients, points);
          // 2e-6 of coefficients of up to 27.
          constexpr double tolerance = 5e-5;
          for (std::size_t n = 0; n < points.x.size(); ++n) {
            EXPECT_TRUE(points.inside[n]);
            EXPECT_NEAR(points.value[n], expected[n][0], tolerance);
            EXPECT_NEAR(points.dx[n], gradients ? expected[n][1] : 0, tolerance);
            EXPECT_NEAR(points.dy[n], gradients ? expected[n][2] : 0, tolerance);
            EXPECT_NEAR(points.dz[n], gradients ? expected[n][3] : 0, tolerance);
          }
        }
      });
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Grids, HotPath,
                         testing::Values(std::array<std::size_t, 3>{2, 3, 4},
                                         std::array<std::size_t, 3>{35, 2, 18},
                                         std::array<std::size_t, 3>{17, 16, 15}));

TEST(HotPath, ReproducesALinearFieldUpToTheFaces) {
  // Values are multiples of 1/4: samples, coefficients and their differences are exact.
  Grid grid = random_grid({30, 20, 10}, false, 1);
  for (std::size_t k = 0; k < 10; ++k) {
    for (std::size_t j = 0; j < 20; ++j) {
      for (std::size_t i = 0; i < 30; ++i) {
        const double value = 2. * double(i) - 1. * double(j) + 0.25 * double(k);
        grid.values[grid.index(i, j, k)] = static_cast<float>(value);
      }
    }
  }
  for (const Reconstruction reconstruction : all_reconstructions) {
    const GridSampler sampler(grid, reconstruction);
    PointSamples points = as_floats(hull_points(sampler, 1000, 5));
    on_all_instruction_sets([&] {
      sample_points(sampler.view(), true, points);
      for (std::size_t n = 0; n < points.x.size(); ++n) {
        // 2e-6 of the largest value, 60.
        const double expected = 2. * points.x[n] - 1. * points.y[n] + 0.25 * points.z[n];
        EXPECT_NEAR(points.value[n], expected, 1.2e-4);
        EXPECT_NEAR(points.dx[n], 2, 1.2e-4);
        EXPECT_NEAR(points.dy[n], -1, 1.2e-4);
        EXPECT_NEAR(points.dz[n], 0.25, 1.2e-4);
      }
    });
  }
}

TEST(HotPath, IsSafeAnywhere) {
  constexpr float nan = std::numeric_limits<float>::quiet_NaN();
  constexpr float infinity = std::numeric_limits<float>::infinity();
  const Grid grid = random_grid({3, 4, 5}, false, 1);
  for (const Reconstruction reconstruction : all_reconstructions) {
    const GridSampler sampler(grid, reconstruction);
    PointSamples points;
    const std::vector<float> places{nan, infinity, -infinity, 1e30F, -1e30F, -1, 2.001F, 1e9F};
    for (const float v : places) {
      for (int axis = 0; axis < 3; ++axis) {
        points.x.push_back(axis == 0 ? v : 1);
        points.y.push_back(axis == 1 ? v + 1 : 1);
        points.z.push_back(axis == 2 ? v + 2 : 1);
      }
    }
    points.y[16] = -0.001F;  // (-1 + 1 and -1 + 2 lie within)
    points.z[17] = -0.001F;
    on_all_instruction_sets([&] {
      sample_points(sampler.view(), true, points);
      for (const bool inside : points.inside) EXPECT_FALSE(inside);
    });
  }
}

}  // namespace
}  // namespace motes
