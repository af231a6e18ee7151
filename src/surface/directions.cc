#include "surface/directions.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace motes {
namespace {

std::uint32_t reverse_bits(std::uint32_t x) {
  x = x << 16 | x >> 16;
  x = (x & 0x00ff00ff) << 8 | (x & 0xff00ff00) >> 8;
  x = (x & 0x0f0f0f0f) << 4 | (x & 0xf0f0f0f0) >> 4;
  x = (x & 0x33333333) << 2 | (x & 0xcccccccc) >> 2;
  return (x & 0x55555555) << 1 | (x & 0xaaaaaaaa) >> 1;
}

/// Owen's scrambling by hashing (Burley 2020, "Practical Hash-based Owen Scrambling", JCGT 9).
std::uint32_t scrambled(std::uint32_t x, std::uint32_t seed) {
  x = reverse_bits(x);
  x += seed;
  x ^= x * 0x6c50b47cu;
  x ^= x * 0xb82f1e52u;
  x ^= x * 0xc7afe638u;
  x ^= x * 0x8d22f6e6u;
  return reverse_bits(x);
}

/// A number that has nothing to do with those of other seeds and other k.
std::uint32_t hashed(std::uint32_t seed, std::uint32_t k) {
  std::uint32_t x = seed * 0x9e3779b9u + k * 0x85ebca6bu + 0x165667b1u;
  x = (x ^ x >> 16) * 0x21f0aaadu;
  x = (x ^ x >> 15) * 0xd35a2d97u;
  return x ^ x >> 15;
}

/// Point i of Sobol's sequence in the unit square, scrambled: each 2^k points that begin at a
/// multiple of 2^k are evenly spread.
std::array<double, 2> sobol_point(std::uint32_t i, std::uint32_t seed) {
  std::uint32_t second = 0;
  std::uint32_t column = 0x80000000u;
  for (std::uint32_t bits = i; bits != 0; bits >>= 1) {
    if ((bits & 1) != 0) second ^= column;
    column ^= column >> 1;
  }
  const auto unit = [](std::uint32_t x) { return (x + 0.5) * 0x1p-32; };
  return {unit(scrambled(reverse_bits(i), hashed(seed, 0))),
          unit(scrambled(second, hashed(seed, 1)))};
}

/// direction(point) for the points of all pixels.
template <class Direction>
std::vector<Vector3f> directions(int samples, std::uint32_t seed, const Direction& direction) {
  const int count = pattern_side * pattern_side * samples;
  std::vector<Vector3f> all;
  for (int i = 0; i < count; ++i) {
    const auto [u, v] = sobol_point(static_cast<std::uint32_t>(i), seed);
    const double angle = 2 * std::numbers::pi * v;
    all.emplace_back(direction(u, std::cos(angle), std::sin(angle)));
  }
  return all;
}

}  // namespace

std::uint32_t rank_of(int number, int i) {
  return hashed(static_cast<std::uint32_t>(number), static_cast<std::uint32_t>(i));
}

std::vector<Vector3f> cosine_directions(int samples, std::uint32_t seed) {
  return directions(samples, hashed(seed, 2), [](double u, double cosine, double sine) {
    const double across = std::sqrt(u);
    return Vector3d{across * cosine, across * sine, std::sqrt(1 - u)};
  });
}

std::vector<Vector3f> cone_directions(int samples, const Vector3d& axis, double angle,
                                      std::uint32_t seed) {
  const Across sides = across(axis);
  const double depth = 1 - std::cos(angle);
  return directions(samples, hashed(seed, 3), [&](double u, double cosine, double sine) {
    const double along = 1 - u * depth;
    const double off = std::sqrt(std::max(1 - along * along, 0.0));
    return along * axis + off * cosine * sides.x + off * sine * sides.y;
  });
}

Across across(const Vector3d& axis) {
  // Duff et al. 2017, "Building an Orthonormal Basis, Revisited", JCGT 6.
  const double sign = std::copysign(1.0, axis.z);
  const double a = -1 / (sign + axis.z), b = axis.x * axis.y * a;
  return {{1 + sign * axis.x * axis.x * a, sign * b, -sign * axis.x},
          {b, sign + axis.y * axis.y * a, -axis.y}};
}

}  // namespace motes
