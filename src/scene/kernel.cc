#include "scene/kernel.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <string>
#include <utility>

#include "core/error.h"

namespace motes {
namespace {

constexpr std::array<std::pair<KernelType, std::string_view>, 7> kernel_names{{
    {KernelType::gaussian, "gaussian"},
    {KernelType::cubic_spline, "cubic_spline"},
    {KernelType::quintic_spline, "quintic_spline"},
    {KernelType::wendland_c2, "wendland_c2"},
    {KernelType::wendland_c4, "wendland_c4"},
    {KernelType::wendland_c6, "wendland_c6"},
    {KernelType::tabulated, "tabulated"},
}};

/// The derivative at `i` times the step, by the polynomial through five points; those beyond 0 are
/// the mirror's. Of short tables, at their ends, through fewer.
double difference_at(const std::vector<double>& values, std::size_t i) {
  const auto v = [&](int offset) {
    return values[static_cast<std::size_t>(std::abs(static_cast<int>(i) + offset))];
  };
  const std::size_t last = values.size() - 1;
  if (i + 2 <= last) return (8 * (v(1) - v(-1)) - (v(2) - v(-2))) / 12;
  if (last < 4) return i == last ? v(0) - v(-1) : 0.5 * (v(1) - v(-1));
  if (i + 1 == last) return (3 * v(1) + 10 * v(0) - 18 * v(-1) + 6 * v(-2) - v(-3)) / 12;
  return (25 * v(0) - 48 * v(-1) + 36 * v(-2) - 16 * v(-3) + 3 * v(-4)) / 12;
}

/// What the value at `i` rises by over a step of the profile, as the curve has it there: limited so
/// that the curve rises and falls with the values (Hyman 1983).
double rise_at(const std::vector<double>& values, std::size_t i) {
  if (i == 0) return 0;
  const bool is_last = i + 1 == values.size();
  if (is_last && values[i] == 0) return 0;
  const double before = values[i] - values[i - 1];
  const double after = is_last ? before : values[i + 1] - values[i];
  if (before * after <= 0) return 0;
  const double steepest = 3 * (before > 0 ? std::min(before, after) : std::max(before, after));
  const double rise = difference_at(values, i);
  return steepest > 0 ? std::clamp(rise, 0.0, steepest) : std::clamp(rise, steepest, 0.0);
}

RadialValue evaluate_table(const RadialProfile& profile, double q) {
  const auto& values = profile.values;
  const double place = q / profile.spacing;
  const std::size_t i = std::min(static_cast<std::size_t>(place), values.size() - 2);
  // The cubic through both values with the slopes there.
  const double t = place - static_cast<double>(i);
  const double rise = values[i + 1] - values[i];
  const double m0 = rise_at(values, i), m1 = rise_at(values, i + 1);
  const double c2 = 3 * rise - 2 * m0 - m1, c3 = m0 + m1 - 2 * rise;
  const double value = values[i] + t * (m0 + t * (c2 + t * c3));
  if (i == 0) return {value, -(2 * c2 + 3 * c3 * t) / (profile.spacing * profile.spacing)};
  return {value, -(m0 + t * (2 * c2 + 3 * c3 * t)) / (profile.spacing * q)};
}

/// 4 pi times the integral of q^2 value: of each piece, which is a cubic, by Gauss's formula of
/// three points, exact to the fifth power.
double integral_of_table(const RadialProfile& profile) {
  const double node = std::sqrt(0.6), half = 0.5 * profile.spacing;
  double sum = 0;
  for (std::size_t i = 0; i + 1 < profile.values.size(); ++i) {
    const double middle = half * static_cast<double>(2 * i + 1);
    for (const auto& [place, weight] :
         {std::pair{-node, 5.0 / 9}, {0.0, 8.0 / 9}, {node, 5.0 / 9}}) {
      const double q = middle + half * place;
      sum += half * weight * q * q * evaluate_table(profile, q).value;
    }
  }
  return 4 * std::numbers::pi * sum;
}

double power(double x, int n) {
  double product = 1;
  for (int i = 0; i < n; ++i) product *= x;
  return product;
}

}  // namespace

double Kernel::support() const {
  switch (shape.type) {
    case KernelType::gaussian:
      return support_factor;
    case KernelType::quintic_spline:
      return 3;
    case KernelType::tabulated:
      return shape.profile.spacing * static_cast<double>(shape.profile.values.size() - 1);
    default:
      return 2;
  }
}

double Kernel::integral() const {
  using std::numbers::pi;
  switch (shape.type) {
    case KernelType::gaussian:
      return std::pow(2 * pi, 1.5) *
             (std::erf(support_factor / std::numbers::sqrt2) -
              std::sqrt(2 / pi) * support_factor * std::exp(-support_factor * support_factor / 2));
    case KernelType::cubic_spline:
      return pi;
    case KernelType::quintic_spline:
      return 120 * pi / 66;
    case KernelType::wendland_c2:
      return 16 * pi / 21;
    case KernelType::wendland_c4:
      return 256 * pi / 495;
    case KernelType::wendland_c6:
      return 512 * pi / 1365;
    case KernelType::tabulated:
      return integral_of_table(shape.profile);
  }
  return 0;
}

double Kernel::standard_deviation() const {
  // Support over twice the standard deviation: Dehnen & Aly (2012), Table 1.
  switch (shape.type) {
    case KernelType::cubic_spline:
      return 1 / 1.825742;
    case KernelType::quintic_spline:
      return 1.5 / 2.195775;
    case KernelType::wendland_c2:
      return 1 / 1.936492;
    case KernelType::wendland_c4:
      return 1 / 2.207940;
    case KernelType::wendland_c6:
      return 1 / 2.449490;
    case KernelType::tabulated:
      return support() / 3;
    case KernelType::gaussian:
      return 1;
  }
  return 1;
}

RadialValue evaluate(const Kernel& kernel, double q) {
  assert(q >= 0);
  if (q > kernel.support()) return {};
  const double t = 1 - 0.5 * q, p = 0.5 * q;
  switch (kernel.shape.type) {
    case KernelType::gaussian: {
      const double value = std::exp(-0.5 * q * q);
      return {value, value};
    }
    case KernelType::cubic_spline: {
      const double outer = 2 - q, inner = std::max(1 - q, 0.0);
      const double value = 0.25 * power(outer, 3) - power(inner, 3);
      if (q < 1) return {value, 3 - 2.25 * q};
      return {value, 0.75 * outer * outer / q};
    }
    case KernelType::quintic_spline: {
      const double a = 3 - q, b = std::max(2 - q, 0.0), c = std::max(1 - q, 0.0);
      const double value = (power(a, 5) - 6 * power(b, 5) + 15 * power(c, 5)) / 66;
      if (q < 1) return {value, (120 - 120 * q * q + 50 * q * q * q) / 66};
      return {value, 5 * (power(a, 4) - 6 * power(b, 4)) / (66 * q)};
    }
    case KernelType::wendland_c2:
      return {power(t, 4) * (4 * p + 1), 5 * power(t, 3)};
    case KernelType::wendland_c4:
      return {power(t, 6) * ((35.0 / 3 * p + 6) * p + 1), 14.0 / 3 * (1 + 5 * p) * power(t, 5)};
    case KernelType::wendland_c6:
      return {power(t, 8) * (((32 * p + 25) * p + 8) * p + 1),
              5.5 * ((16 * p + 7) * p + 1) * power(t, 7)};
    case KernelType::tabulated:
      return evaluate_table(kernel.shape.profile, q);
  }
  return {};
}

KernelType kernel_type_from_name(std::string_view name) {
  std::vector<std::string> names;
  for (const auto& [type, known] : kernel_names) {
    if (known == name) return type;
    names.emplace_back(known);
  }
  throw unknown_name("kernel", name, names);
}

std::string_view name_of(KernelType type) {
  return std::find_if(kernel_names.begin(), kernel_names.end(),
                      [&](const auto& each) { return each.first == type; })
      ->second;
}

}  // namespace motes
