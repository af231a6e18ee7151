// The grid of cells lists every kernel wherever its support is.
#include "field/cell_grid.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "support/particles_at.h"

namespace motes {
namespace {

/// `count` particles in a unit cube somewhere, with radii over `decades` powers of ten.
KernelSet random_kernels(std::size_t count, double decades, std::uint32_t seed) {
  std::mt19937 random(seed);
  const auto unit = [&] { return (random() + 0.5) / 4294967296.0; };
  std::vector<Point3d> points;
  for (std::size_t i = 0; i < count; ++i) points.push_back({100 + unit(), unit(), -3 * unit()});
  const ParticleSet particles = particles_at(points);
  FieldSource source = field_of_all(particles, 1, 1, {});
  source.radius.resize(count);
  for (float& radius : source.radius) {
    radius = static_cast<float>(0.01 * std::pow(10, decades * unit()));
  }
  return build_kernel_set(particles, {source});
}

void check_lists(const KernelSet& kernels) {
  const CellGrid grid = build_cell_grid(kernels);
  std::mt19937 random(7);
  const auto unit = [&] { return (random() + 0.5) / 4294967296.0; };
  const Bounds3d box = kernels.box();
  for (int n = 0; n < 500; ++n) {
    const Vector3d d = box.diagonal();
    const Point3d world = box.min + Vector3d{unit() * d.x, unit() * d.y, unit() * d.z};
    const Point3d p = Point3d{} + kernels.length_scale * (world - kernels.origin);
    const std::int64_t cell = grid.cell_of(p);
    ASSERT_GE(cell, 0);
    const auto list = grid.kernels_in(cell);
    EXPECT_TRUE(std::is_sorted(list.begin(), list.end()));
    for (std::uint32_t k = 0; k < kernels.size(); ++k) {
      const Point3d center{kernels.x[k], kernels.y[k], kernels.z[k]};
      if (length(p - center) > 2 * kernels.radius[k]) continue;
      EXPECT_TRUE(std::binary_search(list.begin(), list.end(), k));
    }
  }
}

TEST(CellGrid, ListsAllKernelsOfAPlace) {
  check_lists(random_kernels(700, 0, 1));
  check_lists(random_kernels(700, 1, 2));
  check_lists(random_kernels(1, 0, 3));
}

TEST(CellGrid, StaysSmallWhereRadiiDifferByOrders) {
  const KernelSet kernels = random_kernels(3000, 4, 4);
  check_lists(kernels);
  const CellGrid grid = build_cell_grid(kernels);
  EXPECT_LE(grid.kernels.size(), 33 * kernels.size());
  EXPECT_LE(grid.begin.size(), 4 * kernels.size() + 4097);
}

TEST(CellGrid, HasNoCellsWhereNothingIsInAField) {
  const ParticleSet particles = particles_at({{0, 0, 0}, {1, 2, 3}});
  FieldSource drawn = field_of_all(particles, 1, 1, {});
  drawn.drawn_only = true;
  const KernelSet kernels = build_kernel_set(particles, {drawn});
  ASSERT_EQ(kernels.size(), 2u);
  EXPECT_EQ(build_cell_grid(kernels).cell_of({0, 0, 0}), -1);
}

TEST(CellGrid, KnowsWhatIsOutside) {
  const CellGrid grid = build_cell_grid(random_kernels(50, 0, 5));
  EXPECT_EQ(grid.cell_of(grid.corner + Vector3d{-1e-3, 0, 0}), -1);
  EXPECT_EQ(grid.cell_of({1e30, 0, 0}), -1);
  EXPECT_EQ(grid.cell_of({std::nan(""), 0, 0}), -1);
}

}  // namespace
}  // namespace motes
