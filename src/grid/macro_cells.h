// Where a grid's field lies between what values: for skipping what shows nothing.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "grid/grid_sampler.h"

namespace motes {

/// Blocks of size^3 cells of a grid, and bounds of the field's values in each: those of the
/// coefficients that reach into the block, for their weights are positive and sum to one.
class MacroCells {
 public:
  static constexpr int size = 8;  ///< cells along each axis

  struct Range {
    float min, max;
  };

  /// On all threads.
  explicit MacroCells(const GridSampler& sampler);

  /// Blocks along each axis; the last may have fewer cells.
  const std::array<int, 3>& dims() const { return dims_; }
  /// Bounds of the field in block (i, j, k), its faces included: index coordinates from size * i to
  /// size * (i + 1), and so on. Wide enough for the hot path's rounding. Hot: unchecked.
  const Range& at(int i, int j, int k) const {
    const auto row = static_cast<std::size_t>(k) * static_cast<std::size_t>(dims_[1]) +
                     static_cast<std::size_t>(j);
    return ranges_[row * static_cast<std::size_t>(dims_[0]) + static_cast<std::size_t>(i)];
  }
  /// Of all blocks, those of a row along x one after the other.
  const std::vector<Range>& ranges() const { return ranges_; }
  std::size_t num_bytes() const { return ranges_.size() * sizeof(Range); }

 private:
  std::array<int, 3> dims_;
  std::vector<Range> ranges_;
};

}  // namespace motes
