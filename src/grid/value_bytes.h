// The values of a grid as they are in memory.
#pragma once

#include <bit>
#include <cassert>
#include <string_view>

#include "particles/grid.h"

namespace motes {

inline constexpr bool is_little_endian = std::endian::native == std::endian::little;

inline std::string_view value_bytes(const Grid& grid) {
  assert(grid.size() > 0 && grid.values.size() == grid.size());
  return {reinterpret_cast<const char*>(grid.values.data()), grid.values.size() * sizeof(float)};
}

}  // namespace motes
