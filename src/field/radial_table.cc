#include "field/radial_table.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

namespace motes {
namespace {

std::size_t num_steps(const Kernel& kernel) { return kernel.shape.profile.values.size() - 1; }

/// A kernel's support in segments that are even in the distance, or in its square.
struct Segments {
  const Kernel& kernel;
  std::size_t count;
  bool of_squares = false;

  /// Of the support, in what the segments are even in.
  double extent() const {
    return of_squares ? kernel.support() * kernel.support() : kernel.support();
  }
  double width() const { return extent() / static_cast<double>(count); }
  double place_of(double q) const { return (of_squares ? q * q : q) / width(); }
  double distance_at(double place) const {
    const double x = place * width();
    // The support ends at the last one, whatever rounding says.
    return std::min(of_squares ? std::sqrt(x) : x, kernel.support());
  }
  /// The slope by the distance, from that by the place.
  double slope_at(double q, double by_place) const {
    return (of_squares ? 2 * q : 1) * by_place / width();
  }
  TableSegments rounded() const {
    return {of_squares, static_cast<float>(1 / width()), static_cast<float>(count - 1)};
  }
};

using Cubic = std::array<double, RadialTable::record_size>;

/// The profile's curve between q and the end of that step, `width` long.
Cubic cubic_of_step(const Kernel& kernel, double q, double width) {
  const double end = std::min(q + width, kernel.support());
  const RadialValue a = evaluate(kernel, q), b = evaluate(kernel, end);
  const double m0 = -a.steepness * q * width, m1 = -b.steepness * end * width;
  const double rise = b.value - a.value;
  return {0.5 * (a.value + b.value) + 0.125 * (m0 - m1), 1.5 * rise - 0.25 * (m0 + m1),
          0.5 * (m1 - m0), m0 + m1 - 2 * rise};
}

struct Polynomial {
  static constexpr std::size_t degree = RadialTable::smooth_degree;
  std::array<double, degree + 1> c{};

  RadialValue at(double t) const {  ///< with the slope for a steepness
    RadialValue out;
    for (std::size_t k = degree + 1; k-- > 0;) {
      out.steepness = out.steepness * t + out.value;
      out.value = out.value * t + c[k];
    }
    return out;
  }
};

/// Through the kernel's values at Chebyshev's extrema, of which the ends of the segment are two:
/// the next one's begin where it ends.
Polynomial fit(const Segments& segments, std::size_t segment) {
  constexpr std::size_t n = Polynomial::degree;
  std::array<double, n + 1> t, difference;
  for (std::size_t k = 0; k <= n; ++k) {
    t[k] = -0.5 * std::cos(std::numbers::pi * static_cast<double>(k) / n);
    const double place = static_cast<double>(segment) + 0.5 + t[k];
    difference[k] = evaluate(segments.kernel, segments.distance_at(place)).value;
  }
  // Newton's form, then its product multiplied out.
  for (std::size_t order = 1; order <= n; ++order) {
    for (std::size_t k = n; k >= order; --k) {
      difference[k] = (difference[k] - difference[k - 1]) / (t[k] - t[k - order]);
    }
  }
  Polynomial out;
  for (std::size_t k = n + 1; k-- > 0;) {
    for (std::size_t i = n; i > 0; --i) out.c[i] = out.c[i - 1] - t[k] * out.c[i];
    out.c[0] = difference[k] - t[k] * out.c[0];
  }
  return out;
}

/// Whether the polynomials of `segments` stand for the profile's curve.
bool are_enough(const Segments& segments, const std::vector<Polynomial>& polynomials) {
  const Kernel& kernel = segments.kernel;
  constexpr std::size_t places = 8;  // of each step, and many of each segment
  const std::size_t last = std::max(num_steps(kernel), 8 * segments.count) * places;
  double value = 0, slope = 0, value_error = 0, slope_error = 0;
  for (std::size_t k = 0; k < last; ++k) {
    const double q = static_cast<double>(k) * kernel.support() / static_cast<double>(last);
    const double place = segments.place_of(q);
    const std::size_t i = std::min(static_cast<std::size_t>(place), segments.count - 1);
    const auto [found, by_place] = polynomials[i].at(place - static_cast<double>(i) - 0.5);
    const RadialValue truth = evaluate(kernel, q);
    const double true_slope = -truth.steepness * q;
    value = std::max(value, std::abs(truth.value));
    slope = std::max(slope, std::abs(true_slope));
    value_error = std::max(value_error, std::abs(found - truth.value));
    slope_error = std::max(slope_error, std::abs(segments.slope_at(q, by_place) - true_slope));
  }
  return value_error <= 1e-6 * value && slope_error <= 1e-5 * slope;
}

/// Sets the table's polynomials if they are enough; whether they are.
bool set_smooth(const Segments& segments, RadialTable& table) {
  std::vector<Polynomial> polynomials;
  for (std::size_t i = 0; i < segments.count; ++i) polynomials.push_back(fit(segments, i));
  if (!are_enough(segments, polynomials)) return false;
  table.smooth = segments.rounded();
  for (std::size_t k = 0; k <= Polynomial::degree; ++k) {
    for (std::size_t i = 0; i < RadialTable::smooth_row; ++i) {
      table.rows.push_back(static_cast<float>(polynomials[i % segments.count].c[k]));
    }
  }
  return true;
}

}  // namespace

RadialTable make_radial_table(const Kernel& kernel) {
  assert(kernel.shape.type == KernelType::tabulated);
  RadialTable table;
  table.support_sq = static_cast<float>(kernel.support() * kernel.support());
  const Segments steps{kernel, num_steps(kernel)};
  table.steps = steps.rounded();
  for (std::size_t i = 0; i < steps.count; ++i) {
    const double q = static_cast<double>(i) * steps.width();
    for (const double c : cubic_of_step(kernel, q, steps.width())) {
      table.records.push_back(static_cast<float>(c));
    }
  }
  for (const bool of_squares : {true, false}) {
    if (set_smooth({kernel, RadialTable::smooth_segments, of_squares}, table)) break;
  }
  return table;
}

}  // namespace motes
