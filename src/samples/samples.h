// The contract between pass 1 (field/) and pass 2 (integrate/): which samples there are, and where
// the channels of each lie in the buffer. Layout only. Lengths are internal
// (KernelSet::length_scale).
#pragma once

#include <algorithm>
#include <bit>
#include <cassert>
#include <cstddef>
#include <cstdint>

#include "core/aligned.h"

namespace motes {

/// Number of a plane of samples; plane k lies at depth z_k = (k + 1/2) * step_size.
using SampleIndex = std::int64_t;

/// Planes first, first + 1, ..., first + count - 1.
struct Slab {
  SampleIndex first = 0;
  int count = 0;
  double depth(int k, double step) const { return (static_cast<double>(first + k) + 0.5) * step; }
};

/// Widest vector of floats of any instruction set.
inline constexpr int max_lanes = 16;

/// N rays done in lockstep, one a lane: a block of width x height pixels. In camera axes with the
/// eye at the origin, the sample of a lane at depth z is (origin_x + z direction_x, origin_y + z
/// direction_y, z). Perspective rays have origin 0, orthographic ones direction (0, 0, 1).
struct RayPacket {
  int lanes = 0;
  double origin_x[max_lanes], origin_y[max_lanes];
  double direction_x[max_lanes], direction_y[max_lanes];
  /// Samples of each lane inside the volume's box, both included; first > last: none.
  SampleIndex first[max_lanes], last[max_lanes];
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

/// The samples of a packet in a slab: [sample][field][channel][lane], all zero but where a particle
/// was added. `touched` has a bit for each sample to which something was added, so that clearing
/// and integrating pass over empty ones.
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

  /// Marks samples first to last, both included. Hot: unchecked.
  void touch(int first, int last) {
    for (int word = first / 64; word <= last / 64; ++word) {
      const int low = std::max(first - 64 * word, 0), high = std::min(last - 64 * word, 63);
      touched_[static_cast<std::size_t>(word)] |= (~std::uint64_t{0} >> (63 - (high - low))) << low;
    }
  }
  bool touched(int sample) const {
    return (touched_[static_cast<std::size_t>(sample) / 64] >> (sample % 64) & 1) != 0;
  }

  /// Sets what was touched back to zero.
  void clear() {
    for (std::size_t word = 0; word < touched_.size(); ++word) {
      for (std::uint64_t bits = touched_[word]; bits != 0; bits &= bits - 1) {
        const int sample = static_cast<int>(word) * 64 + std::countr_zero(bits);
        std::fill_n(at(sample, 0), layout_.floats_per_sample(), 0.0f);
      }
      touched_[word] = 0;
    }
  }

 private:
  SampleLayout layout_;
  AlignedVector<float> values_;
  AlignedVector<std::uint64_t> touched_;
};

}  // namespace motes
