// Random numbers by index: the same for any number of threads and with any standard library.
#pragma once

#include <cstdint>

namespace motes {

class Random {
 public:
  explicit Random(std::uint64_t seed) : seed_(seed) {}

  /// 64 random bits for each index (SplitMix64, Steele et al. 2014).
  std::uint64_t bits(std::uint64_t index) const {
    std::uint64_t z = (seed_ << 48U) + (index + 1) * 0x9e3779b97f4a7c15U;
    z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9U;
    z = (z ^ (z >> 27U)) * 0x94d049bb133111ebU;
    return z ^ (z >> 31U);
  }
  /// In [0, 1).
  double uniform(std::uint64_t index) const {
    return static_cast<double>(bits(index) >> 11U) * 0x1p-53;
  }
  double uniform(std::uint64_t index, double low, double high) const {
    return low + (high - low) * uniform(index);
  }
  /// Nearly normal, mean 0 and variance 1, within +-3.47: the sum of four uniform numbers of 16
  /// bits (there is no tail to throw an atom out of its place).
  double normal(std::uint64_t index) const {
    const std::uint64_t b = bits(index);
    const auto sum = static_cast<double>((b & 0xffffU) + (b >> 16U & 0xffffU) +
                                         (b >> 32U & 0xffffU) + (b >> 48U));
    constexpr double mean = 2 * 65535.0, deviation = 65536 / 1.7320508075688772;
    return (sum - mean) / deviation;
  }

 private:
  std::uint64_t seed_;
};

}  // namespace motes
