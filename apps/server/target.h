// The target of an HTTP request: a path and what is asked of it.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>

namespace motes::server {

struct Target {
  std::string path;  ///< decoded
  std::map<std::string, std::string, std::less<>> query;

  /// "" where there is no such parameter.
  std::string_view parameter(std::string_view name) const;
};

/// "/path?name=value&name=value", with %XX decoded; of a parameter that is there twice the first
/// counts. nullopt for what is no such target.
std::optional<Target> parse_target(std::string_view text);

/// The number that is all of `text`, if it is one from `low` to `high`.
std::optional<int> parse_number(std::string_view text, int low, int high);

}  // namespace motes::server
