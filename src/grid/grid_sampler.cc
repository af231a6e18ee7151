// Sums over the 4 x 4 x 4 coefficients around a point.
#include "grid/grid_sampler.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>

#include "core/error.h"

namespace motes {

namespace {

/// Weights of the four coefficients along an axis, for the value and for its derivative, at t in
/// [0, 1] between the second and the third.
struct TapWeights {
  std::array<double, 4> value, slope;
};

TapWeights linear_weights(double t) {
  return {{0, 1 - t, t, 0}, {-(1 - t) / 2, -t / 2, (1 - t) / 2, t / 2}};
}

TapWeights spline_weights(double t) {
  const double s = 1 - t;
  return {
      {s * s * s / 6, 2. / 3 - t * t * (1 - t / 2), 2. / 3 - s * s * (1 - s / 2), t * t * t / 6},
      {-s * s / 2, t * (1.5 * t - 2), s * (2 - 1.5 * s), t * t / 2}};
}

std::array<int, 3> cells_of(const Grid& grid) {
  constexpr std::size_t most_along_axis = std::size_t{1} << 24;
  std::array<int, 3> cells{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::size_t n = grid.dims[axis];
    if (n < 2 && !grid.periodic) {
      throw Error(
          fmt::format("the grid '{}' is a single sample thick along {}; expected at least 2",
                      printable(grid.name), "xyz"[axis]));
    }
    if (n > most_along_axis) {
      throw Error(fmt::format("the grid '{}' has {} samples along {}; expected at most {}",
                              printable(grid.name), n, "xyz"[axis], most_along_axis));
    }
    cells[axis] = static_cast<int>(grid.periodic ? n : n - 1);
  }
  return cells;
}

Coefficients coefficients_of(const Grid& grid, Reconstruction reconstruction) {
  return reconstruction == Reconstruction::tricubic ? spline_coefficients(grid)
                                                    : sample_coefficients(grid);
}

}  // namespace

GridSampler::GridSampler(const Grid& grid, Reconstruction reconstruction)
    : reconstruction_(reconstruction),
      num_cells_(cells_of(grid)),
      origin_(grid.origin),
      steps_(grid.steps),
      coefficients_(coefficients_of(grid, reconstruction)) {
  assert(grid.values.size() == grid.size());
  // (offsets within a plane are 32-bit numbers)
  if (coefficients_.plane > std::size_t{0x7fffffff}) {
    throw Error(
        fmt::format("the grid '{}' has {} x {} samples in a plane; expected fewer than 2^31",
                    printable(grid.name), grid.dims[0], grid.dims[1]));
  }
  const double volume = dot(steps_[0], cross(steps_[1], steps_[2]));
  for (std::size_t axis = 0; axis < 3; ++axis) {
    reciprocal_[axis] = cross(steps_[(axis + 1) % 3], steps_[(axis + 2) % 3]) / volume;
  }
}

Point3d GridSampler::to_index(const Point3d& p) const {
  const Vector3d v = p - origin_;
  return {dot(reciprocal_[0], v), dot(reciprocal_[1], v), dot(reciprocal_[2], v)};
}

Point3d GridSampler::to_world(const Point3d& index) const {
  return origin_ + (index.x * steps_[0] + index.y * steps_[1] + index.z * steps_[2]);
}

Vector3d GridSampler::to_world_gradient(const Vector3d& per_index) const {
  return per_index.x * reciprocal_[0] + per_index.y * reciprocal_[1] + per_index.z * reciprocal_[2];
}

Bounds3d GridSampler::bounds() const {
  Bounds3d box;
  for (int corner = 0; corner < 8; ++corner) {
    box.add(to_world({(corner & 1) != 0 ? double(num_cells_[0]) : 0,
                      (corner & 2) != 0 ? double(num_cells_[1]) : 0,
                      (corner & 4) != 0 ? double(num_cells_[2]) : 0}));
  }
  return box;
}

std::optional<GridSample> GridSampler::sample(const Point3d& p) const {
  constexpr double tolerance = 1e-9;
  const Point3d index = to_index(p);
  const std::array<std::size_t, 3> strides{1, coefficients_.row, coefficients_.plane};
  std::size_t first = 0;
  std::array<TapWeights, 3> w;
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    const double end = num_cells_[a];
    // (so that NaN is outside)
    if (!(index[axis] >= -tolerance && index[axis] <= end + tolerance)) return std::nullopt;
    const double x = std::clamp(index[axis], 0., end);
    const double cell = std::min(std::floor(x), end - 1);
    first += static_cast<std::size_t>(cell) * strides[a];
    w[a] = reconstruction_ == Reconstruction::trilinear ? linear_weights(x - cell)
                                                        : spline_weights(x - cell);
  }
  GridSample out;
  Vector3d slope;
  for (std::size_t k = 0; k < 4; ++k) {
    for (std::size_t j = 0; j < 4; ++j) {
      const float* const row =
          coefficients_.values.data() + first + k * strides[2] + j * strides[1];
      for (std::size_t i = 0; i < 4; ++i) {
        const double c = row[i];
        out.value += c * w[0].value[i] * w[1].value[j] * w[2].value[k];
        slope.x += c * w[0].slope[i] * w[1].value[j] * w[2].value[k];
        slope.y += c * w[0].value[i] * w[1].slope[j] * w[2].value[k];
        slope.z += c * w[0].value[i] * w[1].value[j] * w[2].slope[k];
      }
    }
  }
  out.gradient = to_world_gradient(slope);
  return out;
}

GridView GridSampler::view() const {
  return {coefficients_.values.data(), coefficients_.row, coefficients_.plane, num_cells_,
          reconstruction_ != Reconstruction::trilinear};
}

}  // namespace motes
