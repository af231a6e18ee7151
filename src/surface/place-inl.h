// Boxes, balls and sticks placed in the frame of a tile of rays: which of its rays may meet them.
// Included once per instruction set.
#if defined(MOTES_SURFACE_PLACE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MOTES_SURFACE_PLACE_INL_H_
#undef MOTES_SURFACE_PLACE_INL_H_
#else
#define MOTES_SURFACE_PLACE_INL_H_
#endif

#include <hwy/highway.h>

#include <array>
#include <cstddef>
#include <cstdint>

#include "bvh/bvh.h"
#include "samples/lanes-inl.h"
#include "surface/shapes-inl.h"
#include "surface/surface.h"
#include "surface/tile_rays.h"

HWY_BEFORE_NAMESPACE();
namespace motes {
namespace HWY_NAMESPACE {

/// Bits of the blocks in columns [first, last] and of those in rows [first, last], at 4 first +
/// last.
struct BlockTables {
  std::array<std::uint16_t, 16> columns{}, rows{};
};
inline constexpr BlockTables block_tables = [] {
  static_assert(TileRays::blocks_per_side == 4);
  BlockTables tables;
  for (unsigned first = 0; first < 4; ++first) {
    for (unsigned last = first; last < 4; ++last) {
      for (unsigned i = first; i <= last; ++i) {
        tables.columns[4 * first + last] |= 0x1111u << i;
        tables.rows[4 * first + last] |= 0xfu << 4 * i;
      }
    }
  }
  return tables;
}();

/// The rays of a tile that some things may meet: columns and rows, whole numbers within the tile,
/// and the depth before which they do not.
struct Covered {
  alignas(64) float first_column[max_lanes], last_column[max_lanes];
  alignas(64) float first_row[max_lanes], last_row[max_lanes];
  alignas(64) float near[max_lanes];

  /// A bit for each block.
  unsigned blocks(std::size_t i) const {
    const auto index = [](float first, float last) {
      return static_cast<std::size_t>(first) / TileRays::block * TileRays::blocks_per_side +
             static_cast<std::size_t>(last) / TileRays::block;
    };
    return block_tables.columns[index(first_column[i], last_column[i])] &
           block_tables.rows[index(first_row[i], last_row[i])];
  }
};

/// What is known of things: where they lie across the middle ray, at which distances from the eye's
/// plane and at which depths.
template <class V>
struct Extent {
  V low[2], high[2];
  V near_distance, far_distance;
  V near, far;
};

/// Stores at `at` what things cover; tells which cover any ray in front of the eye.
template <class D, class V = hn::Vec<D>>
HWY_INLINE hn::Mask<D> cover(D d, const TileRays& rays, Extent<V> extent, std::size_t at,
                             Covered& out) {
  if (!rays.orthographic) {
    // Something that may be as near as the eye may be seen arbitrarily far from the middle, on the
    // side that it is on.
    const V one = hn::Set(d, 1.0f), at_eye = hn::Set(d, 1e-30f);
    const V per_near = hn::Div(one, hn::Max(extent.near_distance, at_eye));
    const V per_far = hn::Div(one, extent.far_distance);
    for (int i = 0; i < 2; ++i) {
      extent.low[i] = hn::Min(hn::Mul(extent.low[i], per_near), hn::Mul(extent.low[i], per_far));
      extent.high[i] = hn::Max(hn::Mul(extent.high[i], per_near), hn::Mul(extent.high[i], per_far));
    }
  }
  V first[2], last[2];
  for (int i = 0; i < 2; ++i) {
    const V scale = hn::Set(d, rays.rays_per_place[i]);
    const V middle = hn::Set(d, TileRays::middle), rounding = hn::Set(d, 2e-3f);
    first[i] = hn::Ceil(hn::Sub(hn::MulAdd(extent.low[i], scale, middle), rounding));
    last[i] = hn::Floor(hn::Add(hn::MulAdd(extent.high[i], scale, middle), rounding));
    first[i] = hn::Max(first[i], hn::Zero(d));
    last[i] = hn::Min(last[i], hn::Set(d, TileRays::side - 1.0f));
  }
  hn::Store(first[0], d, out.first_column + at);
  hn::Store(last[0], d, out.last_column + at);
  hn::Store(first[1], d, out.first_row + at);
  hn::Store(last[1], d, out.last_row + at);
  hn::Store(extent.near, d, out.near + at);
  return hn::And(hn::Ge(extent.far, hn::Set(d, rays.near)),
                 hn::And(hn::Le(first[0], last[0]), hn::Le(first[1], last[1])));
}

/// Places a node's children; bits of those that some ray may meet.
inline unsigned cover_children(const TileRays& rays, const Bvh::Node& node, const float* reach,
                               Covered& out) {
  const hn::CappedTag<float, Bvh::width> d;
  using V = hn::Vec<decltype(d)>;
  const float* const mins[3] = {node.min_x, node.min_y, node.min_z};
  const float* const maxs[3] = {node.max_x, node.max_y, node.max_z};
  unsigned hits = 0;
  for (std::size_t c = 0; c < Bvh::width; c += hn::Lanes(d)) {
    V middle[3], half[3];
    for (int i = 0; i < 3; ++i) {
      const V min = hn::Load(d, mins[i] + c), max = hn::Load(d, maxs[i] + c);
      const V one_half = hn::Set(d, 0.5f);
      // Not a number for a child that is not there, which no comparison below lets pass.
      middle[i] = hn::MulSub(hn::Add(min, max), one_half, hn::Set(d, rays.reference[i]));
      half[i] = hn::Mul(hn::Sub(max, min), one_half);
    }
    const V reaches = hn::LoadU(d, reach + c);
    V low[3], high[3];
    for (int i = 0; i < 3; ++i) {
      V at = hn::Zero(d);
      V size = hn::MulAdd(hn::Set(d, rays.stretch[i]), reaches, hn::Set(d, rays.slack));
      for (int j = 0; j < 3; ++j) {
        const V row = hn::Set(d, rays.rows[i][j]);
        at = hn::MulAdd(row, middle[j], at);
        size = hn::MulAdd(hn::Abs(row), half[j], size);
      }
      low[i] = hn::Sub(at, size);
      high[i] = hn::Add(at, size);
    }
    const V depth = hn::Set(d, static_cast<float>(rays.depth));
    const Extent<V> extent{{low[0], low[1]},
                           {high[0], high[1]},
                           hn::Add(low[2], depth),
                           hn::Add(high[2], depth),
                           low[2],
                           high[2]};
    const auto hit = hn::And(cover(d, rays, extent, c, out), hn::Ge(reaches, hn::Zero(d)));
    hits |= mask_bits(d, hit) << c;
  }
  return hits;
}

/// The particles of a leaf in the frame of a tile.
struct PlacedLeaf {
  alignas(64) float x[Bvh::leaf_size], y[Bvh::leaf_size];  ///< across the middle ray
  alignas(64) float distance[Bvh::leaf_size];              ///< from the eye's plane
  alignas(64) float depth[Bvh::leaf_size];                 ///< relative to the tile's
};

/// Those from `first` on.
inline void place_leaf(const TileRays& rays, const KernelSet& kernels, std::size_t first,
                       PlacedLeaf& leaf) {
  const hn::CappedTag<double, max_lanes / 2> d;
  const hn::Rebind<float, decltype(d)> df;
  using V = hn::Vec<decltype(d)>;
  const float* const arrays[3] = {kernels.x.data(), kernels.y.data(), kernels.z.data()};
  for (std::size_t i = 0; i < Bvh::leaf_size; i += hn::Lanes(d)) {
    V x = hn::Set(d, -rays.middle_place[0]), y = hn::Set(d, -rays.middle_place[1]);
    V z = hn::Zero(d);
    for (int j = 0; j < 3; ++j) {
      const V p =
          hn::Sub(hn::PromoteTo(d, hn::Load(df, arrays[j] + first + i)), hn::Set(d, rays.eye[j]));
      x = hn::MulAdd(p, hn::Set(d, rays.sheared[0][j]), x);
      y = hn::MulAdd(p, hn::Set(d, rays.sheared[1][j]), y);
      z = hn::MulAdd(p, hn::Set(d, rays.forward[j]), z);
    }
    hn::Store(hn::DemoteTo(df, x), df, leaf.x + i);
    hn::Store(hn::DemoteTo(df, y), df, leaf.y + i);
    hn::Store(hn::DemoteTo(df, z), df, leaf.distance + i);
    hn::Store(hn::DemoteTo(df, hn::Sub(z, hn::Set(d, rays.depth))), df, leaf.depth + i);
  }
}

/// Bits of a leaf's balls that some ray may meet: of those that cover up to 2 x 2 rays and lie in
/// front of the eye, and of all others.
struct Balls {
  unsigned small = 0, large = 0;
};

/// Those of the particles from `first` on.
inline Balls cover_balls(const TileRays& rays, const Surface& surface, std::size_t first,
                         const PlacedLeaf& leaf, Covered& out) {
  const LaneTag d;
  Balls balls;
  for (std::size_t i = 0; i < Bvh::leaf_size; i += hn::Lanes(d)) {
    const Lanes radius = hn::Load(d, surface.radius.from(first + i));
    const Lanes distance = hn::Load(d, leaf.distance + i), depth = hn::Load(d, leaf.depth + i);
    const Lanes x = hn::Load(d, leaf.x + i), y = hn::Load(d, leaf.y + i);
    // Rays that meet the ball pass its centre's depth so near to the centre; all of the ball is
    // within that too.
    const Lanes wide_x = hn::Mul(radius, hn::Set(d, rays.max_stretch[0]));
    const Lanes wide_y = hn::Mul(radius, hn::Set(d, rays.max_stretch[1]));
    const Extent<Lanes> extent{
        {hn::Sub(x, wide_x), hn::Sub(y, wide_y)},
        {hn::Add(x, wide_x), hn::Add(y, wide_y)},
        distance,
        hn::IfThenElse(hn::Gt(distance, hn::Zero(d)), distance, hn::Add(distance, radius)),
        hn::Sub(depth, radius),
        hn::Add(depth, radius)};
    const LaneMask hit = hn::And(cover(d, rays, extent, i, out), hn::Gt(radius, hn::Zero(d)));
    const auto few = [&](const float* first_ray, const float* last_ray) HWY_ATTR {
      return hn::Le(hn::Sub(hn::Load(d, last_ray + i), hn::Load(d, first_ray + i)),
                    hn::Set(d, 1.0f));
    };
    const LaneMask small =
        hn::And(hn::And(few(out.first_column, out.last_column), few(out.first_row, out.last_row)),
                hn::Gt(extent.near, hn::Set(d, rays.near)));
    balls.small |= mask_bits(d, hn::And(hit, small)) << i;
    balls.large |= mask_bits(d, hn::AndNot(small, hit)) << i;
  }
  // What pads the last leaf is not there, even for a ray that meets it.
  const std::size_t there = surface.kernels->size() - first;
  if (there < Bvh::leaf_size) {
    balls.small &= (1u << there) - 1;
    balls.large &= (1u << there) - 1;
  }
  return balls;
}

/// Sticks in the frame of a tile.
struct PlacedSticks {
  alignas(64) float axis_x[max_lanes], axis_y[max_lanes], axis_z[max_lanes];  ///< camera axes
  alignas(64) float length[max_lanes], radius[max_lanes];
  alignas(64) std::int32_t owner[max_lanes];  ///< number of the particle within the leaf
};

/// Sticks `at` to `at` + count - 1 of a leaf, count <= the number of lanes; bits of those that some
/// ray may meet.
inline unsigned cover_sticks(const TileRays& rays, const Sticks& sticks, std::size_t at,
                             std::size_t count, const PlacedLeaf& leaf, PlacedSticks& placed,
                             Covered& out) {
  const LaneTag d;
  const StickLanes<Lanes> lanes = load_sticks(d, sticks, at);
  const hn::RebindToSigned<LaneTag> di;
  const auto owner =
      hn::PromoteTo(di, hn::LoadU(hn::Rebind<std::uint8_t, LaneTag>(), sticks.owner.data() + at));
  const auto along = [&](const Vector3d& axis) HWY_ATTR {
    const auto component = [&](int i) { return hn::Set(d, static_cast<float>(axis[i])); };
    return dot(d, lanes.axis, {component(0), component(1), component(2)});
  };
  const Lanes axis_z = along(rays.forward);
  hn::Store(along(rays.axes[0]), d, placed.axis_x);
  hn::Store(along(rays.axes[1]), d, placed.axis_y);
  hn::Store(axis_z, d, placed.axis_z);
  hn::Store(lanes.length, d, placed.length);
  hn::Store(lanes.radius, d, placed.radius);
  hn::Store(owner, di, placed.owner);

  // Both ends, and the radius all around, with a little more for rounding.
  const Lanes radius = hn::MulAdd(lanes.length, hn::Set(d, 1e-4f), lanes.radius);
  Extent<Lanes> extent;
  const auto stretch = [&](const float* begin, Lanes component, float radii, Lanes& low,
                           Lanes& high) HWY_ATTR {
    const Lanes from = hn::GatherIndex(d, begin, owner);
    const Lanes to = hn::MulAdd(component, lanes.length, from);
    const Lanes margin =
        hn::MulAdd(radius, hn::Set(d, radii), hn::Mul(hn::Abs(from), hn::Set(d, 5e-7f)));
    low = hn::Sub(hn::Min(from, to), margin);
    high = hn::Add(hn::Max(from, to), margin);
  };
  stretch(leaf.x, along(rays.sheared[0]), rays.stretch[0], extent.low[0], extent.high[0]);
  stretch(leaf.y, along(rays.sheared[1]), rays.stretch[1], extent.low[1], extent.high[1]);
  stretch(leaf.distance, axis_z, 1, extent.near_distance, extent.far_distance);
  stretch(leaf.depth, axis_z, 1, extent.near, extent.far);
  return mask_bits(d, cover(d, rays, extent, 0, out)) & ((1u << count) - 1);
}

}  // namespace HWY_NAMESPACE
}  // namespace motes
HWY_AFTER_NAMESPACE();

#endif
