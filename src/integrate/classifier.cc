#include "integrate/classifier.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

namespace motes {
namespace {

/// A point with its argument: what the segments interpolate over.
struct Knot {
  double argument;
  double values[4];
};

/// Extinction where the argument is that of a field value of zero.
double extinction_of_zero(const std::vector<Knot>& knots, bool log_scale) {
  if (log_scale || 0 <= knots.front().argument) return knots.front().values[3];
  for (std::size_t i = 1; i < knots.size(); ++i) {
    const Knot &a = knots[i - 1], &b = knots[i];
    if (0 < b.argument) {
      return a.values[3] + (b.values[3] - a.values[3]) * -a.argument / (b.argument - a.argument);
    }
  }
  return knots.back().values[3];
}

/// One over the distance of neighbouring knots; 0 where distances differ.
double inverse_spacing_of(const std::vector<Knot>& knots) {
  const double first = knots.front().argument;
  const auto segments = static_cast<double>(knots.size() - 1);
  const double spacing = (knots.back().argument - first) / segments;
  if (!(spacing > 0)) return 0;
  for (std::size_t i = 1; i < knots.size(); ++i) {
    const double expected = first + static_cast<double>(i) * spacing;
    if (std::abs(knots[i].argument - expected) > 1e-6 * spacing) return 0;
  }
  return 1 / spacing;
}

}  // namespace

Classifier compile_transfer_function(const TransferFunction& function, double value_scale,
                                     double step_size) {
  assert(!function.points.empty());
  std::vector<Knot> knots;
  for (const TransferFunction::Point& p : function.points) {
    const double argument = function.log_scale ? std::log10(p.value) : p.value * value_scale;
    knots.push_back({argument, {p.color.r, p.color.g, p.color.b, p.extinction * step_size}});
  }

  Classifier c;
  c.log_scale = function.log_scale;
  c.log_shift = static_cast<float>(-std::log10(value_scale));
  // A single point is one flat segment.
  const std::size_t segments = std::max<std::size_t>(1, knots.size() - 1);
  c.num_segments = static_cast<int>(segments);
  c.row_size = (segments + max_lanes - 1) / max_lanes * max_lanes;
  c.table.assign(Classifier::num_rows * c.row_size + max_lanes, 0.0f);
  c.records.resize(Classifier::record_size * segments);
  c.inverse_spacing = static_cast<float>(std::min(inverse_spacing_of(knots), 1e38));
  for (std::size_t s = 0; s < segments; ++s) {
    const Knot &a = knots[s], &b = knots[std::min(s + 1, knots.size() - 1)];
    const auto entry = [&](int row) -> float& {
      return c.table[static_cast<std::size_t>(row) * c.row_size + s];
    };
    const double width = b.argument - a.argument;
    entry(Classifier::begin) = static_cast<float>(a.argument);
    entry(Classifier::inverse_width) =
        width > 0 ? static_cast<float>(std::min(1 / width, 1e38)) : 0.0f;
    for (int i = 0; i < 4; ++i) {
      entry(Classifier::base + i) = static_cast<float>(a.values[i]);
      entry(Classifier::rise + i) = static_cast<float>(b.values[i] - a.values[i]);
      float* const record = &c.records[Classifier::record_size * s + static_cast<std::size_t>(i)];
      record[0] = entry(Classifier::base + i);
      record[4] = entry(Classifier::rise + i);
    }
  }

  for (const Knot& k : knots) c.max_depth = std::max(c.max_depth, static_cast<float>(k.values[3]));

  // The transparent beginning: up to the last of the leading points without extinction.
  constexpr float infinity = std::numeric_limits<float>::infinity();
  const auto visible =
      std::find_if(knots.begin(), knots.end(), [](const Knot& k) { return k.values[3] > 0; });
  if (visible == knots.begin()) {
    c.visibility.above = -infinity;
  } else if (visible == knots.end()) {
    c.visibility.above = infinity;
  } else {
    const double argument = (visible - 1)->argument;
    c.visibility.above =
        static_cast<float>(function.log_scale ? std::pow(10, argument) * value_scale : argument);
  }
  const bool zero_is_transparent = extinction_of_zero(knots, function.log_scale) == 0;
  c.visibility.hidden = zero_is_transparent ? 0 : std::numeric_limits<float>::infinity();
  return c;
}

}  // namespace motes
