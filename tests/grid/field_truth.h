// The field between a grid's samples by brute force, in double precision, from the definitions:
// dense systems for the spline, B-splines by the recursion of Cox and de Boor, differences of the
// field itself.
#pragma once

#include <array>
#include <cmath>
#include <vector>

#include "grid/grid_sampler.h"
#include "particles/grid.h"

namespace motes {

class FieldTruth {
 public:
  FieldTruth(const Grid& grid, Reconstruction reconstruction)
      : grid_(grid), reconstruction_(reconstruction), c_(grid.values.begin(), grid.values.end()) {
    if (reconstruction == Reconstruction::tricubic) {
      for (std::size_t axis = 0; axis < 3; ++axis) solve_along(axis);
    }
  }

  /// At any place within the hull, index coordinates.
  double value(const std::array<double, 3>& x) const { return sum(x, -1); }
  /// Its derivative along an axis: of the spline, or the central difference that trilinear
  /// interpolation of central differences is.
  double slope(const std::array<double, 3>& x, int axis) const {
    if (reconstruction_ != Reconstruction::trilinear) return sum(x, axis);
    std::array<double, 3> left = x, right = x;
    left[static_cast<std::size_t>(axis)] -= 1;
    right[static_cast<std::size_t>(axis)] += 1;
    return (value(right) - value(left)) / 2;
  }

 private:
  /// Coefficient of any index: repeated, or by the line through the outermost two.
  double coefficient(std::array<int, 3> index, int axis = 0) const {
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

  /// B-spline of a degree, centred at 0, with knots one apart.
  static double b_spline(int degree, double x) {
    if (degree == 0) return x >= -0.5 && x < 0.5 ? 1 : 0;
    const double half = (degree + 1) / 2.0;
    return ((half + x) * b_spline(degree - 1, x + 0.5) +
            (half - x) * b_spline(degree - 1, x - 0.5)) /
           degree;
  }

  double basis(double x, bool derivative) const {
    const int degree = reconstruction_ == Reconstruction::trilinear ? 1 : 3;
    if (!derivative) return b_spline(degree, x);
    return b_spline(degree - 1, x + 0.5) - b_spline(degree - 1, x - 0.5);
  }

  double sum(const std::array<double, 3>& x, int derivative) const {
    std::array<int, 3> base{};
    for (std::size_t a = 0; a < 3; ++a) base[a] = static_cast<int>(std::floor(x[a]));
    double total = 0;
    for (int k = -2; k <= 3; ++k) {
      for (int j = -2; j <= 3; ++j) {
        for (int i = -2; i <= 3; ++i) {
          const std::array<int, 3> at{base[0] + i, base[1] + j, base[2] + k};
          double w = 1;
          for (std::size_t a = 0; a < 3; ++a) {
            w *= basis(x[a] - at[a], derivative == static_cast<int>(a));
          }
          if (w != 0) total += w * coefficient(at);
        }
      }
    }
    return total;
  }

  /// Coefficients of which the spline passes through the samples along an axis, by elimination in
  /// the full matrix: at the ends, no second derivative, or the other end.
  void solve_along(std::size_t axis) {
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

  /// (diagonally dominant: no pivots)
  static std::vector<std::vector<double>> inverted(std::vector<std::vector<double>> m) {
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

  const Grid& grid_;
  Reconstruction reconstruction_;
  std::vector<double> c_;
};

}  // namespace motes
