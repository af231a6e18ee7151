// Decoding targets.
#include "server/target.h"

#include <charconv>

namespace motes::server {
namespace {

/// nullopt where a % stands without two hexadecimal digits.
std::optional<std::string> decode(std::string_view text) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '%') {
      out += text[i];
      continue;
    }
    unsigned value = 0;
    const std::string_view digits = text.substr(i + 1, 2);
    const auto [end, error] =
        std::from_chars(digits.data(), digits.data() + digits.size(), value, 16);
    if (digits.size() != 2 || error != std::errc() || end != digits.data() + 2) return {};
    out += static_cast<char>(value);
    i += 2;
  }
  return out;
}

}  // namespace

std::string_view Target::parameter(std::string_view name) const {
  const auto found = query.find(name);
  return found == query.end() ? std::string_view() : std::string_view(found->second);
}

std::optional<Target> parse_target(std::string_view text) {
  const auto mark = text.find('?');
  const auto path = decode(text.substr(0, mark));
  if (!path || !path->starts_with('/')) return {};
  Target target{*path, {}};
  std::string_view rest = mark == text.npos ? std::string_view() : text.substr(mark + 1);
  while (!rest.empty()) {
    const std::string_view pair = rest.substr(0, rest.find('&'));
    rest.remove_prefix(std::min(pair.size() + 1, rest.size()));
    const auto equals = pair.find('=');
    const auto name = decode(pair.substr(0, equals));
    const auto value = decode(equals == pair.npos ? std::string_view() : pair.substr(equals + 1));
    if (!name || !value) return {};
    target.query.emplace(*name, *value);
  }
  return target;
}

std::optional<int> parse_number(std::string_view text, int low, int high) {
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return {};
  return value >= low && value <= high ? std::optional(value) : std::nullopt;
}

}  // namespace motes::server
