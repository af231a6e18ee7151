// Step sizes and transfer functions fitted to the data.
#include "scene/fit.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

#include "core/error.h"
#include "scene/fit_levels.h"

namespace motes {
namespace {

constexpr double max_samples = 2048;            // along the diagonal of the volume
constexpr double small_area = 0.05;             // of what the Gaussians cover
constexpr std::size_t radii_looked_at = 65536;  // of one field: enough for a quantile

// Where values of one sign span more decades than this, their scale is logarithmic.
constexpr double log_decades = 2.5;
// Of the rays that meet matter, on average: neither fog nor block. Several fields share it.
constexpr double target_over_black = 0.7, target_over_white = 0.9;  // white bleaches
constexpr double part_around_solids = 0.6;  // of these: balls and sticks within are to be seen
// Where values span decades, what is dense lies behind much that is not. So the extinction rises
// with this power of the place in the range, and this much of the light of the densest place on a
// ray comes through what is in front of it, unless so little opacity is left that all is faint.
constexpr double log_steepness = 1.5;
constexpr double light_of_peaks = 0.6;
constexpr double least_opacity = 0.3 / 0.7;  // of the opacity aimed at
constexpr int log_points = 9;                // of one colour
// Of values of both signs extinction rises steeply to this part of it, as far on the way from the
// transparent middle to the end: nearly surfaces, and more where magnitudes are large.
constexpr double shoulder = 0.5, shoulder_place = 0.06;
constexpr float paleness = 0.35f;  // of a species' colour at the largest values: shape shows
constexpr const char* default_map = "viridis";

/// The value below which `fraction` of `values` lie; reorders them. Precondition: not empty.
double quantile(std::vector<float>& values, double fraction) {
  const auto rank = static_cast<std::size_t>(fraction * static_cast<double>(values.size() - 1));
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(rank);
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

/// Relative luminance of linear RGB (ITU-R BT.709).
double luminance(const Color& c) { return 0.2126 * c.r + 0.7152 * c.g + 0.0722 * c.b; }

/// Calls `look` with widths of the field's particles: all, or evenly many.
template <class F>
void for_some_radii(const FieldSource& field, F&& look) {
  const std::size_t stride = 1 + field.index.size() / radii_looked_at;
  for (std::size_t i = 0; i < field.index.size(); i += stride)
    look(static_cast<float>(field.width_of(i)));
}

struct Range {
  double low = 0, high = 1;
  bool log_scale = false, both_signs = false;
  double middle = 0;     ///< of both signs: up to this magnitude all is transparent
  double steepness = 1;  ///< the extinction rises with this power of the place in the range

  /// The value at a place of the range, 0 to 1.
  double value_at(double place) const {
    return log_scale ? low * std::pow(high / low, place) : low + place * (high - low);
  }
};

Range fit_range(const RayProfiles& profiles, std::optional<bool> log_scale) {
  std::vector<float> positive, absolute;
  for (const float v : profiles.values) {
    if (!std::isfinite(v) || v == 0) continue;
    if (v > 0) positive.push_back(v);
    absolute.push_back(std::abs(v));
  }
  if (absolute.empty()) return {};
  Range range;
  const bool wants_log = log_scale.value_or(false) && !positive.empty();
  if (signs_of(profiles.values) != Signs::positive && !wants_log) {
    range.both_signs = true;
    range.high = quantile(absolute, 0.999);
    range.low = -range.high;
    range.middle = std::min(enclosing_level(profiles.values, Signs::both), 0.5 * range.high);
    return range;
  }
  const double largest = quantile(positive, 0.999);
  const double small = quantile(positive, 0.05);
  range.log_scale = log_scale.value_or(std::log10(largest / small) > log_decades);
  // Over decades most of the volume is all but empty: voids, which would veil the rest.
  range.low = quantile(positive, range.log_scale ? 0.7 : 0.5);
  range.high = largest;
  if (!(range.low < range.high)) {  // (nearly) one value everywhere: a slab
    range.low = 0.5 * range.high;
    range.high *= 1.5;
  }
  return range;
}

/// How far `value` lies in the range, 0 to 1.
double place(const Range& range, double value) {
  if (range.both_signs) {
    return std::clamp((std::abs(value) - range.middle) / (range.high - range.middle), 0.0, 1.0);
  }
  if (range.log_scale) {
    if (!(value > range.low)) return 0;
    return std::min(std::log(value / range.low) / std::log(range.high / range.low), 1.0);
  }
  return std::clamp((value - range.low) / (range.high - range.low), 0.0, 1.0);
}

/// The extinction at `value`, as a part of that at the end of the range.
double ramp(const Range& range, double value) {
  const double at = place(range, value);
  if (!range.both_signs) return std::pow(at, range.steepness);
  if (at < shoulder_place) return shoulder * at / shoulder_place;
  return shoulder + (1 - shoulder) * (at - shoulder_place) / (1 - shoulder_place);
}

/// Where the ramp of values of both signs bends, increasing.
std::array<double, 6> bends(const Range& range) {
  const double rise = range.middle + shoulder_place * (range.high - range.middle);
  return {-range.high, -rise, -range.middle, range.middle, rise, range.high};
}

/// A ray that meets matter, for an extinction of 1 at the end of the range.
struct RayDepth {
  double whole = 0;     ///< optical depth
  double in_front = 0;  ///< of what lies in front of the largest value
  double peak = 0;      ///< extinction at the largest value
};

std::vector<RayDepth> ray_depths(const RayProfiles& profiles, const Range& range) {
  std::vector<RayDepth> rays;
  for (std::size_t r = 0; r < profiles.spacing.size(); ++r) {
    RayDepth ray;
    for (std::size_t k = profiles.ray_begin[r]; k < profiles.ray_begin[r + 1]; ++k) {
      const double extinction = ramp(range, profiles.values[k]);
      if (extinction > ray.peak) {
        ray.peak = extinction;
        ray.in_front = ray.whole;
      }
      ray.whole += extinction * profiles.spacing[r];
    }
    if (ray.whole > 0) rays.push_back(ray);
  }
  return rays;
}

/// The extinction at the end of the range that makes rays through matter as opaque as they should
/// be on average; less where that would hide what is dense.
double fit_extinction(const RayProfiles& profiles, const Range& range, double opacity) {
  std::vector<RayDepth> rays = ray_depths(profiles, range);
  if (rays.empty()) return 1;
  const auto mean_opacity = [&rays](double extinction) {
    double sum = 0;
    for (const RayDepth& ray : rays) sum += 1 - std::exp(-extinction * ray.whole);
    return sum / static_cast<double>(rays.size());
  };
  const auto hides_peaks = [&](double extinction) {
    if (!range.log_scale) return false;
    double seen = 0, all = 0;
    for (const RayDepth& ray : rays) {
      seen += ray.peak * std::exp(-extinction * ray.in_front);
      all += ray.peak;
    }
    return seen < light_of_peaks * all;
  };
  // All of this grows with the extinction: bisect its logarithm about one over the middle depth.
  const auto middle = rays.begin() + static_cast<std::ptrdiff_t>(rays.size() / 2);
  std::nth_element(rays.begin(), middle, rays.end(),
                   [](const RayDepth& a, const RayDepth& b) { return a.whole < b.whole; });
  double low = 1e-8 / middle->whole, high = 1e8 / middle->whole;
  for (int step = 0; step < 60; ++step) {
    const double extinction = std::sqrt(low) * std::sqrt(high);
    const double reached = mean_opacity(extinction);
    const bool too_faint =
        reached < least_opacity * opacity || (reached < opacity && !hides_peaks(extinction));
    (too_faint ? low : high) = extinction;
  }
  return high;
}

/// Of colours for values from 0 on and below.
TransferFunction plain_colors(const Color& positive, const Color& negative, const Range& range,
                              double extinction) {
  const auto paler = [](float channel, float part) {
    return channel + part * paleness * (1 - channel);
  };
  const auto point = [&](double value) {
    const auto part = static_cast<float>(place(range, value));
    const Color& color = value < 0 ? negative : positive;
    const Color pale{paler(color.r, part), paler(color.g, part), paler(color.b, part)};
    return TransferFunction::Point{value, pale, extinction * ramp(range, value)};
  };
  TransferFunction function;
  function.log_scale = range.log_scale;
  if (range.both_signs) {
    for (const double value : bends(range)) function.points.push_back(point(value));
    return function;
  }
  const int last = range.steepness == 1 ? 1 : log_points - 1;
  for (int k = 0; k <= last; ++k) {
    function.points.push_back(point(range.value_at(static_cast<double>(k) / last)));
  }
  return function;
}

/// Adds what the function has at `values` to its points.
void add_points(std::span<const double> values, TransferFunction& function) {
  std::vector<TransferFunction::Point> points = function.points;
  for (const double value : values) points.push_back(point_at(function, value));
  using Point = TransferFunction::Point;
  std::sort(points.begin(), points.end(),
            [](const Point& a, const Point& b) { return a.value < b.value; });
  const auto repeated =
      std::unique(points.begin(), points.end(),
                  [](const Point& a, const Point& b) { return a.value == b.value; });
  points.erase(repeated, points.end());
  function.points = std::move(points);
}

}  // namespace

double default_step_size(const std::vector<FieldSource>& fields, const Bounds3d& box) {
  std::vector<float> radii;
  double area = 0;
  double step = std::numeric_limits<double>::infinity();
  for (const FieldSource& field : fields) {
    if (field.grid) {
      for (const Vector3d& edge : field.grid->steps) step = std::min(step, 0.5 * length(edge));
    }
    for_some_radii(field, [&](float radius) {
      radii.push_back(radius);
      area += double{radius} * radius;
    });
  }
  std::sort(radii.begin(), radii.end());
  double below = 0;
  const auto small = std::find_if(radii.begin(), radii.end(), [&](float radius) {
    return (below += double{radius} * radius) > small_area * area;
  });
  if (!radii.empty()) step = std::min(step, 0.5 * (small == radii.end() ? radii.back() : *small));
  return std::max(step, length(box.diagonal()) / max_samples);
}

double fit_opacity(const std::vector<RayProfiles>& profiles, const Color& background,
                   bool around_solids) {
  const double target =
      (around_solids ? part_around_solids : 1) *
      std::lerp(target_over_black, target_over_white, std::min(luminance(background), 1.0));
  if (profiles.size() < 2) return target;
  // How many rays meet 1, 2, ... fields.
  std::vector<double> num_rays(profiles.size());
  double sum = 0;
  for (std::size_t ray = 0; ray < profiles[0].spacing.size(); ++ray) {
    std::size_t met = 0;
    for (const RayProfiles& field : profiles) {
      const auto value = [&](std::size_t k) {
        return field.values.begin() + static_cast<std::ptrdiff_t>(field.ray_begin[k]);
      };
      if (std::any_of(value(ray), value(ray + 1), [](float v) { return v != 0; })) ++met;
    }
    if (met == 0) continue;
    ++num_rays[met - 1];
    ++sum;
  }
  double low = 0, high = target;
  for (int step = 0; step < 30; ++step) {
    const double opacity = (low + high) / 2;
    double total = 0;
    for (std::size_t met = 0; met < num_rays.size(); ++met) {
      total += num_rays[met] * (1 - std::pow(1 - opacity, static_cast<double>(met + 1)));
    }
    (total < target * sum ? low : high) = opacity;
  }
  return high;
}

TransferFunction fit_transfer_function(const decltype(Field::transfer_function)& wish,
                                       const FieldColors& colors, const RayProfiles& profiles,
                                       double opacity) {
  if (const auto* given = std::get_if<TransferFunction>(&wish)) return *given;
  NamedTransferFunction named;
  if (const auto* given = std::get_if<NamedTransferFunction>(&wish)) named = *given;

  Range range;
  if (named.range) {
    range.low = named.range->first;
    range.high = named.range->second;
    range.log_scale = named.log_scale.value_or(false);
  } else {
    range = fit_range(profiles, named.log_scale);
  }
  if (range.log_scale && !named.extinction) range.steepness = log_steepness;
  const double extinction =
      named.extinction ? *named.extinction : fit_extinction(profiles, range, opacity);

  if (named.name.empty() && range.both_signs) {
    return plain_colors(colors.positive, colors.negative, range, extinction);
  }
  if (named.name == species_colors || (named.name.empty() && colors.prefers_own)) {
    return plain_colors(colors.own, colors.own, range, extinction);
  }
  TransferFunction function =
      named_transfer_function(named.name.empty() ? default_map : named.name, range.low, range.high,
                              extinction, range.log_scale);
  if (range.both_signs) add_points(bends(range), function);
  for (auto& point : function.points) point.extinction = extinction * ramp(range, point.value);
  return function;
}

}  // namespace motes
