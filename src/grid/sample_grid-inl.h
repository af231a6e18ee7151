// The hot path of grids: values and gradients at a vector of points. Included once per instruction
// set.
#if defined(MOTES_GRID_SAMPLE_GRID_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MOTES_GRID_SAMPLE_GRID_INL_H_
#undef MOTES_GRID_SAMPLE_GRID_INL_H_
#else
#define MOTES_GRID_SAMPLE_GRID_INL_H_
#endif

#include <hwy/highway.h>

#include <cstddef>
#include <cstdint>

#include "core/inline.h"
#include "grid/grid_sampler.h"
#include "samples/lanes-inl.h"
#include "samples/transpose-inl.h"

HWY_BEFORE_NAMESPACE();
namespace motes {
namespace HWY_NAMESPACE {

/// Points in index coordinates, one a lane.
struct GridPoints {
  Lanes x, y, z;
};

/// Values and, where asked for, gradients per index, one a lane.
struct GridSamples {
  Lanes value, dx, dy, dz;
};

/// Weights of the four taps along an axis, for the value and for its derivative.
struct TapWeights {
  Lanes value[4], slope[4];
};

/// `t` in [0, 1] between the second and the third tap: trilinear interpolation of the samples and
/// of their central differences.
HWY_INLINE TapWeights linear_weights(LaneTag d, Lanes t) {
  const Lanes s = hn::Sub(hn::Set(d, 1.0f), t), half = hn::Set(d, 0.5f);
  const Lanes half_s = hn::Mul(half, s), half_t = hn::Mul(half, t);
  return {{hn::Zero(d), s, t, hn::Zero(d)}, {hn::Neg(half_s), hn::Neg(half_t), half_s, half_t}};
}

/// The same of the cubic B-spline. Sums of weights are 1 to 2^-22.
HWY_INLINE TapWeights spline_weights(LaneTag d, Lanes t) {
  const Lanes one = hn::Set(d, 1.0f), half = hn::Set(d, 0.5f), two = hn::Set(d, 2.0f);
  const Lanes sixth = hn::Set(d, 1.0f / 6), two_thirds = hn::Set(d, 2.0f / 3);
  const Lanes three_halves = hn::Set(d, 1.5f);
  const Lanes s = hn::Sub(one, t), ss = hn::Mul(s, s), tt = hn::Mul(t, t);
  TapWeights w;
  w.value[0] = hn::Mul(hn::Mul(ss, s), sixth);
  w.value[1] = hn::MulAdd(tt, hn::MulSub(half, t, one), two_thirds);
  w.value[2] = hn::MulAdd(ss, hn::MulSub(half, s, one), two_thirds);
  w.value[3] = hn::Mul(hn::Mul(tt, t), sixth);
  w.slope[0] = hn::Neg(hn::Mul(half, ss));
  w.slope[1] = hn::Mul(t, hn::MulSub(three_halves, t, two));
  w.slope[2] = hn::Mul(s, hn::NegMulAdd(three_halves, s, two));
  w.slope[3] = hn::Mul(half, tt);
  return w;
}

/// The taps around the points: where their first ones are, and their weights.
struct TapBlock {
  const float* first[num_lanes];
  TapWeights x, y, z;
};

template <bool kCubic>
HWY_INLINE TapBlock find_taps(LaneTag d, const GridView& grid, const GridPoints& points) {
  const hn::RebindToSigned<LaneTag> di;
  // (clamped as integers: no number whatever leads out of the memory)
  const auto cell = [&](Lanes v, int num_cells) MOTES_INLINE HWY_ATTR {
    const auto below = hn::ConvertTo(di, hn::Floor(v));
    return hn::Min(hn::Max(below, hn::Zero(di)), hn::Set(di, num_cells - 1));
  };
  const auto i = cell(points.x, grid.num_cells[0]), j = cell(points.y, grid.num_cells[1]),
             k = cell(points.z, grid.num_cells[2]);
  const auto weights = [&](Lanes t) MOTES_INLINE HWY_ATTR {
    if constexpr (kCubic) {
      return spline_weights(d, t);
    } else {
      return linear_weights(d, t);
    }
  };
  TapBlock taps;
  taps.x = weights(hn::Sub(points.x, hn::ConvertTo(d, i)));
  taps.y = weights(hn::Sub(points.y, hn::ConvertTo(d, j)));
  taps.z = weights(hn::Sub(points.z, hn::ConvertTo(d, k)));

  alignas(64) std::int32_t in_plane[num_lanes], plane[num_lanes];
  const auto row = hn::Set(di, static_cast<std::int32_t>(grid.row));
  hn::Store(hn::Add(hn::Mul(j, row), i), di, in_plane);
  hn::Store(k, di, plane);
  for (std::size_t lane = 0; lane < num_lanes; ++lane) {
    taps.first[lane] =
        grid.first + static_cast<std::size_t>(plane[lane]) * grid.plane + in_plane[lane];
  }
  return taps;
}

/// The four floats at each of first[0], first[4], ..., one block of 128 bits after the other.
template <class D>
HWY_INLINE hn::Vec<D> load_fours(D d, const float* const* first, std::size_t offset) {
  constexpr std::size_t n = hn::MaxLanes(D());
  if constexpr (n == 4) {
    return hn::LoadU(d, first[0] + offset);
  } else {
    const hn::Half<D> half;
    return hn::Combine(d, load_fours(half, first + n / 2, offset), load_fours(half, first, offset));
  }
}

/// Four taps in a row, of each lane. Loading them together and transposing is a third of the work
/// of gathering them one by one, and needs rows to be contiguous, no bricks.
struct TapRow {
  Lanes tap[4];
};

HWY_INLINE TapRow load_row(LaneTag d, const TapBlock& taps, std::size_t offset) {
  TapRow row;
  for (std::size_t m = 0; m < 4; ++m) row.tap[m] = load_fours(d, taps.first + m, offset);
  transpose_fours(d, row.tap[0], row.tap[1], row.tap[2], row.tap[3]);
  return row;
}

/// What a row gives, weighed along x.
template <bool kCubic>
HWY_INLINE Lanes row_value(const TapWeights& w, const TapRow& row) {
  Lanes sum = hn::MulAdd(w.value[2], row.tap[2], hn::Mul(w.value[1], row.tap[1]));
  if constexpr (kCubic) {
    sum = hn::MulAdd(w.value[3], row.tap[3], hn::MulAdd(w.value[0], row.tap[0], sum));
  }
  return sum;
}

HWY_INLINE Lanes row_slope(const TapWeights& w, const TapRow& row) {
  const Lanes sum = hn::MulAdd(w.slope[1], row.tap[1], hn::Mul(w.slope[0], row.tap[0]));
  return hn::MulAdd(w.slope[3], row.tap[3], hn::MulAdd(w.slope[2], row.tap[2], sum));
}

/// Adds plane k of the taps to `out`. kOuter: the first or last plane of a trilinear interpolation,
/// which has weight in differences along z alone.
template <bool kCubic, bool kGradient, bool kOuter>
HWY_INLINE void add_plane(LaneTag d, const GridView& grid, const TapBlock& taps, std::size_t k,
                          GridSamples& out) {
  Lanes value = hn::Zero(d), dx = value, dy = value;
  unroll<4>([&](auto j) MOTES_INLINE HWY_ATTR {
    constexpr bool outer_row = !kCubic && (j == 0 || j == 3);
    if constexpr (!outer_row || (kGradient && !kOuter)) {
      const TapRow row = load_row(d, taps, k * grid.plane + j * grid.row);
      const Lanes sum = row_value<kCubic>(taps.x, row);
      if constexpr (!outer_row) value = hn::MulAdd(taps.y.value[j], sum, value);
      if constexpr (kGradient && !kOuter) {
        dy = hn::MulAdd(taps.y.slope[j], sum, dy);
        if constexpr (!outer_row) dx = hn::MulAdd(taps.y.value[j], row_slope(taps.x, row), dx);
      }
    }
  });
  if constexpr (!kOuter) out.value = hn::MulAdd(taps.z.value[k], value, out.value);
  if constexpr (kGradient) {
    if constexpr (!kOuter) {
      out.dx = hn::MulAdd(taps.z.value[k], dx, out.dx);
      out.dy = hn::MulAdd(taps.z.value[k], dy, out.dy);
    }
    out.dz = hn::MulAdd(taps.z.slope[k], value, out.dz);
  }
}

/// The field of a grid (kCubic as grid.cubic says) at points of its hull; without kGradient, dx, dy
/// and dz are 0. Hot: unchecked; elsewhere the result means nothing, but nothing is harmed.
/// Relative to the largest coefficient around a point, values are off by 2e-6, and besides by what
/// the rounding of the coordinates makes of the gradient.
template <bool kCubic, bool kGradient>
HWY_INLINE GridSamples sample_grid(LaneTag d, const GridView& grid, const GridPoints& points) {
  const TapBlock taps = find_taps<kCubic>(d, grid, points);
  GridSamples out{hn::Zero(d), hn::Zero(d), hn::Zero(d), hn::Zero(d)};
  if constexpr (kCubic) {
    // (a loop, for unrolled all weights would not fit into registers)
    for (std::size_t k = 0; k < 4; ++k) add_plane<true, kGradient, false>(d, grid, taps, k, out);
  } else {
    if constexpr (kGradient) add_plane<false, true, true>(d, grid, taps, 0, out);
    add_plane<false, kGradient, false>(d, grid, taps, 1, out);
    add_plane<false, kGradient, false>(d, grid, taps, 2, out);
    if constexpr (kGradient) add_plane<false, true, true>(d, grid, taps, 3, out);
  }
  return out;
}

/// Which points lie in the hull, faces included.
HWY_INLINE LaneMask in_hull(LaneTag d, const GridView& grid, const GridPoints& points) {
  const auto within = [&](Lanes v, int num_cells) MOTES_INLINE HWY_ATTR {
    return hn::And(hn::Ge(v, hn::Zero(d)), hn::Le(v, hn::Set(d, static_cast<float>(num_cells))));
  };
  return hn::And(within(points.x, grid.num_cells[0]),
                 hn::And(within(points.y, grid.num_cells[1]), within(points.z, grid.num_cells[2])));
}

}  // namespace HWY_NAMESPACE
}  // namespace motes
HWY_AFTER_NAMESPACE();

#endif
