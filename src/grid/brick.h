// A part of a lattice that one thread fills at a time.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

#include "core/aligned.h"
#include "core/vec.h"

namespace motes {

/// Samples `first` to `first` + `size` - 1 along each axis, and what it takes to place kernels
/// among them. Lengths are internal, as in KernelSet.
struct Brick {
  static constexpr int max_side = 32;

  std::array<std::size_t, 3> first{};
  std::array<int, 3> size{};  ///< 1 to max_side
  Point3d origin;             ///< of its first sample
  Vector3d step, inverse_step;
  Bounds3f box;  ///< around its samples, rounded outwards
};

/// One field's samples in a brick: groups of 4 x 4 samples of a plane, rows one after the other,
/// and of each group all planes.
class BrickSamples {
 public:
  static constexpr int group_size = 4;
  static constexpr int group_samples = group_size * group_size;
  static constexpr int groups = Brick::max_side / group_size;  ///< along x and y

  BrickSamples() : values_(groups * groups * group_floats) {}

  /// Plane 0 of a group.
  float* at(int column, int row) {
    return values_.data() + static_cast<std::size_t>(row * groups + column) * group_floats;
  }
  /// All that `brick` has.
  void clear(const Brick& brick) {
    for (int row = 0; row * group_size < brick.size[1]; ++row) {
      for (int column = 0; column * group_size < brick.size[0]; ++column) {
        std::fill_n(at(column, row), brick.size[2] * group_samples, 0.0f);
      }
    }
  }

 private:
  /// (an odd number of cache lines, so that groups do not share sets of the cache)
  static constexpr std::size_t group_floats = (Brick::max_side + 1) * group_samples;
  AlignedVector<float> values_;
};

}  // namespace motes
