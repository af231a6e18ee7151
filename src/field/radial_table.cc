#include "field/radial_table.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace motes {
namespace {

/// Over a segment, in the place within it.
struct Cubic {
  double c[RadialTable::record_size];
  double at(double t) const { return c[0] + t * (c[1] + t * (c[2] + t * c[3])); }
  double slope_at(double t) const { return c[1] + t * (2 * c[2] + 3 * t * c[3]); }
};

/// A kernel divided into segments that are even in the distance, or in its square.
struct Segments {
  const Kernel& kernel;
  int count;
  bool of_squares = false;

  /// Of the support, in what the segments are even in.
  double extent() const {
    return of_squares ? kernel.support() * kernel.support() : kernel.support();
  }
  double width() const { return extent() / count; }
  double place_of(double q) const { return (of_squares ? q * q : q) / width(); }
  /// The slope by the distance, from that by the place within a segment.
  double slope_at(double q, double by_place) const {
    return (of_squares ? 2 * q : 1) * by_place / width();
  }

  /// Through the values at both ends of segment i, with the slopes there.
  Cubic fit(int i) const {
    // The support ends at the last one, whatever rounding says.
    const double begin = i * width(), end = std::min(begin + width(), extent());
    const RadialValue a = value_at(begin), b = value_at(end);
    const double m0 = slope_by_place(a, begin), m1 = slope_by_place(b, end);
    const double rise = b.value - a.value;
    return {{a.value, m0, 3 * rise - 2 * m0 - m1, m0 + m1 - 2 * rise}};
  }

 private:
  RadialValue value_at(double x) const {
    return evaluate(kernel, of_squares ? std::min(std::sqrt(x), kernel.support()) : x);
  }
  double slope_by_place(const RadialValue& value, double x) const {
    return -value.steepness * (of_squares ? 0.5 : x) * width();
  }
};

/// Whether so many segments stand for those of the profile.
bool are_enough(const Segments& segments) {
  const Kernel& kernel = segments.kernel;
  constexpr int places = 8;  // of each of the profile's steps, or of the segments
  const auto steps = static_cast<int>(kernel.shape.profile.values.size() - 1);
  const int last = std::max(steps, segments.count) * places;
  double value = 0, slope = 0, value_error = 0, slope_error = 0;
  for (int k = 0; k < last; ++k) {
    const double q = k * kernel.support() / last, place = segments.place_of(q);
    const int i = std::min(static_cast<int>(place), segments.count - 1);
    const Cubic cubic = segments.fit(i);
    const RadialValue truth = evaluate(kernel, q);
    const double true_slope = -truth.steepness * q;
    value = std::max(value, std::abs(truth.value));
    slope = std::max(slope, std::abs(true_slope));
    value_error = std::max(value_error, std::abs(cubic.at(place - i) - truth.value));
    slope_error = std::max(slope_error,
                           std::abs(segments.slope_at(q, cubic.slope_at(place - i)) - true_slope));
  }
  return value_error <= 1e-6 * value && slope_error <= 1e-5 * slope;
}

Segments choose_segments(const Kernel& kernel) {
  const Segments of_squares{kernel, RadialTable::few_of_squares, true};
  if (are_enough(of_squares)) return of_squares;
  const Segments own{kernel, static_cast<int>(kernel.shape.profile.values.size() - 1)};
  const Segments fewer{kernel, RadialTable::few};
  return own.count > fewer.count && are_enough(fewer) ? fewer : own;
}

}  // namespace

RadialTable make_radial_table(const Kernel& kernel) {
  assert(kernel.shape.type == KernelType::tabulated);
  const Segments segments = choose_segments(kernel);
  RadialTable table;
  table.of_squares = segments.of_squares;
  table.support_sq = static_cast<float>(kernel.support() * kernel.support());
  table.segments_per_unit = static_cast<float>(1 / segments.width());
  table.last_segment = static_cast<float>(segments.count - 1);
  for (int i = 0; i < segments.count; ++i) {
    for (const double c : segments.fit(i).c) table.coefficients.push_back(static_cast<float>(c));
  }
  return table;
}

}  // namespace motes
