// Tables of kernels: text files of two columns.
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iterator>
#include <optional>
#include <string_view>
#include <vector>

#include "core/error.h"
#include "scene/checked_json.h"
#include "scene/kernel.h"

namespace motes {
namespace {

constexpr std::size_t max_profile_points = 65536;
constexpr int even_steps = 1024;

constexpr std::string_view between = " \t\r,;";

/// The next number of a line, which is cut off its front; nullopt where there is none.
std::optional<double> next_number(std::string_view& line) {
  line.remove_prefix(std::min(line.find_first_not_of(between), line.size()));
  const std::string_view word = line.substr(0, line.find_first_of(between));
  line.remove_prefix(word.size());
  double value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc{} || end != word.data() + word.size() || !std::isfinite(value)) return {};
  return value;
}

struct Point {
  double distance, value;
};
using Points = std::vector<Point>;

Point parse_point(const std::filesystem::path& path, std::uint64_t number, std::string_view line) {
  std::string_view rest = line;
  const auto distance = next_number(rest), value = next_number(rest);
  if (!distance || !value || rest.find_first_not_of(between) != std::string_view::npos) {
    throw Error(path, number,
                fmt::format("expected a distance and a value, found '{}'", printable(line)));
  }
  return {*distance, *value};
}

Points read_points(const std::filesystem::path& path) {
  const std::string text = read_text(path);
  Points points;
  std::uint64_t number = 0;
  for (std::string_view rest = text; !rest.empty();) {
    const std::string_view line = rest.substr(0, rest.find('\n'));
    rest.remove_prefix(std::min(line.size() + 1, rest.size()));
    ++number;
    const auto start = line.find_first_not_of(between);
    if (start == std::string_view::npos || line[start] == '#') continue;
    const Point point = parse_point(path, number, line);
    if (points.empty() ? point.distance != 0 : !(point.distance > points.back().distance)) {
      throw Error(path, number,
                  fmt::format("expected distances from 0 on, each larger than the one before, "
                              "found {:g}",
                              point.distance));
    }
    if (points.size() == max_profile_points) {
      throw Error(path, number, fmt::format("expected at most {} points", max_profile_points));
    }
    points.push_back(point);
  }
  if (points.size() < 2) {
    throw Error(path, "expected two or more lines of a distance and a value");
  }
  return points;
}

/// Rise between point i and the next.
double secant(const Points& points, std::size_t i) {
  return (points[i + 1].value - points[i].value) / (points[i + 1].distance - points[i].distance);
}

/// Slope of the curve at point i: that of the parabola through it and its neighbours, limited so
/// that the curve rises and falls with the values (Hyman 1983).
double slope_at(const Points& points, std::size_t i) {
  if (i == 0) return 0;
  const double before = secant(points, i - 1);
  if (i + 1 == points.size()) return points[i].value == 0 ? 0 : before;
  const double after = secant(points, i);
  if (before * after <= 0) return 0;
  const double width_before = points[i].distance - points[i - 1].distance;
  const double width_after = points[i + 1].distance - points[i].distance;
  const double parabola =
      (width_after * before + width_before * after) / (width_before + width_after);
  const double steepest = 3 * std::min(std::abs(before), std::abs(after));
  return std::clamp(parabola, -steepest, steepest);
}

double curve_at(const Points& points, double distance) {
  const auto above = std::upper_bound(points.begin() + 1, points.end() - 1, distance,
                                      [](double at, const Point& p) { return at < p.distance; });
  const auto i = static_cast<std::size_t>(std::distance(points.begin(), above)) - 1;
  const double width = points[i + 1].distance - points[i].distance;
  const double t = (distance - points[i].distance) / width;
  const double rise = points[i + 1].value - points[i].value;
  const double m0 = width * slope_at(points, i), m1 = width * slope_at(points, i + 1);
  return points[i].value + t * (m0 + t * (3 * rise - 2 * m0 - m1 + t * (m0 + m1 - 2 * rise)));
}

/// As far as the digits of a file go.
bool are_even(const Points& points) {
  const double spacing = points.back().distance / static_cast<double>(points.size() - 1);
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (std::abs(points[i].distance - spacing * static_cast<double>(i)) > 1e-3 * spacing) {
      return false;
    }
  }
  return true;
}

}  // namespace

RadialProfile read_radial_profile(const std::filesystem::path& path) {
  const Points points = read_points(path);
  const double end = points.back().distance;
  RadialProfile profile{.path = path, .values = {}};
  if (are_even(points)) {
    for (const Point& point : points) profile.values.push_back(point.value);
  } else {
    for (int i = 0; i <= even_steps; ++i) {
      profile.values.push_back(curve_at(points, i * end / even_steps));
    }
  }
  profile.spacing = end / static_cast<double>(profile.values.size() - 1);
  return profile;
}

}  // namespace motes
