// Sums over a histogram whose bins are as narrow, relatively, as the level has to be exact.
#include "scene/fit_levels.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace motes {
namespace {

constexpr double enclosed = 0.85;
constexpr double least_share = 0.01;  // of a sign
constexpr float high_ground = 0.1F;   // of the largest magnitude

/// Bins of floats of 0 or more by their exponent and first bits: 1/256 of their value wide.
constexpr int dropped_bits = 15;
constexpr std::size_t num_bins = std::size_t{1} << (31 - dropped_bits);

std::size_t bin_of(float magnitude) {
  return std::bit_cast<std::uint32_t>(std::abs(magnitude)) >> dropped_bits;  // (of -0 too)
}
double begin_of(std::size_t bin) {
  return std::bit_cast<float>(static_cast<std::uint32_t>(bin) << dropped_bits);
}

/// Calls use(magnitude) for the finite values; 0 for those of a sign that does not count.
template <class F>
void for_magnitudes(std::span<const float> values, Signs signs, F&& use) {
  for (const float value : values) {
    if (!std::isfinite(value)) continue;
    use(signs == Signs::both       ? std::abs(value)
        : signs == Signs::positive ? std::max(value, 0.0F)
                                   : std::max(-value, 0.0F));
  }
}

}  // namespace

Signs signs_of(std::span<const float> values) {
  double positive = 0, negative = 0;
  for (const float value : values) {
    if (!std::isfinite(value)) continue;
    (value > 0 ? positive : negative) += std::abs(double{value});
  }
  if (std::min(positive, negative) >= least_share * (positive + negative) && negative > 0) {
    return Signs::both;
  }
  return negative > positive ? Signs::negative : Signs::positive;
}

double enclosing_level(std::span<const float> values, Signs signs) {
  const bool both = signs == Signs::both;
  std::optional<float> lowest;
  float highest = 0;
  for_magnitudes(values, signs, [&](float magnitude) {
    lowest = std::min(lowest.value_or(magnitude), magnitude);
    highest = std::max(highest, magnitude);
  });
  const float ground = lowest.value_or(0);
  const float base = !both && ground >= high_ground * highest ? ground : 0;

  std::vector<double> sums(num_bins);
  double sum = 0;
  for_magnitudes(values, signs, [&](float magnitude) {
    const float above = magnitude - base;
    const double part = both ? double{above} * above : above;
    sums[bin_of(above)] += part;
    sum += part;
  });
  if (!(sum > 0)) return base;

  std::size_t bin = num_bins;
  double beyond = 0;  // of the sum
  while (beyond < enclosed * sum && bin > 0) beyond += sums[--bin];
  std::size_t below = bin;
  while (below > 0 && sums[--below] == 0) {
  }
  const double begin = begin_of(bin), end = begin_of(bin + 1);
  const bool gap = below + 1 < bin;
  if (gap) return base + 0.5 * (begin + begin_of(below + 1));
  return base + begin + (beyond - enclosed * sum) / sums[bin] * (end - begin);
}

}  // namespace motes
