// Value of a field -> colour and extinction.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/color.h"

namespace motes {

/// Piecewise linear in the field's value, or in its base-10 logarithm where `log_scale`; clamped at
/// its ends. With log_scale a value of zero or less takes the first point's colour and extinction.
struct TransferFunction {
  struct Point {
    double value = 0;  ///< field's unit, strictly increasing; not a logarithm, also with log_scale
    Color color;       ///< linear
    double extinction = 0;  ///< per unit length, >= 0
    bool operator==(const Point&) const = default;
  };
  std::vector<Point> points;  ///< at least one
  bool log_scale = false;

  bool operator==(const TransferFunction&) const = default;
};

/// What the function has at a value of the field; not a number: the first point.
TransferFunction::Point point_at(const TransferFunction& function, double value);
/// Its colour.
Color color_at(const TransferFunction& function, double value);

/// Names of the built-in colour maps: viridis, magma, inferno, plasma, heat, grey.
const std::vector<std::string>& color_map_names();

/// 0xrrggbb, sRGB-encoded, as a linear colour.
Color color_from_srgb(std::uint32_t rrggbb);

/// The nearest 0xrrggbb; channels are clamped to [0, 1].
std::uint32_t color_to_srgb(const Color& color);

/// "#rrggbb", "black" or "white" as a linear colour; nullopt for any other text.
std::optional<Color> color_from_text(std::string_view text);

/// A built-in colour map over [low, high], extinction rising linearly from 0 to `extinction`.
/// Throws Error for an unknown name (naming the nearest) or a range that is empty, or not positive
/// with log_scale.
TransferFunction named_transfer_function(std::string_view name, double low, double high,
                                         double extinction, bool log_scale = false);

}  // namespace motes
