// Pass 1 for fields that are grids: their samples on the planes of a slab, for a block of rays.
// Included once per instruction set.
#if defined(MOTES_RENDER_SAMPLE_GRIDS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MOTES_RENDER_SAMPLE_GRIDS_INL_H_
#undef MOTES_RENDER_SAMPLE_GRIDS_INL_H_
#else
#define MOTES_RENDER_SAMPLE_GRIDS_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "grid/sample_grid-inl.h"
#include "render/frame_grids.h"
#include "samples/lanes-inl.h"
#include "samples/samples.h"

HWY_BEFORE_NAMESPACE();
namespace motes {
namespace HWY_NAMESPACE {

using DoubleTag = hn::CappedTag<double, max_lanes / 2>;
using Doubles = hn::Vec<DoubleTag>;

/// A block's rays in the index coordinates of a grid, where a point at depth z is start + z along;
/// in double, since the eye may be millions of steps away.
struct GridRays {
  alignas(64) double start[3][max_lanes], along[3][max_lanes];
  alignas(64) double near[max_lanes], far[max_lanes];  ///< depths at which they are in the hull
};

inline void make_grid_rays(const FrameGrid& grid, const RayPacket& packet, const FieldRange& range,
                           const SamplePlanes& planes, GridRays& rays) {
  const DoubleTag d;
  for (std::size_t i = 0; i < 3; ++i) {
    const Doubles x = hn::Set(d, grid.axes[i][0]), y = hn::Set(d, grid.axes[i][1]);
    const Doubles forward = hn::Set(d, grid.axes[i][2]), eye = hn::Set(d, grid.eye[i]);
    for (std::size_t l = 0; l < num_lanes; l += hn::Lanes(d)) {
      const auto at = [&](const double* u, const double* v, Doubles sum) MOTES_INLINE HWY_ATTR {
        return hn::MulAdd(hn::Load(d, u + l), x, hn::MulAdd(hn::Load(d, v + l), y, sum));
      };
      hn::Store(at(packet.origin_x, packet.origin_y, eye), d, rays.start[i] + l);
      hn::Store(at(packet.direction_x, packet.direction_y, forward), d, rays.along[i] + l);
    }
  }
  const auto depth = [&](const float* sample, const float* fraction,
                         std::size_t l) MOTES_INLINE HWY_ATTR {
    const hn::Rebind<float, DoubleTag> df;
    const Doubles place = hn::Add(hn::PromoteTo(d, hn::Load(df, sample + l)),
                                  hn::PromoteTo(d, hn::Load(df, fraction + l)));
    const Doubles first = hn::Set(d, static_cast<double>(planes.first));
    return hn::Mul(hn::Add(place, first), hn::Set(d, planes.step));
  };
  for (std::size_t l = 0; l < num_lanes; l += hn::Lanes(d)) {
    hn::Store(depth(range.first, range.enters, l), d, rays.near + l);
    hn::Store(depth(range.last, range.leaves, l), d, rays.far + l);
  }
}

/// Blocks of cells of one axis, both included.
struct CellRange {
  int first, last;
};

/// Those that the rays pass between two depths, or that all of the axis has. Too many never harm.
inline CellRange cells_between(const GridRays& rays, std::size_t axis, double near, double far,
                               int num_cells) {
  const DoubleTag d;
  Doubles low = hn::Set(d, 1e30), high = hn::Set(d, -1e30);
  for (std::size_t l = 0; l < num_lanes; l += hn::Lanes(d)) {
    const Doubles start = hn::Load(d, rays.start[axis] + l);
    const Doubles along = hn::Load(d, rays.along[axis] + l);
    const Doubles a = hn::MulAdd(hn::Set(d, near), along, start);
    const Doubles b = hn::MulAdd(hn::Set(d, far), along, start);
    low = hn::Min(low, hn::Min(a, b));
    high = hn::Max(high, hn::Max(a, b));
  }
  // A hair more than the rounding of index coordinates to float, which comes to 1 at 2^24.
  const auto clamped = [num_cells](double v) {
    return static_cast<int>(std::clamp(v, 0.0, num_cells - 1.0));
  };
  const double slack = 1e-6 * num_cells;
  return {clamped(hn::GetLane(hn::MinOfLanes(d, low)) - slack) / MacroCells::size,
          clamped(hn::GetLane(hn::MaxOfLanes(d, high)) + slack) / MacroCells::size};
}

/// Whether the grid may show anything to the rays between two depths.
inline bool may_show(const FrameGrid& grid, const GridRays& rays, double near, double far) {
  CellRange cells[3];
  int count = 1;
  for (std::size_t i = 0; i < 3; ++i) {
    cells[i] = cells_between(rays, i, near, far, grid.view.num_cells[i]);
    count *= std::min(cells[i].last - cells[i].first + 1, 64);
  }
  // Seen from afar: looking would take longer than it saves.
  if (count > 64) return true;
  for (int k = cells[2].first; k <= cells[2].last; ++k) {
    for (int j = cells[1].first; j <= cells[1].last; ++j) {
      const auto row = static_cast<std::size_t>(k) * static_cast<std::size_t>(grid.dims[1]) +
                       static_cast<std::size_t>(j);
      const std::uint8_t* const visible =
          grid.visible.data() + row * static_cast<std::size_t>(grid.dims[0]);
      for (int i = cells[0].first; i <= cells[0].last; ++i) {
        if (visible[i] != 0) return true;
      }
    }
  }
  return false;
}

/// Places of the rays at a depth, or next to it in the hull.
HWY_INLINE Lanes index_at(const GridRays& rays, std::size_t axis, double depth) {
  const DoubleTag d;
  const hn::Rebind<float, DoubleTag> df;
  alignas(64) float out[max_lanes];
  for (std::size_t l = 0; l < num_lanes; l += hn::Lanes(d)) {
    const Doubles z =
        hn::Min(hn::Max(hn::Set(d, depth), hn::Load(d, rays.near + l)), hn::Load(d, rays.far + l));
    const Doubles at =
        hn::MulAdd(z, hn::Load(d, rays.along[axis] + l), hn::Load(d, rays.start[axis] + l));
    hn::Store(hn::DemoteTo(df, at), df, out + l);
  }
  return hn::Load(LaneTag(), out);
}

/// Samples of a plane into their channels: 0 where `inside` says that the grid is not.
template <bool kCubic, bool kGradients>
HWY_NOINLINE void sample_plane(const FrameGrid& grid, const GridRays& rays, double depth,
                               LaneMask inside, bool absolute, float* out) {
  const LaneTag d;
  const GridPoints points{index_at(rays, 0, depth), index_at(rays, 1, depth),
                          index_at(rays, 2, depth)};
  const GridSamples s = sample_grid<kCubic, kGradients>(d, grid.view, points);
  const Lanes value = hn::Mul(s.value, hn::Set(d, grid.value_scale));
  hn::Store(hn::IfThenElseZero(inside, value), d, out);
  if constexpr (kGradients) {
    for (std::size_t a = 0; a < 3; ++a) {
      const float* const g = grid.gradient[a];
      const Lanes sum =
          hn::MulAdd(hn::Set(d, g[0]), s.dx,
                     hn::MulAdd(hn::Set(d, g[1]), s.dy, hn::Mul(hn::Set(d, g[2]), s.dz)));
      hn::Store(hn::IfThenElseZero(inside, sum), d, out + (1 + a) * num_lanes);
    }
    if (absolute) hn::Store(hn::IfThenElseZero(inside, hn::Abs(value)), d, out + 4 * num_lanes);
  }
}

/// Planes that are looked at together for what may be seen: about a macro cell of default steps.
inline constexpr int planes_looked_at = 8;

/// Puts a grid's samples on the planes of a slab to out, out + plane_floats, ...: where the field
/// may show something. Elsewhere the buffer keeps its zeros or, where zero shows, gets a value that
/// does not. Calls touch(i) for each plane that it writes to. `range` is that of the grid's field.
template <class Touch>
void sample_frame_grid(const FrameGrid& grid, const RayPacket& packet, const FieldRange& range,
                       const SamplePlanes& planes, const Slab& slab, bool gradients, bool absolute,
                       float* out, std::size_t plane_floats, Touch&& touch) {
  const LaneTag d;
  const Lanes first = hn::Load(d, range.first), last = hn::Load(d, range.last);
  GridRays rays;
  make_grid_rays(grid, packet, range, planes, rays);
  const auto sample = grid.view.cubic
                          ? (gradients ? &sample_plane<true, true> : &sample_plane<true, false>)
                          : (gradients ? &sample_plane<false, true> : &sample_plane<false, false>);
  for (int begin = 0; begin < slab.count; begin += planes_looked_at) {
    const int end = std::min(begin + planes_looked_at, slab.count);
    const SampleIndex k = slab.first + begin;
    const Lanes low = hn::Set(d, static_cast<float>(k));
    const Lanes high = hn::Set(d, static_cast<float>(slab.first + end - 1));
    // (a sample at the hull may be taken up to half a step away from its plane)
    const double before = planes.depth(k) - 0.5 * planes.step;
    const double behind = planes.depth(slab.first + end - 1) + 0.5 * planes.step;
    const bool any = !hn::AllFalse(d, hn::And(hn::Le(first, high), hn::Ge(last, low))) &&
                     may_show(grid, rays, before, behind);
    if (!any && grid.hidden_value == 0) continue;
    for (int i = begin; i < end; ++i) {
      float* const at = out + static_cast<std::size_t>(i) * plane_floats;
      const Lanes place = hn::Set(d, static_cast<float>(slab.first + i));
      const LaneMask inside = hn::And(hn::Le(first, place), hn::Ge(last, place));
      if (any) {
        sample(grid, rays, planes.depth(slab.first + i), inside, absolute, at);
      } else {
        hn::Store(hn::Set(d, grid.hidden_value), d, at);
      }
      touch(i);
    }
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace motes
HWY_AFTER_NAMESPACE();

#endif
