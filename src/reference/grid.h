// The field of a grid in double precision, from docs/grid.md: B-splines by their recursion,
// coefficients by elimination. Shares no numerics with what it checks; for small grids.
#pragma once

#include <array>
#include <vector>

#include "core/vec.h"
#include "particles/grid.h"
#include "reference/field.h"
#include "scene/clip_plane.h"

namespace motes::reference {

class GridField {
 public:
  /// `grid` must outlive it.
  GridField(const Grid& grid, Reconstruction reconstruction);

  /// At any place within the hull, index coordinates.
  double value(const std::array<double, 3>& x) const { return sum(x, -1); }
  /// Its derivative along an axis: of the spline, or the central difference that trilinear
  /// interpolation of central differences is.
  double slope(const std::array<double, 3>& x, int axis) const;

  /// Value and gradient at a point of the hull, world coordinates.
  FieldValue at(const Point3d& p) const;

  /// What lies behind none of these is the hull. Their normals have no certain length.
  const std::vector<ClipPlane>& faces() const { return faces_; }

  /// Of the coefficients, without their signs.
  double largest_coefficient() const;

 private:
  double coefficient(std::array<int, 3> index, int axis = 0) const;
  double sum(const std::array<double, 3>& x, int derivative) const;
  void solve_along(std::size_t axis);

  const Grid& grid_;
  Reconstruction reconstruction_;
  std::vector<double> c_;
  std::vector<ClipPlane> faces_;
};

}  // namespace motes::reference
