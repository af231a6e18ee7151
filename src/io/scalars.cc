// One loop for each type.
#include "io/scalars.h"

#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <bit>
#include <cassert>

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

}  // namespace

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
