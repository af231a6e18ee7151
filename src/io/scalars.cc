// One loop for each type.
#include "io/scalars.h"

#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <bit>
#include <cassert>
#include <cmath>

#include "core/error.h"
#include "io/bytes.h"

namespace motes {

namespace {

/// Calls f with a value of the type itself.
template <class F>
auto with_type(ScalarType type, F&& f) {
  switch (type) {
    case ScalarType::int8:
      return f(std::int8_t{});
    case ScalarType::uint8:
      return f(std::uint8_t{});
    case ScalarType::int16:
      return f(std::int16_t{});
    case ScalarType::uint16:
      return f(std::uint16_t{});
    case ScalarType::int32:
      return f(std::int32_t{});
    case ScalarType::uint32:
      return f(std::uint32_t{});
    case ScalarType::int64:
      return f(std::int64_t{});
    case ScalarType::uint64:
      return f(std::uint64_t{});
    case ScalarType::float32:
      return f(float{});
    case ScalarType::float64:
      break;
  }
  return f(double{});
}

template <class T>
bool real_numbers_look_swapped(std::string_view bytes, bool swap) {
  constexpr std::size_t looked_at = 4096;
  const std::size_t count = bytes.size() / sizeof(T);
  std::size_t num = 0, usual = 0, usual_swapped = 0, useless = 0;
  const auto between = [](T value, double low, double high) {
    return std::abs(value) >= low && std::abs(value) <= high;
  };
  for (std::size_t i = 0; i < count; i += 1 + count / looked_at) {
    const T value = load_scalar<T>(bytes.data() + i * sizeof(T), swap);
    if (value == 0) continue;
    const T swapped = load_scalar<T>(bytes.data() + i * sizeof(T), !swap);
    ++num;
    usual += between(value, 1e-12, 1e12);
    usual_swapped += between(swapped, 1e-12, 1e12);
    useless += !between(value, 1e-36, 1e36);
  }
  // (in the other order few of numbers that make sense are usual: exponents are then any)
  return useless > 0 && 20 * usual < 19 * num && 20 * usual_swapped > 19 * num;
}

}  // namespace

bool looks_swapped(std::string_view bytes, ScalarType type, bool big_endian) {
  const bool swap = big_endian != (std::endian::native == std::endian::big);
  if (type == ScalarType::float32) return real_numbers_look_swapped<float>(bytes, swap);
  if (type == ScalarType::float64) return real_numbers_look_swapped<double>(bytes, swap);
  return false;
}

std::size_t size_of(ScalarType type) {
  return with_type(type, [](auto value) { return sizeof(value); });
}

void convert_scalars(std::string_view bytes, ScalarType type, bool big_endian,
                     std::span<float> out) {
  assert(bytes.size() == size_of(type) * out.size());
  const bool swap = big_endian != (std::endian::native == std::endian::big);
  with_type(type, [&]<class T>(T) {
    constexpr std::size_t grain = std::size_t{1} << 16;
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, out.size(), grain), [&](const auto& part) {
      for (std::size_t i = part.begin(); i != part.end(); ++i) {
        out[i] = static_cast<float>(load_scalar<T>(bytes.data() + i * sizeof(T), swap));
      }
    });
  });
}

std::uint64_t count_samples(const std::filesystem::path& file,
                            const std::array<std::size_t, 3>& dims, std::size_t num_grids) {
  const std::uint64_t most_bytes = half_of_memory();
  // In floating point, so that no product can overflow.
  double bytes = sizeof(float) * static_cast<double>(num_grids);
  for (const std::size_t n : dims) bytes *= static_cast<double>(n);
  if (bytes > static_cast<double>(most_bytes)) {
    throw Error(file,
                too_large(fmt::format("samples, {} x {} x {} of them,", dims[0], dims[1], dims[2]),
                          most_bytes));
  }
  return dims[0] * dims[1] * dims[2];
}

}  // namespace motes
