// The field between a grid's samples: its value and gradient at any point.
#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "core/vec.h"
#include "grid/coefficients.h"
#include "particles/grid.h"

namespace motes {

/// A field at a point: the value, and the gradient per length unit in world axes.
struct GridSample {
  double value = 0;
  Vector3d gradient;
};

/// What the hot path reads (sample_grid-inl.h).
struct GridView {
  const float* first = nullptr;  ///< coefficient of sample (-1, -1, -1)
  std::size_t row = 0, plane = 0;
  std::array<int, 3> num_cells{};  ///< of the hull, as in GridSampler
  bool cubic = false;
};

/// A reconstruction of one grid. Its hull is the parallelepiped between the outermost samples, or,
/// where the grid is periodic, the cell; in index coordinates, in which sample (i, j, k) lies at
/// that place, it is 0 to num_cells along each axis, faces included. Beyond it there is no field.
/// Samples that are not finite count as 0.
class GridSampler {
 public:
  /// Takes a copy of the values, with a border. Throws Error for a grid that is not periodic and
  /// has a single sample along an axis, since it fills no space, and for one of more than 2^24
  /// samples along an axis or 2^31 in a plane.
  GridSampler(const Grid& grid, Reconstruction reconstruction);

  Reconstruction reconstruction() const { return reconstruction_; }
  const std::array<int, 3>& num_cells() const { return num_cells_; }
  /// Samples of the grid that were not finite.
  std::size_t num_not_finite() const { return coefficients_.num_not_finite; }
  /// Memory of the coefficients.
  std::size_t num_bytes() const { return coefficients_.values.size() * sizeof(float); }

  /// World to index coordinates, and back.
  Point3d to_index(const Point3d& p) const;
  Point3d to_world(const Point3d& index) const;
  /// A gradient per index, as the hot path gives it, to one per length unit in world axes.
  Vector3d to_world_gradient(const Vector3d& per_index) const;
  /// The box around the hull, world coordinates.
  Bounds3d bounds() const;

  /// The field at a point, in double precision; nothing outside of the hull (by more than 1e-9 of a
  /// step, which rounding may make of a point on a face).
  std::optional<GridSample> sample(const Point3d& p) const;

  GridView view() const;

 private:
  Reconstruction reconstruction_;
  std::array<int, 3> num_cells_;
  Point3d origin_;
  std::array<Vector3d, 3> steps_;
  std::array<Vector3d, 3> reciprocal_;  ///< gradients of the index coordinates
  Coefficients coefficients_;
};

}  // namespace motes
