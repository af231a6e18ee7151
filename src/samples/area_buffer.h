// The samples of an area of pixels on some planes: the contract between the sweep and pass 2.
// Layout only.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/aligned.h"
#include "samples/samples.h"

namespace motes {

/// Samples of 64 x 64 pixels: [row of groups][column of
/// groups][plane][block][field][channel][lane]. A group is 4 x 4 pixels; a block is one vector of
/// them, rows of a group one after the other.
class AreaBuffer {
 public:
  static constexpr int group_size = 4;
  static constexpr int groups = 16;                 ///< of a row and of a column of the area
  static constexpr int size = groups * group_size;  ///< pixels of a side
  static constexpr int group_pixels = group_size * group_size;
  static constexpr int planes = 8;  ///< sampled before they are integrated: a batch

  /// Planes of a group, a bit each.
  using PlaneBits = std::uint32_t;

  /// Makes room for that layout. Samples keep what they hold if that is the layout already; else
  /// all are zero and untouched.
  void reserve(const SampleLayout& layout) {
    const std::size_t block_floats = layout.floats_per_sample();
    const auto num_fields = static_cast<std::size_t>(layout.num_fields);
    if (block_floats == block_floats_ && num_fields == num_fields_ && layout.lanes == lanes_) {
      return;
    }
    lanes_ = layout.lanes;
    block_floats_ = block_floats;
    plane_floats_ = block_floats * static_cast<std::size_t>(group_pixels / lanes_);
    // A plane of room to spare: groups whose distance is a power of two would share cache sets.
    group_floats_ = plane_floats_ * std::size_t{planes + 1};
    num_fields_ = num_fields;
    values_.assign(groups * row_floats(), 0.0f);
    touched_.assign(groups * groups * num_fields_, 0);
  }

  std::size_t block_floats() const { return block_floats_; }
  std::size_t plane_floats() const { return plane_floats_; }  ///< of a group
  std::size_t group_floats() const { return group_floats_; }
  // Two planes of room to spare, for the same reason.
  std::size_t row_floats() const { return groups * group_floats_ + 2 * plane_floats_; }

  /// First float of a group on plane 0. Hot: unchecked.
  float* at(int row, int column) {
    return values_.data() + static_cast<std::size_t>(row) * row_floats() +
           static_cast<std::size_t>(column) * group_floats_;
  }
  /// Planes on which a group may hold anything but zero, an element a field; those of the next
  /// group of the row follow.
  PlaneBits* touched(int row, int column) {
    return touched_.data() + static_cast<std::size_t>(row * groups + column) * num_fields_;
  }
  std::size_t num_fields() const { return num_fields_; }

 private:
  int lanes_ = 0;
  std::size_t num_fields_ = 0;
  std::size_t block_floats_ = 0, plane_floats_ = 0, group_floats_ = 0;
  AlignedVector<float> values_;
  std::vector<PlaneBits> touched_;
};

/// Groups of a row of an area, a bit each.
using GroupBits = std::uint32_t;

}  // namespace motes
