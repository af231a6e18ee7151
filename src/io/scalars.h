// Numbers of any type and byte order in a binary file -> floats: what formats of grids share.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <span>
#include <string_view>

namespace motes {

/// One number of a binary file; `swap`: its byte order is not the machine's.
template <class T>
T load_scalar(const char* bytes, bool swap) {
  std::array<char, sizeof(T)> raw;
  std::memcpy(raw.data(), bytes, sizeof(T));
  if (swap) std::reverse(raw.begin(), raw.end());
  return std::bit_cast<T>(raw);
}

enum class ScalarType {
  int8,
  uint8,
  int16,
  uint16,
  int32,
  uint32,
  int64,
  uint64,
  float32,
  float64
};

/// Bytes of one number.
std::size_t size_of(ScalarType type);

/// The numbers in `bytes`, size_of(type) * out.size() of them, each as the nearest float. On all
/// threads.
void convert_scalars(std::string_view bytes, ScalarType type, bool big_endian,
                     std::span<float> out);

/// Whether the numbers in `bytes` make no sense in this byte order and all do in the other: real
/// numbers of which more than a few are not finite or far from 1, some beyond all use, while in the
/// other order they lie between 1e-12 and 1e12 but for a few. Looks at some of many, leaves
/// out what is 0 either way, and says nothing of whole numbers, of which all make sense.
bool looks_swapped(std::string_view bytes, ScalarType type, bool big_endian);

/// Samples of a grid with `dims` along its axes. Throws Error if those of `num_grids` of them are
/// more than half of the machine's memory holds as floats, so that products of counts that a file
/// claims never overflow.
std::uint64_t count_samples(const std::filesystem::path& file,
                            const std::array<std::size_t, 3>& dims, std::size_t num_grids = 1);

}  // namespace motes
