// Kernels' shapes, written out as their sources give them.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <vector>

#include "reference/field.h"

namespace motes::reference {

namespace {

/// c[0] + c[1] x + ... and its derivative.
template <int n>
ShapeValue polynomial(const double (&c)[n], double x) {
  ShapeValue sum;
  for (int i = 0; i < n; ++i) {
    sum.value += c[i] * std::pow(x, i);
    if (i > 0) sum.derivative += i * c[i] * std::pow(x, i - 1);
  }
  return sum;
}

/// (reach - q)^5 below `reach`.
ShapeValue fifth_power(double reach, double q) {
  if (q >= reach) return {};
  return {std::pow(reach - q, 5), -5 * std::pow(reach - q, 4)};
}

/// a b, by the product rule.
ShapeValue product(const ShapeValue& a, const ShapeValue& b) {
  return {a.value * b.value, a.derivative * b.value + a.value * b.derivative};
}

/// (1 - q/2)^n times a polynomial.
template <int n>
ShapeValue wendland(int power, const double (&c)[n], double q) {
  const double t = 1 - q / 2;
  return product({std::pow(t, power), -power / 2. * std::pow(t, power - 1)}, polynomial(c, q));
}

/// Derivative at x[0] of the polynomial through all points.
double polynomial_slope(const std::vector<double>& x, const std::vector<double>& y) {
  double slope = 0;
  for (std::size_t j = 1; j < x.size(); ++j) {
    // Lagrange's basis, that of point j and what it takes from point 0.
    double of_j = 1 / (x[j] - x[0]);
    for (std::size_t k = 1; k < x.size(); ++k) {
      if (k != j) of_j *= (x[0] - x[k]) / (x[j] - x[k]);
    }
    slope += of_j * y[j] + y[0] / (x[0] - x[j]);
  }
  return slope;
}

/// Slope of the polynomial through the five points nearest to point i of an even function, of
/// tables of up to four points through fewer at their ends; never against the secants on both
/// sides, nor more than three times as steep (Hyman 1983).
double point_slope(const RadialProfile& profile, std::size_t i) {
  const auto& v = profile.values;
  const std::size_t last = v.size() - 1;
  if (i == 0 || (i == last && v[i] == 0)) return 0;
  const int at = static_cast<int>(i), end = static_cast<int>(last);
  std::vector<double> x, y;
  const auto add = [&](int j) {
    x.push_back(profile.spacing * j);
    y.push_back(v[static_cast<std::size_t>(std::abs(j))]);
  };
  add(at);
  const bool at_end = at + 2 > end;
  const int above = std::min(at + 2, end);
  const int below = !at_end || last >= 4 ? above - 4 : at - 1;
  for (int j = below; j <= above; ++j) {
    if (j != at) add(j);
  }
  const double left = (v[i] - v[i - 1]) / profile.spacing;
  const double right = i == last ? left : (v[i + 1] - v[i]) / profile.spacing;
  const double slope = polynomial_slope(x, y);
  if (left > 0 && right > 0) return std::max(0.0, std::min({slope, 3 * left, 3 * right}));
  if (left < 0 && right < 0) return std::min(0.0, std::max({slope, 3 * left, 3 * right}));
  return 0;
}

ShapeValue profile_value(const RadialProfile& profile, double q) {
  const auto& v = profile.values;
  const double h = profile.spacing;
  std::size_t i = 0;
  while (i + 2 < v.size() && h * static_cast<double>(i + 1) < q) ++i;
  const double s = (q - h * static_cast<double>(i)) / h;
  const double d0 = point_slope(profile, i), d1 = point_slope(profile, i + 1);
  // Hermite's basis.
  const double value = (1 + 2 * s) * (1 - s) * (1 - s) * v[i] + s * (1 - s) * (1 - s) * h * d0 +
                       s * s * (3 - 2 * s) * v[i + 1] + s * s * (s - 1) * h * d1;
  const double derivative =
      6 * s * (s - 1) * (v[i] - v[i + 1]) / h + (3 * s - 1) * (s - 1) * d0 + s * (3 * s - 2) * d1;
  return {value, derivative};
}

}  // namespace

ShapeValue evaluate_shape(const KernelShape& shape, double q) {
  switch (shape.type) {
    case KernelType::gaussian:
      return {std::exp(-q * q / 2), -q * std::exp(-q * q / 2)};
    case KernelType::cubic_spline:  // Monaghan & Lattanzio (1985), over its value at 0
      return q < 1 ? polynomial({1, 0, -1.5, 0.75}, q) : polynomial({2, -3, 1.5, -0.25}, q);
    case KernelType::quintic_spline: {  // Morris (1996), over its value at 0
      const ShapeValue a = fifth_power(3, q), b = fifth_power(2, q), c = fifth_power(1, q);
      return {(a.value - 6 * b.value + 15 * c.value) / 66,
              (a.derivative - 6 * b.derivative + 15 * c.derivative) / 66};
    }
    // Price et al. (2018), Eqs. 18 to 20, over their values at 0.
    case KernelType::wendland_c2:
      return wendland(4, {1, 2}, q);
    case KernelType::wendland_c4:
      return wendland(6, {1, 3, 35. / 12}, q);
    case KernelType::wendland_c6:
      return wendland(8, {1, 4, 25. / 4, 4}, q);
    case KernelType::tabulated:
      return profile_value(shape.profile, q);
  }
  return {};
}

double support_of(const Kernel& kernel) {
  switch (kernel.shape.type) {
    case KernelType::gaussian:
      return kernel.support_factor;
    case KernelType::cubic_spline:
    case KernelType::wendland_c2:
    case KernelType::wendland_c4:
    case KernelType::wendland_c6:
      return 2;
    case KernelType::quintic_spline:
      return 3;
    case KernelType::tabulated:
      return kernel.shape.profile.spacing *
             static_cast<double>(kernel.shape.profile.values.size() - 1);
  }
  return 0;
}

double kernel_integral(const Kernel& kernel) {
  if (kernel.shape.type == KernelType::gaussian) {
    return truncated_gaussian_integral(1, kernel.support_factor);
  }
  constexpr int intervals = 6000;
  const double width = support_of(kernel) / intervals;
  double sum = 0;
  for (int i = 0; i <= intervals; ++i) {
    const double q = i * width;
    const int weight = i == 0 || i == intervals ? 1 : (i % 2 == 1 ? 4 : 2);
    sum += weight * q * q * evaluate_shape(kernel.shape, q).value;
  }
  return 4 * std::numbers::pi * sum * width / 3;
}

}  // namespace motes::reference
