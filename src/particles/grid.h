// A structured volume: numbers on a regular lattice of points, as readers of grids make it.
#pragma once

#include <array>
#include <cstddef>
#include <string>

#include "core/aligned.h"
#include "core/vec.h"

namespace motes {

/// How a field is made of samples (docs/grid.md). All reproduce a linear field exactly, to the
/// faces.
enum class Reconstruction {
  /// Trilinear interpolation. Gradient: central differences at the samples, interpolated likewise.
  trilinear,
  /// Cubic B-spline through the samples, twice continuously differentiable, and its own gradient.
  tricubic,
  /// Cubic B-spline with the samples for coefficients: it smooths and does not pass through them.
  tricubic_smoothing
};

/// A scalar on the points of a lattice. Samples are points, not volumes: number (i, j, k) is the
/// field's value exactly at position(i, j, k), and a grid that is not periodic ends with its
/// outermost samples. A periodic one goes on, for ever: its cell has the edges dims[a] * steps[a],
/// and sample dims[a] is sample 0 again.
struct Grid {
  std::string name;
  std::array<std::size_t, 3> dims{};    ///< samples along each axis, at least 1
  Point3d origin;                       ///< of sample (0, 0, 0); world coordinates
  std::array<Vector3d, 3> steps;        ///< from a sample to the next; any that span a volume
  UninitializedVector<float> values;    ///< x fastest: [(k dims[1] + j) dims[0] + i]
  bool periodic = false;                ///< along all three axes
  std::string length_unit = "unknown";  ///< as in ParticleSet

  /// Number of samples.
  std::size_t size() const { return dims[0] * dims[1] * dims[2]; }
  std::size_t index(std::size_t i, std::size_t j, std::size_t k) const {
    return (k * dims[1] + j) * dims[0] + i;
  }
  Point3d position(double i, double j, double k) const {
    return origin + (i * steps[0] + j * steps[1] + k * steps[2]);
  }
};

/// Corners of the parallelepiped in which the grid's field is: between its outermost samples, or,
/// of a periodic one, its cell. World coordinates.
inline std::array<Point3d, 8> corners_of(const Grid& grid) {
  const auto end = [&grid](std::size_t axis) {
    return static_cast<double>(grid.dims[axis] - (grid.periodic ? 0 : 1));
  };
  std::array<Point3d, 8> corners;
  for (std::size_t c = 0; c < 8; ++c) {
    corners[c] = grid.position((c & 1) != 0 ? end(0) : 0, (c & 2) != 0 ? end(1) : 0,
                               (c & 4) != 0 ? end(2) : 0);
  }
  return corners;
}

}  // namespace motes
