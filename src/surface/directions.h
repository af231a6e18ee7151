// Directions of further rays: points of a low-discrepancy sequence, shared out among the pixels of
// a small pattern.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/vec.h"

namespace motes {

/// The pattern has 8 x 8 pixels, each with directions of its own: those of each are evenly spread,
/// and those of all together.
inline constexpr int pattern_side = 8;

/// Number of a pixel in the pattern, 0 to 63.
inline int pattern_number(int px, int py) {
  // Bits of x and y by turns: the directions of squares of four and sixteen pixels are evenly
  // spread too.
  int number = 0;
  for (int bit = 0; 1 << bit < pattern_side; ++bit) {
    number |= (px >> bit & 1) << 2 * bit | (py >> bit & 1) << (2 * bit + 1);
  }
  return number;
}

/// The rank (spots.h) of what ray i of a pixel of that number meets.
std::uint32_t rank_of(int number, int i);

/// The directions of a pixel of that number, of all that the functions below return.
inline std::span<const Vector3f> directions_of(std::span<const Vector3f> all, int number) {
  const std::size_t samples = all.size() / (std::size_t{pattern_side} * pattern_side);
  return all.subspan(static_cast<std::size_t>(number) * samples, samples);
}

/// Directions about +z whose density goes with the cosine of the angle to it: those of the pixel
/// with number 0, then those of the next, ...
std::vector<Vector3f> cosine_directions(int samples, std::uint32_t seed);

/// Directions evenly spread within an angle (radians) of `axis`, a unit vector.
std::vector<Vector3f> cone_directions(int samples, const Vector3d& axis, double angle,
                                      std::uint32_t seed);

/// Two unit vectors across a unit vector and each other.
struct Across {
  Vector3d x, y;
};
Across across(const Vector3d& axis);

}  // namespace motes
