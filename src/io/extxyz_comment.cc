// KEY=VALUE lists with quotes, and the values that say what the frame holds.
#include "io/extxyz_comment.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <map>

#include "core/error.h"
#include "io/text.h"

namespace motes {

namespace {

constexpr int max_columns = 1000;

std::string lower_case(std::string_view text) {
  std::string out(text);
  std::transform(out.begin(), out.end(), out.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return out;
}

/// The value at the front of `text`, which is cut off: a token, or what quotes or brackets enclose.
std::string take_value(std::string_view& text) {
  static constexpr std::string_view openings = "\"'{[", closings = "\"'}]";
  const std::size_t kind = text.empty() ? std::string_view::npos : openings.find(text.front());
  if (kind == std::string_view::npos) return std::string(next_token(text));
  text.remove_prefix(1);
  std::string value;
  while (!text.empty() && text.front() != closings[kind]) {
    if (text.front() == '\\' && text.size() > 1) text.remove_prefix(1);
    value += text.front();
    text.remove_prefix(1);
  }
  if (!text.empty()) text.remove_prefix(1);
  return value;
}

/// Values by lower-case key; bare keys have the value "T".
std::map<std::string, std::string> parse_keys(std::string_view line) {
  std::map<std::string, std::string> values;
  while (!(line = trim(line)).empty()) {
    const std::size_t size = std::min(line.find_first_of("= \t"), line.size());
    const std::string key = lower_case(line.substr(0, size));
    line.remove_prefix(size);
    const bool bare = !line.starts_with('=');
    if (!bare) line.remove_prefix(1);
    values[key] = bare ? std::string("T") : take_value(line);
  }
  return values;
}

/// The numbers of `value`, separated by blanks or commas; brackets do not matter.
std::vector<double> parse_numbers(std::string_view key, std::string value) {
  std::replace_if(
      value.begin(), value.end(), [](char c) { return c == ',' || c == '[' || c == ']'; }, ' ');
  std::vector<double> numbers;
  for (const std::string_view token : split_tokens(value)) {
    const auto number = to_real(token);
    if (!number) {
      throw Error(fmt::format("expected numbers for {}, found '{}'", key, printable(token)));
    }
    numbers.push_back(*number);
  }
  return numbers;
}

std::array<bool, 3> parse_pbc(std::string value) {
  std::replace_if(
      value.begin(), value.end(), [](char c) { return c == ',' || c == '[' || c == ']'; }, ' ');
  const auto tokens = split_tokens(value);
  std::array<bool, 3> periodic{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::string token = lower_case(tokens.size() == 3 ? tokens[axis] : std::string_view("?"));
    periodic[axis] = token == "t" || token == "true" || token == "1";
    if (!periodic[axis] && token != "f" && token != "false" && token != "0") {
      throw Error(fmt::format("expected three of T and F for pbc, found '{}'", printable(value)));
    }
  }
  return periodic;
}

std::vector<ExtxyzProperty> parse_properties(std::string_view value) {
  std::vector<std::string_view> parts;
  for (std::string_view rest = value; !rest.empty();) {
    const std::size_t size = std::min(rest.find(':'), rest.size());
    parts.push_back(rest.substr(0, size));
    rest.remove_prefix(std::min(size + 1, rest.size()));
  }
  const auto fail = [&] {
    throw Error(
        fmt::format("expected Properties=NAME:TYPE:COUNT:... with a TYPE of R, I, S or L, "
                    "found '{}'",
                    printable(value)));
  };
  if (parts.empty() || parts.size() % 3 != 0) fail();
  std::vector<ExtxyzProperty> properties;
  int num_columns = 0;
  for (std::size_t i = 0; i < parts.size(); i += 3) {
    const std::string_view type = parts[i + 1];
    const auto count = to_integer(parts[i + 2]);
    const bool good = !parts[i].empty() && type.size() == 1 &&
                      std::string_view("RISL").find(type[0]) != std::string_view::npos && count &&
                      *count >= 1 && *count <= max_columns - num_columns;
    if (!good) fail();
    num_columns += static_cast<int>(*count);
    properties.push_back({std::string(parts[i]), type[0], static_cast<int>(*count)});
  }
  return properties;
}

std::optional<Cell> parse_cell(const std::map<std::string, std::string>& values) {
  const auto lattice = values.find("lattice");
  if (lattice == values.end()) return std::nullopt;
  const auto v = parse_numbers("Lattice", lattice->second);
  Cell cell;
  if (v.size() == 9) {
    cell.vectors = {Vector3d{v[0], v[1], v[2]}, {v[3], v[4], v[5]}, {v[6], v[7], v[8]}};
  } else if (v.size() == 3) {
    cell.vectors = {Vector3d{v[0], 0, 0}, {0, v[1], 0}, {0, 0, v[2]}};
  } else {
    throw Error(fmt::format("expected 9 numbers for Lattice, found {}", v.size()));
  }
  if (!std::all_of(v.begin(), v.end(), [](double x) { return std::isfinite(x); })) {
    throw Error("expected finite numbers for Lattice");
  }
  if (const auto origin = values.find("origin"); origin != values.end()) {
    const auto o = parse_numbers("Origin", origin->second);
    if (o.size() != 3)
      throw Error(fmt::format("expected 3 numbers for Origin, found {}", o.size()));
    cell.origin = {o[0], o[1], o[2]};
  }
  if (const auto pbc = values.find("pbc"); pbc != values.end()) {
    cell.periodic = parse_pbc(pbc->second);
  }
  return cell;
}

}  // namespace

ExtxyzComment parse_extxyz_comment(std::string_view line) {
  const auto values = parse_keys(line);
  ExtxyzComment comment;
  comment.cell = parse_cell(values);
  if (const auto it = values.find("properties"); it != values.end() && it->second != "T") {
    comment.properties = parse_properties(it->second);
  }
  if (const auto it = values.find("time"); it != values.end()) comment.time = to_real(it->second);
  return comment;
}

}  // namespace motes
