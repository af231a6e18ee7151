// One float a kernel, or one for all of them.
#pragma once

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <span>

#include "bvh/bvh.h"
#include "core/aligned.h"

namespace motes {

/// Values of kernels in leaf order. Where all have the same one, a single leaf of it stands for
/// every leaf: it is read like an array, with no branch, and takes no memory to speak of.
class PerKernel {
 public:
  /// One value for all kernels.
  void share(float value) {
    values_ = UninitializedVector<float>(Bvh::leaf_size, value);
    mask_ = Bvh::leaf_size - 1;
  }
  /// An array for `n` kernels, padded to whole leaves by zeros; values are to be written.
  void allocate(std::size_t n) {
    if (is_shared()) values_ = UninitializedVector<float>();
    values_.resize((n + Bvh::leaf_size - 1) / Bvh::leaf_size * Bvh::leaf_size);
    std::fill(values_.begin() + static_cast<std::ptrdiff_t>(n), values_.end(), 0.0f);
    mask_ = ~std::size_t{0};
  }

  bool is_shared() const { return mask_ == Bvh::leaf_size - 1; }
  float operator[](std::size_t i) const { return values_[i & mask_]; }
  /// Values of kernel `i` and those that follow it in its leaf; aligned to a cache line where i is
  /// a leaf's first.
  const float* from(std::size_t i) const { return values_.data() + (i & mask_); }
  /// To write kernel i's value to.
  float& at(std::size_t i) {
    assert(!is_shared());
    return values_[i];
  }
  /// Those of the first n kernels, without padding; one for all where they share it.
  std::span<const float> first(std::size_t n) const {
    return std::span(values_).first(is_shared() ? 1 : n);
  }
  std::size_t bytes() const { return values_.size() * sizeof(float); }

 private:
  UninitializedVector<float> values_;
  std::size_t mask_ = ~std::size_t{0};  ///< from a kernel's index to its value's
};

}  // namespace motes
