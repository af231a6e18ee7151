#include "motes/option_values.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <charconv>
#include <cstddef>

#include "core/error.h"

namespace motes {

void bad_value(std::string_view option, std::string_view expected, std::string_view found) {
  throw CLI::ValidationError(
      fmt::format("{}: expected {}, found '{}'", option, expected, printable(found)),
      CLI::ExitCodes::ValidationError);
}

std::optional<double> number_in(std::string_view text) {
  if (text.starts_with('+')) text.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

std::optional<std::array<double, 3>> triple_in(std::string_view text) {
  std::array<double, 3> values{};
  for (std::size_t k = 0; k < 3; ++k) {
    const auto comma = text.find(',');
    if ((comma == std::string_view::npos) != (k == 2)) return std::nullopt;
    const auto value = number_in(text.substr(0, comma));
    if (!value || !std::isfinite(*value)) return std::nullopt;
    values[k] = *value;
    text.remove_prefix(k == 2 ? text.size() : comma + 1);
  }
  return values;
}

std::optional<Vector3d> direction_in(std::string_view text) {
  const auto values = triple_in(text);
  if (!values) return std::nullopt;
  const Vector3d v{(*values)[0], (*values)[1], (*values)[2]};
  return length(v) > 0 ? std::optional(v) : std::nullopt;
}

}  // namespace motes
