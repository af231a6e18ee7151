// Reads points for motes probe.
#include "motes/points.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <fstream>
#include <iostream>
#include <optional>
#include <string_view>

#include "core/error.h"

namespace motes {
namespace {

/// The values of a line. Commas, semicolons and tabs separate, blanks do where there are none of
/// these.
std::vector<std::string_view> split(std::string_view line) {
  const bool delimited = line.find_first_of(",;\t") != std::string_view::npos;
  const std::string_view separators = delimited ? ",;\t" : " ";
  std::vector<std::string_view> values;
  while (true) {
    const auto end = line.find_first_of(separators);
    std::string_view value = line.substr(0, end);
    const auto first = value.find_first_not_of(" \"\r");
    value = first == std::string_view::npos
                ? std::string_view{}
                : value.substr(first, value.find_last_not_of(" \"\r") + 1 - first);
    if (delimited || !value.empty()) values.push_back(value);
    if (end == std::string_view::npos) return values;
    line.remove_prefix(end + 1);
  }
}

std::optional<double> number_in(std::string_view text) {
  if (text.starts_with('+')) text.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (text.empty() || error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

/// Where x, y and z stand according to a line of names.
std::array<std::size_t, 3> find_columns(const std::vector<std::string_view>& names,
                                        const std::string& path, std::size_t line) {
  std::array<std::size_t, 3> columns{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const char lower = "xyz"[axis], upper = "XYZ"[axis];
    const auto it = std::find_if(names.begin(), names.end(), [&](std::string_view name) {
      return name.size() == 1 && (name[0] == lower || name[0] == upper);
    });
    if (it == names.end()) {
      throw Error(path, line, "expected numbers, or names of columns with x, y and z");
    }
    columns[axis] = static_cast<std::size_t>(it - names.begin());
  }
  return columns;
}

std::vector<Point3d> parse_points(std::istream& stream, const std::string& path) {
  std::vector<Point3d> points;
  std::optional<std::array<std::size_t, 3>> columns;
  std::string line;
  for (std::size_t number = 1; std::getline(stream, line); ++number) {
    if (number == 1 && line.starts_with("\xef\xbb\xbf")) line.erase(0, 3);
    const auto first = line.find_first_not_of(" \t\r");
    if (first == std::string::npos || line[first] == '#') continue;
    const auto values = split(line);
    if (!columns) {
      const bool names = std::none_of(values.begin(), values.end(),
                                      [](std::string_view v) { return number_in(v).has_value(); });
      columns = names ? find_columns(values, path, number) : std::array<std::size_t, 3>{0, 1, 2};
      if (names) continue;
    }
    Point3d point;
    for (int axis = 0; axis < 3; ++axis) {
      const std::size_t column = (*columns)[static_cast<std::size_t>(axis)];
      const auto value = column < values.size() ? number_in(values[column]) : std::nullopt;
      if (!value) {
        throw Error(
            path, number,
            fmt::format("expected a number for {} in column {}, found '{}'", "xyz"[axis],
                        column + 1, column < values.size() ? printable(values[column]) : ""));
      }
      point[axis] = *value;
    }
    points.push_back(point);
  }
  if (stream.bad()) throw Error(path, "cannot be read");
  if (points.empty()) throw Error(path, "has no points; expected lines of x,y,z");
  return points;
}

}  // namespace

std::vector<Point3d> read_points(const std::string& path) {
  if (path == "-") return parse_points(std::cin, "standard input");
  std::ifstream stream(path);
  if (!stream) throw Error(path, "cannot be opened");
  return parse_points(stream, path);
}

}  // namespace motes
