// Grids for tests.
#pragma once

#include <functional>
#include <random>

#include "grid/grid_sampler.h"
#include "particles/grid.h"

namespace motes {

inline constexpr std::array<Reconstruction, 3> all_reconstructions{
    Reconstruction::trilinear, Reconstruction::tricubic, Reconstruction::tricubic_smoothing};

/// A skew lattice far from the origin, whose samples are f(position).
inline Grid grid_of(const std::array<std::size_t, 3>& dims,
                    const std::function<double(const Point3d&)>& f) {
  Grid grid;
  grid.name = "test";
  grid.dims = dims;
  grid.origin = {10, -20, 30};
  grid.steps = {Vector3d{0.5, 0.1, 0}, {-0.2, 0.7, 0.1}, {0.3, 0, -1}};
  grid.values.resize(grid.size());
  for (std::size_t k = 0; k < dims[2]; ++k) {
    for (std::size_t j = 0; j < dims[1]; ++j) {
      for (std::size_t i = 0; i < dims[0]; ++i) {
        const Point3d p = grid.position(double(i), double(j), double(k));
        grid.values[grid.index(i, j, k)] = static_cast<float>(f(p));
      }
    }
  }
  return grid;
}

/// Samples in [-1, 1] without any order.
inline Grid random_grid(const std::array<std::size_t, 3>& dims, bool periodic, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> value(-1, 1);
  Grid grid = grid_of(dims, [&](const Point3d&) { return value(random); });
  grid.periodic = periodic;
  return grid;
}

/// Places in the hull of a grid, index coordinates: anywhere, on samples, and on faces and corners.
inline std::vector<std::array<double, 3>> hull_points(const GridSampler& sampler, std::size_t count,
                                                      unsigned seed) {
  std::mt19937 random(seed);
  std::vector<std::array<double, 3>> points;
  for (std::size_t n = 0; n < count; ++n) {
    std::array<double, 3> x{};
    for (std::size_t a = 0; a < 3; ++a) {
      const double end = sampler.num_cells()[a];
      x[a] = std::uniform_real_distribution<double>(0, end)(random);
      switch (random() % 6) {
        case 0:
          x[a] = 0;
          break;
        case 1:
          x[a] = end;
          break;
        case 2:
          x[a] = std::round(x[a]);
          break;
        default:
          break;
      }
    }
    points.push_back(x);
  }
  return points;
}

}  // namespace motes
