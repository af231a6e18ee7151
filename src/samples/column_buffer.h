// Samples of an area whose planes lie in the lanes: where kernels of a few pixels are summed.
// Layout only.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/aligned.h"
#include "samples/area_buffer.h"
#include "samples/samples.h"

namespace motes {

/// Samples of 64 x 64 pixels on the planes of an AreaBuffer: [row of pixels][column of
/// pixels][field][channel][plane].
class ColumnBuffer {
 public:
  static constexpr int planes = AreaBuffer::planes;
  static constexpr int size = AreaBuffer::size;

  /// Makes room for that layout; if it is the layout already, samples keep what they hold, else all
  /// are zero and untouched.
  void reserve(const SampleLayout& layout) {
    const std::size_t pixel_floats = layout.floats_per_sample() /
                                     static_cast<std::size_t>(layout.lanes) *
                                     static_cast<std::size_t>(planes);
    if (pixel_floats == pixel_floats_) return;
    pixel_floats_ = pixel_floats;
    values_.assign(size * row_floats(), 0.0f);
    touched_.fill(0);
  }

  std::size_t pixel_floats() const { return pixel_floats_; }
  // Two pixels of room to spare: rows whose distance is a power of two would share cache sets.
  std::size_t row_floats() const { return (size + 2) * pixel_floats_; }

  /// First float of a pixel. Hot: unchecked.
  float* at(int row, int column) {
    return values_.data() + static_cast<std::size_t>(row) * row_floats() +
           static_cast<std::size_t>(column) * pixel_floats_;
  }
  /// Groups of a row of groups in which some pixel may hold anything but zero, a bit each.
  GroupBits& touched(int row) { return touched_[static_cast<std::size_t>(row)]; }

 private:
  std::size_t pixel_floats_ = 0;
  AlignedVector<float> values_;
  std::array<GroupBits, AreaBuffer::groups> touched_{};
};

}  // namespace motes
