// Colours in linear light, and the sRGB encoding (IEC 61966-2-1) between them and what screens
// take.
#pragma once

#include <cmath>

namespace motes {

/// Linear RGB; [0, 1] is what a screen shows, more is allowed.
struct Color {
  float r = 0, g = 0, b = 0;
  bool operator==(const Color&) const = default;
};

/// One sRGB-encoded channel in [0, 1] -> linear light in [0, 1].
inline double srgb_to_linear(double encoded) {
  return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

/// The inverse of srgb_to_linear; not clamped.
inline double linear_to_srgb(double linear) {
  return linear <= 0.0031308 ? linear * 12.92 : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
}

}  // namespace motes
