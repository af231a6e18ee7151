#include "reference/grid.h"

#include <algorithm>
#include <cmath>

namespace motes::reference {
namespace {

/// B-spline of a degree, centred at 0, with knots one apart.
double b_spline(int degree, double x) {
  if (degree == 0) return x >= -0.5 && x < 0.5 ? 1 : 0;
  const double half = (degree + 1) / 2.0;
  return ((half + x) * b_spline(degree - 1, x + 0.5) + (half - x) * b_spline(degree - 1, x - 0.5)) /
         degree;
}

double basis(int degree, double x, bool derivative) {
  if (!derivative) return b_spline(degree, x);
  return b_spline(degree - 1, x + 0.5) - b_spline(degree - 1, x - 0.5);
}

/// (of matrices that are diagonally dominant: no pivots)
std::vector<std::vector<double>> inverted(std::vector<std::vector<double>> m) {
  const std::size_t n = m.size();
  std::vector<std::vector<double>> out(n, std::vector<double>(n, 0));
  for (std::size_t i = 0; i < n; ++i) out[i][i] = 1;
  for (std::size_t i = 0; i < n; ++i) {
    const double pivot = m[i][i];
    for (std::size_t j = 0; j < n; ++j) {
      m[i][j] /= pivot;
      out[i][j] /= pivot;
    }
    for (std::size_t r = 0; r < n; ++r) {
      const double factor = r == i ? 0 : m[r][i];
      for (std::size_t j = 0; j < n; ++j) {
        m[r][j] -= factor * m[i][j];
        out[r][j] -= factor * out[i][j];
      }
    }
  }
  return out;
}

/// Of which index coordinate i changes by 1 a length along the row, by Cramer's rule.
std::array<Vector3d, 3> inverse_steps(const Grid& grid) {
  const auto& [a, b, c] = grid.steps;
  const double volume = dot(a, cross(b, c));
  return {cross(b, c) / volume, cross(c, a) / volume, cross(a, b) / volume};
}

/// Through the origin and through the opposite corner of the hull, which may be left-handed.
std::vector<ClipPlane> faces_of(const Grid& grid) {
  const double less = grid.periodic ? 0 : 1;
  Point3d corner = grid.origin;
  for (std::size_t a = 0; a < 3; ++a) {
    corner = corner + (static_cast<double>(grid.dims[a]) - less) * grid.steps[a];
  }
  std::vector<ClipPlane> faces;
  for (std::size_t a = 0; a < 3; ++a) {
    Vector3d normal = normalize(cross(grid.steps[(a + 1) % 3], grid.steps[(a + 2) % 3]));
    if (dot(normal, grid.steps[a]) < 0) normal = -normal;
    faces.push_back({-normal, -dot(normal, grid.origin - Point3d{})});
    faces.push_back({normal, dot(normal, corner - Point3d{})});
  }
  return faces;
}

}  // namespace

GridField::GridField(const Grid& grid, Reconstruction reconstruction)
    : grid_(grid), reconstruction_(reconstruction) {
  c_.reserve(grid.size());
  for (const float v : grid.values) c_.push_back(std::isfinite(v) ? v : 0);
  if (reconstruction == Reconstruction::tricubic) {
    for (std::size_t axis = 0; axis < 3; ++axis) solve_along(axis);
  }
  faces_ = faces_of(grid);
}

double GridField::largest_coefficient() const {
  double largest = 0;
  for (const double c : c_) largest = std::max(largest, std::abs(c));
  return largest;
}

double GridField::slope(const std::array<double, 3>& x, int axis) const {
  if (reconstruction_ != Reconstruction::trilinear) return sum(x, axis);
  std::array<double, 3> left = x, right = x;
  left[static_cast<std::size_t>(axis)] -= 1;
  right[static_cast<std::size_t>(axis)] += 1;
  return (value(right) - value(left)) / 2;
}

FieldValue GridField::at(const Point3d& p) const {
  const std::array<Vector3d, 3> inverse = inverse_steps(grid_);
  std::array<double, 3> x{};
  for (std::size_t a = 0; a < 3; ++a) x[a] = dot(inverse[a], p - grid_.origin);
  FieldValue field;
  field.value = value(x);
  field.absolute = std::abs(field.value);
  for (int a = 0; a < 3; ++a) {
    field.gradient = field.gradient + slope(x, a) * inverse[static_cast<std::size_t>(a)];
  }
  return field;
}

/// Coefficient of any index: repeated, or by the line through the outermost two.
double GridField::coefficient(std::array<int, 3> index, int axis) const {
  if (axis == 3) {
    return c_[grid_.index(static_cast<std::size_t>(index[0]), static_cast<std::size_t>(index[1]),
                          static_cast<std::size_t>(index[2]))];
  }
  const auto a = static_cast<std::size_t>(axis);
  const int n = static_cast<int>(grid_.dims[a]), i = index[a];
  const auto at = [&](int j) {
    index[a] = j;
    return coefficient(index, axis + 1);
  };
  if (grid_.periodic) return at((i % n + n) % n);
  if (i < 0) return at(0) + i * (at(1) - at(0));
  if (i >= n) return at(n - 1) + (i - n + 1) * (at(n - 1) - at(n - 2));
  return at(i);
}

double GridField::sum(const std::array<double, 3>& x, int derivative) const {
  constexpr int taps = 6;
  const int degree = reconstruction_ == Reconstruction::trilinear ? 1 : 3;
  std::array<int, 3> first{};
  std::array<std::array<double, taps>, 3> w{};
  for (std::size_t a = 0; a < 3; ++a) {
    first[a] = static_cast<int>(std::floor(x[a])) - 2;
    for (std::size_t t = 0; t < taps; ++t) {
      w[a][t] = basis(degree, x[a] - first[a] - static_cast<double>(t),
                      derivative == static_cast<int>(a));
    }
  }
  double total = 0;
  for (std::size_t k = 0; k < taps; ++k) {
    for (std::size_t j = 0; j < taps; ++j) {
      for (std::size_t i = 0; i < taps; ++i) {
        const double weight = w[0][i] * w[1][j] * w[2][k];
        if (weight == 0) continue;
        total +=
            weight * coefficient({first[0] + static_cast<int>(i), first[1] + static_cast<int>(j),
                                  first[2] + static_cast<int>(k)});
      }
    }
  }
  return total;
}

/// Coefficients of which the spline passes through the samples along an axis, by elimination in the
/// full matrix: at the ends, no second derivative, or the other end.
void GridField::solve_along(std::size_t axis) {
  const std::size_t n = grid_.dims[axis];
  std::vector<std::vector<double>> m(n, std::vector<double>(n, 0));
  for (std::size_t i = 0; i < n; ++i) {
    if (grid_.periodic) {
      m[i][i] += 4. / 6;
      m[i][(i + 1) % n] += 1. / 6;
      m[i][(i + n - 1) % n] += 1. / 6;
    } else if (i == 0 || i + 1 == n) {
      m[i][i] = 1;  // f = (c' + 4 c + c'') / 6 with c' - 2 c + c'' = 0
    } else {
      m[i][i] = 4. / 6;
      m[i][i - 1] = m[i][i + 1] = 1. / 6;
    }
  }
  const auto inverse = inverted(m);
  std::vector<double> line(n);
  const std::size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
  std::array<std::size_t, 3> at{};
  for (at[u] = 0; at[u] < grid_.dims[u]; ++at[u]) {
    for (at[v] = 0; at[v] < grid_.dims[v]; ++at[v]) {
      const auto c = [&](std::size_t i) -> double& {
        at[axis] = i;
        return c_[grid_.index(at[0], at[1], at[2])];
      };
      for (std::size_t i = 0; i < n; ++i) line[i] = c(i);
      for (std::size_t i = 0; i < n; ++i) {
        c(i) = 0;
        for (std::size_t j = 0; j < n; ++j) c(i) += inverse[i][j] * line[j];
      }
    }
  }
}

}  // namespace motes::reference
