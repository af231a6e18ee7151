// Blocks in rows, rows on all threads.
#include "grid/macro_cells.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace motes {

namespace {

/// Taps first to last, both included, of those from -1 on, that reach into cells [begin, end).
struct TapRange {
  int first, last;
};

TapRange taps_of(int begin, int end, bool cubic) {
  return cubic ? TapRange{begin, end + 2} : TapRange{begin + 1, end + 1};
}

/// Of the coefficients that reach into a block of cells.
MacroCells::Range find_range(const GridView& view, const std::array<int, 3>& block) {
  std::array<TapRange, 3> taps{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const int begin = block[axis] * MacroCells::size;
    taps[axis] =
        taps_of(begin, std::min(begin + MacroCells::size, view.num_cells[axis]), view.cubic);
  }
  const auto& [tx, ty, tz] = taps;
  float low = std::numeric_limits<float>::infinity(), high = -low;
  for (int k = tz.first; k <= tz.last; ++k) {
    for (int j = ty.first; j <= ty.last; ++j) {
      const float* const row = view.first + static_cast<std::size_t>(k) * view.plane +
                               static_cast<std::size_t>(j) * view.row;
      for (int i = tx.first; i <= tx.last; ++i) {
        low = std::min(low, row[i]);
        high = std::max(high, row[i]);
      }
    }
  }
  // The hot path's weights and sums: some 20 roundings of 2^-24.
  const float rounding = 2e-6F * std::max(std::abs(low), std::abs(high));
  return {low - rounding, high + rounding};
}

}  // namespace

MacroCells::MacroCells(const GridSampler& sampler) : dims_{} {
  const GridView view = sampler.view();
  std::size_t count = 1;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    dims_[axis] = (view.num_cells[axis] + size - 1) / size;
    count *= static_cast<std::size_t>(dims_[axis]);
  }
  ranges_.resize(count);
  const auto row_length = static_cast<std::size_t>(dims_[0]);
  tbb::parallel_for(std::size_t{0}, count / row_length, [&](std::size_t row) {
    const int j = static_cast<int>(row) % dims_[1], k = static_cast<int>(row) / dims_[1];
    for (int i = 0; i < dims_[0]; ++i) {
      ranges_[row * row_length + static_cast<std::size_t>(i)] = find_range(view, {i, j, k});
    }
  });
}

}  // namespace motes
