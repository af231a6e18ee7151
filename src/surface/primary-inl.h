// The first hits of a tile of camera rays: near to far through the tree, each ball and stick
// against the blocks of rays that it covers. Included once per instruction set.
#if defined(MOTES_SURFACE_PRIMARY_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MOTES_SURFACE_PRIMARY_INL_H_
#undef MOTES_SURFACE_PRIMARY_INL_H_
#else
#define MOTES_SURFACE_PRIMARY_INL_H_
#endif

#include <hwy/cache_control.h>
#include <hwy/highway.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "bvh/bvh.h"
#include "samples/lanes-inl.h"
#include "surface/place-inl.h"
#include "surface/shapes-inl.h"
#include "surface/surface.h"
#include "surface/tile_rays.h"

HWY_BEFORE_NAMESPACE();
namespace motes {
namespace HWY_NAMESPACE {

/// The nearest hits of a tile's rays, block by block: lane l of block b at TileRays::lanes b + l.
struct TileHits {
  static constexpr std::size_t size = std::size_t{TileRays::num_blocks} * TileRays::lanes;
  alignas(64) float depth[size];  ///< in the tile's frame
  alignas(64) std::uint32_t particle[size], stick[size];
  /// The largest depth of each block: what lies beyond it cannot be seen there.
  alignas(64) float farthest[TileRays::num_blocks];
};

class TileTracer {
 public:
  TileTracer(const Surface& surface, const TileRays& rays, TileHits& hits)
      : surface_(surface), kernels_(*surface.kernels), rays_(rays), hits_(hits) {}

  /// Finds the hits.
  void run() {
    clear();
    if (kernels_.bvh.nodes.empty()) return;
    push_children(0, 0);
    while (size_ != 0) {
      const Entry entry = stack_[--size_];
      if ((entry.blocks & open_blocks(entry.near)) == 0) continue;
      if (entry.level == leaf_level()) {
        visit_leaf(entry.index);
      } else {
        push_children(entry.level, entry.index);
      }
    }
  }

 private:
  /// A node or leaf to be visited.
  struct Entry {
    float near;  ///< nothing in it is nearer
    std::uint16_t blocks, level;
    std::uint32_t index;  ///< within the level
  };
  static constexpr float infinity = std::numeric_limits<float>::infinity();

  std::uint32_t leaf_level() const {
    return static_cast<std::uint32_t>(kernels_.bvh.level_begin.size());
  }

  /// No hits; rays that are not there have one before all others, so that nothing changes it.
  void clear() {
    std::fill_n(hits_.particle, TileHits::size, no_particle);
    std::fill_n(hits_.stick, TileHits::size, no_stick);
    std::fill_n(hits_.farthest, TileRays::num_blocks, -infinity);
    for (std::size_t i = 0; i < TileHits::size; ++i) {
      const std::size_t block = i / TileRays::lanes;
      const bool there = rays_.has(TileRays::column(block, i % TileRays::lanes),
                                   TileRays::row(block, i % TileRays::lanes));
      hits_.depth[i] = there ? infinity : -infinity;
      if (there) hits_.farthest[block] = infinity;
    }
  }

  /// Blocks in which something that is no nearer than `near` may be seen.
  unsigned open_blocks(float near) const {
    const LaneTag d;
    unsigned open = 0;
    for (std::size_t i = 0; i < TileRays::num_blocks; i += hn::Lanes(d)) {
      const Lanes farthest = hn::Load(d, hits_.farthest + i);
      open |= mask_bits(d, hn::Gt(farthest, hn::Set(d, near))) << i;
    }
    return open;
  }

  /// Puts the children of a node that may be seen on the stack, the nearest on top.
  void push_children(std::uint32_t level, std::uint32_t index) {
    const std::size_t node = kernels_.bvh.level_begin[level] + index;
    Covered covered;
    unsigned mask =
        cover_children(rays_, kernels_.bvh.nodes[node], surface_.reach.of(node), covered);
    const std::size_t begin = size_;
    for (; mask != 0; mask &= mask - 1) {
      const auto c = static_cast<std::uint32_t>(__builtin_ctz(mask));
      const Entry entry{covered.near[c], static_cast<std::uint16_t>(covered.blocks(c)),
                        static_cast<std::uint16_t>(level + 1),
                        index * static_cast<std::uint32_t>(Bvh::width) + c};
      if ((entry.blocks & open_blocks(entry.near)) == 0) continue;
      if (entry.level == leaf_level()) {
        for (const auto* array : {&kernels_.x, &kernels_.y, &kernels_.z}) {
          hwy::Prefetch(array->data() + std::size_t{entry.index} * Bvh::leaf_size);
        }
      }
      std::size_t i = size_++;
      for (; i > begin && stack_[i - 1].near < entry.near; --i) stack_[i] = stack_[i - 1];
      stack_[i] = entry;
    }
  }

  void visit_leaf(std::size_t index) {
    const std::size_t first = index * Bvh::leaf_size;
    PlacedLeaf leaf;
    place_leaf(rays_, kernels_, first, leaf);
    Covered covered;
    const Balls balls = cover_balls(rays_, surface_, first, leaf, covered);
    if (balls.small != 0) test_small_balls(leaf, covered, first, balls.small);
    for (unsigned large = balls.large; large != 0; large &= large - 1) {
      const auto i = static_cast<std::size_t>(__builtin_ctz(large));
      for_open_blocks(covered, i, [&]<bool kCut>(std::size_t block) MOTES_INLINE {
        test_ball<kCut>(leaf, first, i, block);
      });
    }
    if (!surface_.sticks.begin.empty()) visit_sticks(leaf, first);
  }

  /// test<kCut>(block) for each block in which something may be seen; kCut: it may reach behind the
  /// eye's plane.
  template <class Test>
  HWY_INLINE void for_open_blocks(const Covered& covered, std::size_t i, const Test& test) const {
    const float near = covered.near[i];
    for (unsigned blocks = covered.blocks(i) & open_blocks(near); blocks != 0;
         blocks &= blocks - 1) {
      const auto block = static_cast<std::size_t>(__builtin_ctz(blocks));
      if (near > rays_.near) {
        test.template operator()<false>(block);
      } else {
        test.template operator()<true>(block);
      }
    }
  }

  /// The balls of a leaf that cover few rays, all at once: each against up to 2 x 2.
  void test_small_balls(const PlacedLeaf& leaf, const Covered& covered, std::size_t first,
                        unsigned small) {
    const LaneTag d;
    const hn::RebindToSigned<LaneTag> di;
    unsigned touched = 0;
    for (int corner = 0; corner < 4; ++corner) {
      const int right = corner % 2, down = corner / 2;
      alignas(64) float depths[Bvh::leaf_size];
      alignas(64) std::int32_t places[Bvh::leaf_size];
      unsigned hits = 0;
      for (std::size_t i = 0; i < Bvh::leaf_size; i += hn::Lanes(d)) {
        const Lanes column =
            hn::Add(hn::Load(d, covered.first_column + i), hn::Set(d, static_cast<float>(right)));
        const Lanes row =
            hn::Add(hn::Load(d, covered.first_row + i), hn::Set(d, static_cast<float>(down)));
        LaneMask hit = hn::And(hn::Le(column, hn::Load(d, covered.last_column + i)),
                               hn::Le(row, hn::Load(d, covered.last_row + i)));
        if (hn::AllFalse(d, hit)) continue;
        const Chord<LaneTag> chord = meet_ray(leaf, first, i, column, row);
        const Lanes depth = hn::Add(hn::Load(d, leaf.depth + i), chord.first);
        // [row / 4][column / 4][row % 4][column % 4]
        const auto x = hn::ConvertTo(di, column), y = hn::ConvertTo(di, row);
        const auto three = hn::Set(di, 3);
        const auto block = hn::Or(hn::ShiftLeft<2>(hn::ShiftRight<2>(y)), hn::ShiftRight<2>(x));
        const auto lane = hn::Or(hn::ShiftLeft<2>(hn::And(y, three)), hn::And(x, three));
        const auto place = hn::And(hn::Or(hn::ShiftLeft<4>(block), lane),
                                   hn::Set(di, TileRays::num_blocks * TileRays::lanes - 1));
        hit = hn::And(hit, chord.any);
        hit = hn::And(hit, hn::Lt(depth, hn::GatherIndex(d, hits_.depth, place)));
        hn::Store(depth, d, depths + i);
        hn::Store(place, di, places + i);
        hits |= mask_bits(d, hit) << i;
      }
      // One by one: several may hit the same ray.
      for (hits &= small; hits != 0; hits &= hits - 1) {
        const auto i = static_cast<std::size_t>(__builtin_ctz(hits));
        float& old = hits_.depth[places[i]];
        if (!(depths[i] < old)) continue;
        old = depths[i];
        hits_.particle[places[i]] = static_cast<std::uint32_t>(first + i);
        hits_.stick[places[i]] = no_stick;
        touched |= 1u << places[i] / TileRays::lanes;
      }
    }
    for (; touched != 0; touched &= touched - 1) {
      const auto block = static_cast<std::size_t>(__builtin_ctz(touched));
      Lanes farthest = hn::Set(d, -infinity);
      for (std::size_t l = 0; l < TileRays::lanes; l += hn::Lanes(d)) {
        farthest = hn::Max(farthest, hn::Load(d, hits_.depth + block * TileRays::lanes + l));
      }
      hits_.farthest[block] = hn::GetLane(hn::MaxOfLanes(d, farthest));
    }
  }

  /// Balls i and following of a leaf, each against a ray of its own.
  HWY_INLINE Chord<LaneTag> meet_ray(const PlacedLeaf& leaf, std::size_t first, std::size_t i,
                                     Lanes column, Lanes row) const {
    const LaneTag d;
    const Lanes middle = hn::Set(d, TileRays::middle), one = hn::Set(d, 1.0f);
    const Lanes offset_x = hn::Mul(hn::Sub(column, middle), hn::Set(d, rays_.step[0]));
    const Lanes offset_y = hn::Mul(hn::Sub(row, middle), hn::Set(d, rays_.step[1]));
    Lanes scale = one;
    Vector3v<Lanes> direction{hn::Zero(d), hn::Zero(d), one};
    if (!rays_.orthographic) {
      scale = hn::Load(d, leaf.distance + i);
      direction.x = hn::Add(offset_x, hn::Set(d, rays_.middle_slope[0]));
      direction.y = hn::Add(offset_y, hn::Set(d, rays_.middle_slope[1]));
    }
    const Vector3v<Lanes> origin{hn::MulSub(scale, offset_x, hn::Load(d, leaf.x + i)),
                                 hn::MulSub(scale, offset_y, hn::Load(d, leaf.y + i)), hn::Zero(d)};
    return meet_ball(d, origin, direction, hn::Div(one, dot(d, direction, direction)),
                     hn::Load(d, surface_.radius.from(first + i)));
  }

  /// Lanes l and following of a block's rays as lines through the plane of a particle's depth,
  /// relative to the particle.
  struct Lines {
    Vector3v<Lanes> origin, direction;
  };
  HWY_INLINE Lines lines_of(const PlacedLeaf& leaf, std::size_t i, std::size_t block,
                            std::size_t l) const {
    const LaneTag d;
    const std::size_t column = block % TileRays::blocks_per_side;
    const std::size_t row = block / TileRays::blocks_per_side;
    const Lanes scale = hn::Set(d, rays_.orthographic ? 1.0f : leaf.distance[i]);
    return {{hn::MulSub(scale, hn::Load(d, rays_.offset_x[column] + l), hn::Set(d, leaf.x[i])),
             hn::MulSub(scale, hn::Load(d, rays_.offset_y[row] + l), hn::Set(d, leaf.y[i])),
             hn::Zero(d)},
            {hn::Load(d, rays_.slope_x[column] + l), hn::Load(d, rays_.slope_y[row] + l),
             hn::Set(d, 1.0f)}};
  }

  /// Ball i of a leaf against the rays of a block.
  template <bool kCut>
  HWY_INLINE void test_ball(const PlacedLeaf& leaf, std::size_t first, std::size_t i,
                            std::size_t block) {
    const LaneTag d;
    const Lanes radius = hn::Set(d, surface_.radius[first + i]);
    keep_nearest<kCut>(leaf.depth[i], static_cast<std::uint32_t>(first + i), no_stick, block,
                       [&](std::size_t l) MOTES_INLINE HWY_ATTR {
                         const Lines lines = lines_of(leaf, i, block, l);
                         return meet_ball(d, lines.origin, lines.direction,
                                          hn::Load(d, rays_.inverse_square[block] + l), radius);
                       });
  }

  /// Takes the hits that are nearer than those so far of a solid that the rays of a block meet in
  /// chord(first lane), relative to `depth`.
  template <bool kCut, class GetChord>
  HWY_INLINE void keep_nearest(float depth, std::uint32_t particle, std::uint32_t stick,
                               std::size_t block, const GetChord& chord_of) {
    const LaneTag d;
    const hn::RebindToUnsigned<LaneTag> du;
    LaneMask any = hn::FirstN(d, 0);
    Lanes farthest = hn::Set(d, -infinity);
    for (std::size_t l = 0; l < TileRays::lanes; l += hn::Lanes(d)) {
      const std::size_t at = block * TileRays::lanes + l;
      const auto chord = chord_of(l);
      Lanes hit = hn::Add(hn::Set(d, depth), chord.first);
      LaneMask closer = chord.any;
      if (kCut) {
        const Lanes near = hn::Set(d, rays_.near);
        hit = hn::IfThenElse(hn::Gt(hit, near), hit, hn::Add(hn::Set(d, depth), chord.last));
        closer = hn::And(closer, hn::Gt(hit, near));
      }
      const Lanes old = hn::Load(d, hits_.depth + at);
      closer = hn::And(closer, hn::Lt(hit, old));
      const Lanes now = hn::IfThenElse(closer, hit, old);
      farthest = hn::Max(farthest, now);
      any = hn::Or(any, closer);
      hn::Store(now, d, hits_.depth + at);
      const auto closer_u = hn::RebindMask(du, closer);
      hn::BlendedStore(hn::Set(du, particle), closer_u, du, hits_.particle + at);
      hn::BlendedStore(hn::Set(du, stick), closer_u, du, hits_.stick + at);
    }
    if (!hn::AllFalse(d, any)) hits_.farthest[block] = hn::GetLane(hn::MaxOfLanes(d, farthest));
  }

  /// The sticks of a leaf's particles.
  void visit_sticks(const PlacedLeaf& leaf, std::size_t first) {
    const Sticks& sticks = surface_.sticks;
    const std::size_t end = sticks.begin[first + Bvh::leaf_size];
    for (std::size_t at = sticks.begin[first]; at < end; at += hn::Lanes(LaneTag())) {
      PlacedSticks placed;
      Covered covered;
      const std::size_t count = std::min(end - at, hn::Lanes(LaneTag()));
      for (unsigned seen = cover_sticks(rays_, sticks, at, count, leaf, placed, covered); seen != 0;
           seen &= seen - 1) {
        const auto i = static_cast<std::size_t>(__builtin_ctz(seen));
        for_open_blocks(covered, i, [&]<bool kCut>(std::size_t block) MOTES_INLINE {
          test_stick<kCut>(leaf, placed, first, i, static_cast<std::uint32_t>(at + i), block);
        });
      }
    }
  }

  /// Stick i of `placed` against the rays of a block.
  template <bool kCut>
  HWY_INLINE void test_stick(const PlacedLeaf& leaf, const PlacedSticks& placed, std::size_t first,
                             std::size_t i, std::uint32_t stick, std::size_t block) {
    const LaneTag d;
    const auto owner = static_cast<std::size_t>(placed.owner[i]);
    const Vector3v<Lanes> axis{hn::Set(d, placed.axis_x[i]), hn::Set(d, placed.axis_y[i]),
                               hn::Set(d, placed.axis_z[i])};
    keep_nearest<kCut>(leaf.depth[owner], static_cast<std::uint32_t>(first + owner), stick, block,
                       [&](std::size_t l) MOTES_INLINE HWY_ATTR {
                         const Lines lines = lines_of(leaf, owner, block, l);
                         return meet_stick(d, lines.origin, lines.direction, axis,
                                           hn::Set(d, placed.length[i]),
                                           hn::Set(d, placed.radius[i]));
                       });
  }

  const Surface& surface_;
  const KernelSet& kernels_;
  const TileRays& rays_;
  TileHits& hits_;
  // A node pops itself before it pushes at most 8 children, so 7 a level and one remain.
  std::array<Entry, (Bvh::width - 1) * Bvh::max_levels + 1> stack_;
  std::size_t size_ = 0;
};

}  // namespace HWY_NAMESPACE
}  // namespace motes
HWY_AFTER_NAMESPACE();

#endif
