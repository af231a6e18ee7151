// Which groups of pixels of an area each gathered kernel may reach on a plane of samples. Included
// once per instruction set.
#if defined(MOTES_FIELD_SWEEP_BOXES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MOTES_FIELD_SWEEP_BOXES_INL_H_
#undef MOTES_FIELD_SWEEP_BOXES_INL_H_
#else
#define MOTES_FIELD_SWEEP_BOXES_INL_H_
#endif

#include <hwy/highway.h>

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

#include "core/aligned.h"
#include "field/gather-inl.h"
#include "samples/area_buffer.h"
#include "samples/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace motes {
namespace HWY_NAMESPACE {

/// The samples of an area on one plane, in the slab's frame: that of column i and row j lies at
/// (x + i dx, y + j dy, z).
struct AreaPlane {
  float x, dx, y, dy, z;
};

/// Plane `k` of the slab; `area` bounds the rays of the area's pixels.
inline AreaPlane place_plane(const RayBounds& area, const SlabFrame& frame, int k) {
  const double z = static_cast<double>(frame.first_depth) + k * static_cast<double>(frame.step);
  const double depth = frame.reference_depth + z;
  const auto low = [&](const Range& origin, const Range& direction) {
    return origin.low + depth * direction.low;
  };
  const auto high = [&](const Range& origin, const Range& direction) {
    return origin.high + depth * direction.high;
  };
  constexpr double steps = AreaBuffer::size - 1;
  const double left = low(area.origin_x, area.direction_x);
  const double right = high(area.origin_x, area.direction_x);
  const double bottom = low(area.origin_y, area.direction_y);
  const double top = high(area.origin_y, area.direction_y);
  return {static_cast<float>(left - frame.reference_x), static_cast<float>((right - left) / steps),
          static_cast<float>(top - frame.reference_y), static_cast<float>((bottom - top) / steps),
          static_cast<float>(z)};
}

/// Groups of an area that a kernel may reach on a plane.
struct GroupBox {
  std::uint8_t column, row, last_column, last_row;

  int columns() const { return last_column - column + 1; }
  int rows() const { return last_row - row + 1; }
};

/// Boxes of so many columns of groups have a list of their own.
inline constexpr int max_narrow_columns = 6;

/// Gathered kernels that reach a plane, with their boxes.
struct BoxedKernels {
  AlignedVector<std::uint32_t> kernel, box;
  std::size_t size = 0;

  GroupBox box_of(std::size_t i) const { return std::bit_cast<GroupBox>(box[i]); }
  /// Empties the list and makes room for `count`.
  void start(std::size_t count) {
    size = 0;
    if (count + max_lanes <= kernel.size()) return;
    kernel.resize(2 * (count + max_lanes));
    box.resize(2 * (count + max_lanes));
  }
  void append(std::uint32_t one_kernel, std::uint32_t one_box) {
    kernel[size] = one_kernel;
    box[size++] = one_box;
  }
};

/// Kernels that reach a plane, by the size of their boxes; in each list in the order in which they
/// were gathered.
struct PlaneKernels {
  BoxedKernels all;
  std::array<BoxedKernels, max_narrow_columns> narrow;  ///< element c: of c + 1 columns
  BoxedKernels wide;

  /// Shares out `all`.
  void sort() {
    for (BoxedKernels& list : narrow) list.start(all.size);
    wide.start(all.size);
    for (std::size_t i = 0; i < all.size; ++i) {
      const int columns = all.box_of(i).columns();
      BoxedKernels& list =
          columns <= max_narrow_columns ? narrow[static_cast<std::size_t>(columns - 1)] : wide;
      list.append(all.kernel[i], all.box[i]);
    }
  }
};

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

/// Finds the kernels that reach samples of the area on `plane`.
HWY_NOINLINE void find_boxes(const GatheredKernels& gathered, const AreaPlane& plane,
                             PlaneKernels& out) {
  const LaneTag d;
  const hn::RebindToSigned<LaneTag> di;
  const hn::RebindToUnsigned<LaneTag> du;
  out.all.start(gathered.size);
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
    const auto box = hn::Or(hn::Or(column, hn::ShiftLeft<8>(row)),
                            hn::Or(hn::ShiftLeft<16>(last_column), hn::ShiftLeft<24>(last_row)));
    const auto kernel = numbers_from(static_cast<std::uint32_t>(i));
    const auto which = hn::RebindMask(du, any);
    hn::StoreU(hn::Compress(kernel, which), du, out.all.kernel.data() + out.all.size);
    hn::StoreU(hn::Compress(box, which), du, out.all.box.data() + out.all.size);
    out.all.size += hn::CountTrue(d, any);
  }
  out.sort();
}

}  // namespace HWY_NAMESPACE
}  // namespace motes
HWY_AFTER_NAMESPACE();

#endif
