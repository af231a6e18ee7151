// Which groups of pixels of an area each gathered kernel may reach on a plane of samples. Included
// once per instruction set.
#if defined(MOTES_FIELD_SWEEP_BOXES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MOTES_FIELD_SWEEP_BOXES_INL_H_
#undef MOTES_FIELD_SWEEP_BOXES_INL_H_
#else
#define MOTES_FIELD_SWEEP_BOXES_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "core/aligned.h"
#include "field/area_pixels.h"
#include "field/gather-inl.h"
#include "samples/area_buffer.h"
#include "samples/compress-inl.h"
#include "samples/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace motes {
namespace HWY_NAMESPACE {

/// Groups or pixels of an area that a kernel may reach.
struct KernelBox {
  std::uint8_t column, row, last_column, last_row;

  int columns() const { return last_column - column + 1; }
  int rows() const { return last_row - row + 1; }
};

/// The bytes of KernelBoxes.
template <class V>
HWY_INLINE V box_of(V column, V row, V last_column, V last_row) {
  return hn::Or(hn::Or(column, hn::ShiftLeft<8>(row)),
                hn::Or(hn::ShiftLeft<16>(last_column), hn::ShiftLeft<24>(last_row)));
}

/// A gathered kernel on a plane or, if it is thin, on a vector of planes from that on.
struct BoxedKernel {
  std::uint32_t kernel, plane;
  KernelBox box;
};

/// Kernels that reach some planes, first as they are found, then by a key below kKeys: what belongs
/// together comes one after the other.
template <std::size_t kKeys>
class SortedKernels {
 public:
  std::size_t size() const { return size_; }
  void clear() { size_ = 0; }

  /// Makes room for `count` more and what whole vectors write behind them.
  void reserve(std::size_t count) {
    if (size_ + count + max_lanes <= kernel_.size()) return;
    const std::size_t room = 2 * (size_ + count + max_lanes);
    for (auto* array : {&kernel_, &plane_, &box_, &key_}) array->resize(room);
  }

  /// Adds the lanes of `which`.
  template <class V>
  HWY_INLINE void append(LaneTag d, LaneMask which, V key, V kernel, V plane, V box) {
    const FrontLanes front(d, which);
    front.store(key, key_.data() + size_);
    front.store(kernel, kernel_.data() + size_);
    front.store(plane, plane_.data() + size_);
    front.store(box, box_.data() + size_);
    size_ += front.count();
  }

  /// Sorts by key. The order of those of a key depends only on the order of appending. Four
  /// counters a key, taken in turn, since each would wait for its last increment.
  void sort() {
    sorted_.resize(std::max(sorted_.size(), size_));
    constexpr std::size_t ways = 4;
    std::array<std::array<std::uint32_t, ways>, kKeys> next{};
    for (std::size_t i = 0; i < size_; ++i) ++next[key_[i]][i % ways];
    std::uint32_t end = 0;
    for (std::size_t key = 0; key < kKeys; ++key) {
      begin_[key] = end;
      for (std::uint32_t& count : next[key]) end += std::exchange(count, end);
    }
    begin_[kKeys] = end;
    for (std::size_t i = 0; i < size_; ++i) {
      sorted_[next[key_[i]][i % ways]++] = {kernel_[i], plane_[i],
                                            std::bit_cast<KernelBox>(box_[i])};
    }
  }

  /// Sorted ones with keys first to last - 1.
  std::span<const BoxedKernel> with_keys(std::size_t first, std::size_t last) const {
    return {sorted_.data() + begin_[first], begin_[last] - begin_[first]};
  }

 private:
  AlignedVector<std::uint32_t> kernel_, plane_, box_, key_;
  std::size_t size_ = 0;
  std::vector<BoxedKernel> sorted_;
  std::array<std::uint32_t, kKeys + 1> begin_{};
};

/// Shapes of boxes of groups: their columns and rows, each up to max_box_shape and all that are
/// longer. Sorted by them, loops over a box are of the same length for many kernels, and the
/// processor guesses right when they end. A mistake costs it as much as two groups.
inline constexpr std::uint32_t max_box_shape = 7;
using PlaneKernels = SortedKernels<std::size_t{max_box_shape * max_box_shape}>;

/// Those whose boxes have from `fewest` to `most` columns, or more if that is max_box_shape.
inline std::span<const BoxedKernel> with_columns(const PlaneKernels& kernels, std::size_t fewest,
                                                 std::size_t most) {
  return kernels.with_keys((fewest - 1) * max_box_shape, most * max_box_shape);
}

/// First and last group of pixels, not yet rounded down, of those along one axis that lie within
/// `half` of a centre, both in pixels from the area's first; `any`: there are such.
template <class V>
struct GroupSpan {
  V first, last;
  hn::Mask<LaneTag> any;
};

HWY_INLINE GroupSpan<Lanes> group_span(LaneTag d, Lanes center, Lanes half) {
  const Lanes end = hn::Set(d, static_cast<float>(AreaBuffer::size - 1));
  const Lanes first = hn::Max(hn::Zero(d), hn::Ceil(hn::Sub(center, half)));
  const Lanes last = hn::Min(end, hn::Floor(hn::Add(center, half)));
  const Lanes per_group = hn::Set(d, 1.0f / AreaBuffer::group_size);
  return {hn::Mul(first, per_group), hn::Mul(last, per_group), hn::Le(first, last)};
}

/// Appends the kernels that reach samples of the area on `plane`, the `number`-th.
HWY_NOINLINE void find_boxes(const GatheredKernels& gathered, const AreaPlane& plane, int number,
                             PlaneKernels& out) {
  const LaneTag d;
  const hn::RebindToSigned<LaneTag> di;
  const hn::RebindToUnsigned<LaneTag> du;
  out.reserve(gathered.size);
  // Rounding of the square root and of places, in pixels.
  const Lanes slack = hn::Set(d, 1e-3f), stretch = hn::Set(d, 1.0005f);
  const Lanes per_column = hn::Set(d, 1 / plane.dx), per_row = hn::Set(d, 1 / plane.dy);
  const Lanes rows_per_length = hn::Abs(per_row);
  for (std::size_t i = 0; i < gathered.size; i += hn::Lanes(d)) {
    const Lanes dz = hn::Sub(hn::Load(d, gathered.z.data() + i), hn::Set(d, plane.z));
    const Lanes disc_sq = hn::NegMulAdd(dz, dz, hn::Load(d, gathered.plane_support_sq.data() + i));
    const LaneMask reaches = hn::Gt(disc_sq, hn::Set(d, 1e-30f));
    if (hn::AllFalse(d, reaches)) continue;
    const Lanes disc = hn::Mul(hn::Mul(disc_sq, hn::ApproximateReciprocalSqrt(disc_sq)), stretch);
    const Lanes x = hn::Sub(hn::Load(d, gathered.x.data() + i), hn::Set(d, plane.x));
    const Lanes y = hn::Sub(hn::Load(d, gathered.y.data() + i), hn::Set(d, plane.y));
    const auto columns = group_span(d, hn::Mul(x, per_column), hn::MulAdd(disc, per_column, slack));
    const auto rows = group_span(d, hn::Mul(y, per_row), hn::MulAdd(disc, rows_per_length, slack));
    const LaneMask any = hn::And(reaches, hn::And(columns.any, rows.any));
    if (hn::AllFalse(d, any)) continue;
    const auto whole = [&](Lanes v) HWY_ATTR { return hn::BitCast(du, hn::ConvertTo(di, v)); };
    const auto column = whole(columns.first), last_column = whole(columns.last);
    const auto row = whole(rows.first), last_row = whole(rows.last);
    const auto box = box_of(column, row, last_column, last_row);
    const auto kernel = numbers_from(static_cast<std::uint32_t>(i));
    const auto most = hn::Set(du, max_box_shape - 1);
    const auto shape = [&](auto first, auto last)
                           HWY_ATTR { return hn::Min(hn::Sub(last, first), most); };
    const auto key = hn::Add(hn::Mul(shape(column, last_column), hn::Set(du, max_box_shape)),
                             shape(row, last_row));
    out.append(d, any, key, kernel, hn::Set(du, static_cast<std::uint32_t>(number)), box);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace motes
HWY_AFTER_NAMESPACE();

#endif
