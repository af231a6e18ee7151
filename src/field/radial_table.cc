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

/// A kernel divided into even segments.
struct Segments {
  const Kernel& kernel;
  int count;

  double width() const { return kernel.support() / count; }
  /// Through the values at both ends of segment i, with the slopes there.
  Cubic fit(int i) const {
    // The support ends at the last one, whatever rounding says.
    const double begin = i * width(), end = std::min(begin + width(), kernel.support());
    const RadialValue a = evaluate(kernel, begin), b = evaluate(kernel, end);
    const double m0 = -a.steepness * begin * width(), m1 = -b.steepness * end * width();
    const double rise = b.value - a.value;
    return {{a.value, m0, 3 * rise - 2 * m0 - m1, m0 + m1 - 2 * rise}};
  }
};

/// Whether so many segments stand for those of the profile.
bool are_enough(const Segments& segments) {
  const Kernel& kernel = segments.kernel;
  constexpr int places = 8;  // of each of the profile's steps
  const auto last = static_cast<int>(kernel.shape.profile.values.size() - 1) * places;
  double value = 0, slope = 0, value_error = 0, slope_error = 0;
  for (int k = 0; k < last; ++k) {
    const double q = k * kernel.support() / last, place = q / segments.width();
    const int i = std::min(static_cast<int>(place), segments.count - 1);
    const Cubic cubic = segments.fit(i);
    const RadialValue truth = evaluate(kernel, q);
    const double true_slope = -truth.steepness * q;
    value = std::max(value, std::abs(truth.value));
    slope = std::max(slope, std::abs(true_slope));
    value_error = std::max(value_error, std::abs(cubic.at(place - i) - truth.value));
    slope_error =
        std::max(slope_error, std::abs(cubic.slope_at(place - i) / segments.width() - true_slope));
  }
  return value_error <= 1e-6 * value && slope_error <= 1e-5 * slope;
}

}  // namespace

RadialTable make_radial_table(const Kernel& kernel) {
  assert(kernel.shape.type == KernelType::tabulated);
  Segments segments{kernel, static_cast<int>(kernel.shape.profile.values.size() - 1)};
  const Segments fewer{kernel, RadialTable::few};
  if (segments.count > fewer.count && are_enough(fewer)) segments.count = fewer.count;
  RadialTable table;
  table.support_sq = static_cast<float>(kernel.support() * kernel.support());
  table.segments_per_radius = static_cast<float>(1 / segments.width());
  table.last_segment = static_cast<float>(segments.count - 1);
  for (int i = 0; i < segments.count; ++i) {
    for (const double c : segments.fit(i).c) table.coefficients.push_back(static_cast<float>(c));
  }
  return table;
}

}  // namespace motes
