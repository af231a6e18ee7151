#include "io/move_into_cell.h"

#include <cmath>
#include <cstddef>

namespace motes {

void move_into_cell(const Cell& cell, std::vector<double>& x, std::vector<double>& y,
                    std::vector<double>& z) {
  const auto& [a, b, c] = cell.vectors;
  const double volume = dot(a, cross(b, c));
  const Vector3d across[3] = {cross(b, c) / volume, cross(c, a) / volume, cross(a, b) / volume};
  for (std::size_t i = 0; i < x.size(); ++i) {
    const Vector3d from_corner = Point3d{x[i], y[i], z[i]} - cell.origin;
    Vector3d shift;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      constexpr double rounding = 1e-6;
      const double edges = std::floor(dot(across[axis], from_corner) + rounding);
      if (std::isfinite(edges)) shift = shift + edges * cell.vectors[axis];
    }
    x[i] -= shift.x;
    y[i] -= shift.y;
    z[i] -= shift.z;
  }
}

}  // namespace motes
