// The contract between pass 1 (field/) and pass 2 (integrate/): which samples there are, and where
// the channels of each lie in the buffer. Layout only. Lengths are internal
// (KernelSet::length_scale).
#pragma once

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <span>

#include "core/aligned.h"

namespace motes {

/// Number of a plane of samples, counted from SamplePlanes::first.
using SampleIndex = int;

/// The planes on which a frame's samples lie, perpendicular to the view: plane k at depth
/// (first + k + 1/2) * step. `first` is where the volume begins, so that numbers stay small however
/// far away the eye is.
struct SamplePlanes {
  std::int64_t first = 0;
  double step = 0;  ///< internal length
  double depth(SampleIndex k) const { return (static_cast<double>(first + k) + 0.5) * step; }
};

/// Planes first, first + 1, ..., first + count - 1.
struct Slab {
  SampleIndex first = 0;
  int count = 0;
};

/// Pixels x to x + width - 1, y to y + height - 1.
struct Tile {
  int x = 0, y = 0, width = 0, height = 0;
};

/// Widest vector of floats of any instruction set.
inline constexpr int max_lanes = 16;

/// N rays done in lockstep, one a lane: a block of width x height pixels. In camera axes with the
/// eye at the origin, the sample of a lane at depth z is (origin_x + z direction_x, origin_y + z
/// direction_y, z). Perspective rays have origin 0, orthographic ones direction (0, 0, 1).
struct RayPacket {
  int lanes = 0;
  alignas(64) double origin_x[max_lanes], origin_y[max_lanes];
  alignas(64) double direction_x[max_lanes], direction_y[max_lanes];
};

/// The samples of rays at which a field is, both included, and what it has of the first and the
/// last one's step: from `enters` on and up to `leaves`, 0 to 1. One float a lane; first > last:
/// none.
struct FieldRange {
  alignas(64) float first[max_lanes], last[max_lanes];
  alignas(64) float enters[max_lanes], leaves[max_lanes];
};

/// How far the rays of a packet have come: what pass 2 reads and changes, one float a lane.
struct RayState {
  /// Samples inside the volume, both included; first > last: none. A ray that ends early has its
  /// last sample moved up. Whole numbers, exact in float: a frame has at most 1e7 planes.
  alignas(64) float first[max_lanes], last[max_lanes];
  SampleIndex begin = 0, end = -1;  ///< of all lanes; begin > end: none
  /// What clip planes leave of the first and the last sample's step: from `enters` on and up to
  /// `leaves`, 0 to 1. Set, and looked at, only where there are such planes.
  alignas(64) float enters[max_lanes], leaves[max_lanes];
  /// One a field; null: all of them are at all samples.
  const FieldRange* fields = nullptr;
  alignas(64) float length[max_lanes];          ///< of the direction
  alignas(64) float half_to_eye[3][max_lanes];  ///< half of the unit vector to the eye
  alignas(64) float r[max_lanes], g[max_lanes], b[max_lanes], a[max_lanes];
};

/// Channels of a field at a sample: its value; with `gradients` its gradient in camera axes; with
/// `absolute` also the sum of |phi_i|, needed where weights of both signs cancel.
struct SampleLayout {
  int num_fields = 1;
  bool gradients = false;
  bool absolute = false;
  int lanes = max_lanes;

  int channels() const { return 1 + (gradients ? 3 : 0) + (absolute ? 1 : 0); }
  int absolute_channel() const { return gradients ? 4 : 1; }
  std::size_t floats_per_sample() const {
    return static_cast<std::size_t>(num_fields) * static_cast<std::size_t>(channels()) *
           static_cast<std::size_t>(lanes);
  }
};

/// Values of a field at which something may be seen: those above `above`, but for `hidden`.
struct Visibility {
  float above;   ///< -infinity: all
  float hidden;  ///< 0 or, if zero shows something, infinity
  bool shows_zero() const { return 0 > above && hidden != 0; }
};

/// Samples of a packet, one after the other: [sample][field][channel][lane].
class SampleBuffer {
 public:
  SampleBuffer(const SampleLayout& layout, int num_samples)
      : layout_(layout),
        values_(layout.floats_per_sample() * static_cast<std::size_t>(num_samples), 0.0f),
        touched_((static_cast<std::size_t>(num_samples) + 63) / 64, 0) {}

  const SampleLayout& layout() const { return layout_; }
  int capacity() const { return static_cast<int>(values_.size() / layout_.floats_per_sample()); }

  /// Grows the buffer to `num_samples`; what it held is cleared.
  void reserve(int num_samples) {
    if (num_samples > capacity()) *this = SampleBuffer(layout_, num_samples);
  }

  /// First lane of channel 0. Hot: unchecked.
  float* at(int sample, int field) {
    return values_.data() + static_cast<std::size_t>(sample) * layout_.floats_per_sample() +
           static_cast<std::size_t>(field) * static_cast<std::size_t>(layout_.channels()) *
               static_cast<std::size_t>(layout_.lanes);
  }

  /// Marks samples first to last, both included, to be cleared. Hot: unchecked.
  void touch(int first, int last) {
    for (int word = first / 64; word <= last / 64; ++word) {
      const int low = std::max(first - 64 * word, 0), high = std::min(last - 64 * word, 63);
      touched_[static_cast<std::size_t>(word)] |= (~std::uint64_t{0} >> (63 - (high - low))) << low;
    }
  }

  /// A bit for each sample: 64 word + i.
  std::span<std::uint64_t> touched_words() { return touched_; }

 private:
  SampleLayout layout_;
  AlignedVector<float> values_;
  AlignedVector<std::uint64_t> touched_;
};

}  // namespace motes
