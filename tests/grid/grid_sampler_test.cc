// Reconstructions against closed forms and the brute-force truth.
#include "grid/grid_sampler.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/error.h"
#include "grid/grids.h"
#include "reference/grid.h"

namespace motes {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

Point3d point_at(const GridSampler& sampler, const std::array<double, 3>& x) {
  return sampler.to_world({x[0], x[1], x[2]});
}

TEST(GridSampler, ReproducesALinearFieldUpToTheFaces) {
  const auto linear = [](const Point3d& p) { return 3 * p.x - 2 * p.y + 0.5 * p.z + 7; };
  for (const std::array<std::size_t, 3>& dims :
       {std::array<std::size_t, 3>{2, 2, 2}, {7, 5, 6}, {3, 20, 2}, {40, 2, 9}}) {
    const Grid grid = grid_of(dims, linear);
    for (const Reconstruction reconstruction : all_reconstructions) {
      const GridSampler sampler(grid, reconstruction);
      for (const auto& x : hull_points(sampler, 200, 1)) {
        const Point3d p = point_at(sampler, x);
        const auto sample = sampler.sample(p);
        ASSERT_TRUE(sample);
        // Samples are floats of about 100 in coefficients that differ by some 0.5: 4e-6 each.
        EXPECT_NEAR(sample->value, linear(p), 2e-5);
        EXPECT_NEAR(length(sample->gradient - Vector3d{3, -2, 0.5}), 0, 2e-4);
      }
    }
  }
}

// Of samples that vary along one axis alone; those around them then count with weights of sum 1.
TEST(GridSampler, GradientsAreCentralDifferencesAtTheSamples) {
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    Grid grid = grid_of({9, 9, 9}, [](const Point3d&) { return 0; });
    const std::array<std::size_t, 3> strides{1, 9, 81};
    const float along[] = {3, -1, 4, 1, -5, 9, 2, -6, 5};
    for (std::size_t i = 0; i < grid.size(); ++i) grid.values[i] = along[i / strides[a] % 9];
    for (const Reconstruction reconstruction :
         {Reconstruction::trilinear, Reconstruction::tricubic_smoothing}) {
      const GridSampler sampler(grid, reconstruction);
      for (std::size_t i = 1; i < 8; ++i) {
        std::array<double, 3> x{3.2, 4.7, 5};
        x[a] = static_cast<double>(i);
        const auto sample = sampler.sample(point_at(sampler, x));
        ASSERT_TRUE(sample);
        EXPECT_NEAR(dot(sample->gradient, grid.steps[a]), (along[i + 1] - along[i - 1]) / 2, 1e-5);
      }
    }
  }
}

// A cubic is its own spline but for what the ends do, which dies away by 0.268 a sample.
TEST(GridSampler, TricubicReproducesCubicsAwayFromTheFaces) {
  const auto cubic = [](const Point3d& q) {
    const Vector3d p = q - Point3d{10, -20, 30};
    return p.x * p.x * p.x - p.x * p.y * p.z + 2 * p.y * p.y - p.z * p.z * p.z / 4 + p.x;
  };
  const auto gradient = [](const Point3d& q) {
    const Vector3d p = q - Point3d{10, -20, 30};
    return Vector3d{3 * p.x * p.x - p.y * p.z + 1, -p.x * p.z + 4 * p.y,
                    -p.x * p.y - 3 * p.z * p.z / 4};
  };
  const Grid grid = grid_of({31, 33, 32}, cubic);
  const GridSampler sampler(grid, Reconstruction::tricubic);
  const GridSampler linear(grid, Reconstruction::trilinear);
  double worst = 0, worst_linear = 0;
  for (double z = 13; z < 18; z += 0.37) {
    for (double y = 13; y < 18; y += 0.41) {
      for (double x = 13; x < 18; x += 0.43) {
        const Point3d p = sampler.to_world({x, y, z});
        const auto sample = sampler.sample(p);
        ASSERT_TRUE(sample);
        worst = std::max(worst, std::abs(sample->value - cubic(p)) / 1e3);
        worst = std::max(worst, length(sample->gradient - gradient(p)) / 1e3);
        worst_linear = std::max(worst_linear, std::abs(linear.sample(p)->value - cubic(p)) / 1e3);
      }
    }
  }
  // Values of up to 4000 at the faces, 0.268^13 = 4e-8 of what is amiss there; floats are 6e-8.
  EXPECT_LT(worst, 3e-6);
  EXPECT_GT(worst_linear, 1e-4) << "no other would do";
}

class Shapes : public testing::TestWithParam<std::array<std::size_t, 3>> {};

TEST_P(Shapes, AreThoseOfTheTruth) {
  for (const bool periodic : {false, true}) {
    if (!periodic && *std::min_element(GetParam().begin(), GetParam().end()) < 2) continue;
    const Grid grid = random_grid(GetParam(), periodic, 3);
    for (const Reconstruction reconstruction : all_reconstructions) {
      SCOPED_TRACE(static_cast<int>(reconstruction) + (periodic ? 10 : 0));
      const GridSampler sampler(grid, reconstruction);
      const reference::GridField truth(grid, reconstruction);
      for (const auto& x : hull_points(sampler, 100, 5)) {
        const auto sample = sampler.sample(point_at(sampler, x));
        ASSERT_TRUE(sample);
        // Coefficients, of up to 27 where samples are up to 1, are floats.
        EXPECT_NEAR(sample->value, truth.value(x), 5e-6);
        // The derivative along a step is the gradient's component.
        for (int axis = 0; axis < 3; ++axis) {
          EXPECT_NEAR(dot(sample->gradient, grid.steps[static_cast<std::size_t>(axis)]),
                      truth.slope(x, axis), 1e-5);
        }
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Grids, Shapes,
                         testing::Values(std::array<std::size_t, 3>{2, 3, 4},
                                         std::array<std::size_t, 3>{9, 8, 7},
                                         std::array<std::size_t, 3>{35, 2, 18},
                                         std::array<std::size_t, 3>{1, 5, 1},
                                         std::array<std::size_t, 3>{3, 1, 70}));

TEST(GridSampler, PassesThroughSamplesUnlessItSmooths) {
  const Grid grid = random_grid({5, 6, 7}, false, 4);
  const GridSampler linear(grid, Reconstruction::trilinear), cubic(grid, Reconstruction::tricubic),
      smoothing(grid, Reconstruction::tricubic_smoothing);
  const float expected = grid.values[grid.index(2, 3, 4)];
  const Point3d p = grid.position(2, 3, 4);
  EXPECT_NEAR(linear.sample(p)->value, expected, 1e-6);
  EXPECT_NEAR(cubic.sample(p)->value, expected, 5e-6);
  EXPECT_GT(std::abs(smoothing.sample(p)->value - expected), 0.01);
}

TEST(GridSampler, HasNoFieldOutsideItsHull) {
  for (const bool periodic : {false, true}) {
    const Grid grid = random_grid({4, 5, 6}, periodic, 4);
    const GridSampler sampler(grid, Reconstruction::trilinear);
    const double end = periodic ? 4 : 3;
    EXPECT_EQ(sampler.num_cells()[0], end);
    EXPECT_TRUE(sampler.sample(sampler.to_world({end, 0, 0})));
    EXPECT_FALSE(sampler.sample(sampler.to_world({end + 1e-6, 0, 0})));
    EXPECT_FALSE(sampler.sample(sampler.to_world({0, -1e-6, 0})));
    EXPECT_FALSE(sampler.sample({std::nan(""), 0, 0}));
  }
}

// The last cell of a period lies between the last sample and the first.
TEST(GridSampler, WrapsAPeriod) {
  const Grid grid = random_grid({4, 5, 6}, true, 4);
  for (const Reconstruction reconstruction : all_reconstructions) {
    const GridSampler sampler(grid, reconstruction);
    for (const double t : {0.0, 0.3, 0.9}) {
      const auto low = sampler.sample(sampler.to_world({0, 5 * t, 6 * t}));
      const auto high = sampler.sample(sampler.to_world({4, 5 * t, 6 * t}));
      EXPECT_NEAR(low->value, high->value, 1e-6);
      EXPECT_NEAR(length(low->gradient - high->gradient), 0, 1e-5);
    }
  }
}

TEST(GridSampler, KnowsWhereItIs) {
  const Grid grid = random_grid({4, 5, 6}, false, 4);
  const GridSampler sampler(grid, Reconstruction::trilinear);
  const Point3d p = grid.position(1.5, 2.25, 4);
  EXPECT_NEAR(length(sampler.to_index(p) - Point3d{1.5, 2.25, 4}), 0, 1e-12);
  EXPECT_NEAR(length(sampler.to_world({1.5, 2.25, 4}) - p), 0, 1e-12);
  const Bounds3d bounds = sampler.bounds();
  for (const double i : {0., 3.}) {
    for (const double j : {0., 4.}) {
      for (const double k : {0., 5.}) EXPECT_TRUE(bounds.contains(grid.position(i, j, k)));
    }
  }
  EXPECT_NEAR(bounds.min.x, 10 - 0.2 * 4, 1e-12);
  EXPECT_NEAR(bounds.max.x, 10 + 0.5 * 3 + 0.3 * 5, 1e-12);
  EXPECT_GE(sampler.num_bytes(), 6 * 7 * 8 * sizeof(float));
}

TEST(GridSampler, TakesWhatIsNotFiniteForZero) {
  Grid grid = random_grid({4, 5, 6}, false, 4);
  grid.values[grid.index(1, 1, 1)] = std::numeric_limits<float>::quiet_NaN();
  grid.values[grid.index(3, 4, 5)] = std::numeric_limits<float>::infinity();
  for (const Reconstruction reconstruction : all_reconstructions) {
    const GridSampler sampler(grid, reconstruction);
    EXPECT_EQ(sampler.num_not_finite(), 2u);
    for (const auto& x : hull_points(sampler, 100, 1)) {
      EXPECT_TRUE(std::isfinite(sampler.sample(point_at(sampler, x))->value));
    }
  }
}

TEST(GridSampler, RefusesGridsWithoutThickness) {
  const Grid grid = random_grid({4, 1, 6}, false, 4);
  EXPECT_THAT([&] { GridSampler(grid, Reconstruction::tricubic); },
              ThrowsMessage<Error>(HasSubstr(
                  "the grid 'test' is a single sample thick along y; expected at least 2")));
}

}  // namespace
}  // namespace motes
