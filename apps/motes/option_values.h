// What the texts of options say.
#pragma once

#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string_view>

#include "core/vec.h"

namespace motes {

/// Throws the error of a wrong command line: what was expected, and what was found.
[[noreturn]] void bad_value(std::string_view option, std::string_view expected,
                            std::string_view found);

/// The number that `text` is; it may be infinite or NaN.
std::optional<double> number_in(std::string_view text);

/// The three finite numbers that `text` is, with commas between them.
std::optional<std::array<double, 3>> triple_in(std::string_view text);

/// The same, if it is not zero.
std::optional<Vector3d> direction_in(std::string_view text);

/// Finite numbers from `above`, which is not one of them, up to another.
struct NumberRange {
  double above;
  double up_to = std::numeric_limits<double>::infinity();
  bool end_included = true;
  std::string_view expected;

  bool contains(double v) const {
    return std::isfinite(v) && v > above && (end_included ? v <= up_to : v < up_to);
  }
};

}  // namespace motes
