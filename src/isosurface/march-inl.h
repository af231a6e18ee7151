// A tile of 16 x 16 rays on its way through a field: slab by slab, packets of rays look for where
// the field crosses levels. Included once per instruction set.
#if defined(MOTES_ISOSURFACE_MARCH_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MOTES_ISOSURFACE_MARCH_INL_H_
#undef MOTES_ISOSURFACE_MARCH_INL_H_
#else
#define MOTES_ISOSURFACE_MARCH_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "isosurface/isosurface.h"
#include "isosurface/kernels_along_rays-inl.h"

HWY_BEFORE_NAMESPACE();
namespace motes {
namespace HWY_NAMESPACE {

/// A packet's rays, and how far they have come.
struct MarchPacket {
  RayPacket rays;
  std::uint32_t ray[max_lanes];                          ///< number in the grid
  unsigned active = 0;                                   ///< bit l: lane l goes on
  bool started = false;                                  ///< whether value and slope are known
  alignas(64) float value[max_lanes], slope[max_lanes];  ///< on the last plane before the slab's
};

/// Goes on behind planes between which nothing can be crossed.
template <class Field>
void skip(MarchPacket& packet) {
  std::fill_n(packet.value, max_lanes, 0.0f);
  std::fill_n(packet.slope, max_lanes, 0.0f);
  packet.started = Field::zero_elsewhere;
}

/// Marches packets through one slab of one field. Field: KernelsAlongRays, or the same of a grid.
template <class Field>
class SlabMarch {
 public:
  SlabMarch(const IsosurfaceFrame& frame, const SamplingConstants& constants,
            const FieldIsosurfaces& field, std::vector<IsosurfaceHit>& out)
      : frame_(frame), field_(field), out_(out), along_(frame, constants, field) {}

  /// False if nothing of the field can be met by `rays` in `slab`.
  bool enter(const RayBounds& rays, const Slab& slab, const View& view) {
    return along_.enter(rays, slab, view);
  }

  /// Piece by piece, so that planes behind what ends all rays are not sampled.
  void run(MarchPacket& packet, const View& view) {
    packet_ = &packet;
    along_.place(packet.rays, view);
    constexpr int piece = 8;  // planes: about a macro cell of default steps
    const int last = along_.slab().count - 1;
    for (int begin = 0; begin < last && packet.active != 0; begin += piece) {
      const int end = std::min(begin + piece, last);
      if (!along_.may_cross(begin, end)) {
        skip<Field>(packet);
        continue;
      }
      const bool known = packet.started;
      along_.sample_planes(known ? begin + 1 : begin, end, values_, slopes_);
      if (!known) keep(begin);
      packet.started = true;
      for (int k = begin + 1; k <= end && packet.active != 0; ++k) {
        cross_interval(k);
        keep(k);
      }
    }
  }

 private:
  /// Takes what the rays have on plane k for what they had last.
  void keep(int k) {
    const LaneTag d;
    hn::Store(hn::Load(d, values_[k]), d, packet_->value);
    hn::Store(hn::Load(d, slopes_[k]), d, packet_->slope);
  }

  /// Finds the crossings between planes k - 1 and k.
  void cross_interval(int k) {
    const LaneTag d;
    const Lanes low = hn::Set(d, plane_depth(along_.slab(), k - 1)),
                high = hn::Set(d, plane_depth(along_.slab(), k));
    unsigned ended = 0;
    for (const IsosurfaceLevel& level : field_.levels) {
      const Lanes value = hn::Set(d, level.value);
      const Lanes before = hn::Sub(hn::Load(d, packet_->value), value);
      const Lanes after = hn::Sub(hn::Load(d, values_[k]), value);
      const unsigned in_before = mask_bits(d, hn::Gt(before, hn::Zero(d)));
      const unsigned in_after = mask_bits(d, hn::Gt(after, hn::Zero(d)));
      unsigned hits = 0;
      if constexpr (Field::has_faces) {
        hits |= cross_face(true, level, k, low, high, in_before);
        hits |= cross_face(false, level, k, low, high, in_after);
      }
      if (const unsigned cross = (in_before ^ in_after) & packet_->active; cross != 0) {
        hits |= refine(level, k, low, high, in_before, cross);
      }
      Lanes middle = low;
      if (const unsigned twice = find_turns(level, k, before, after, middle); twice != 0) {
        hits |= refine(level, k, low, middle, in_before, twice);
        hits |= refine(level, k, middle, high, ~in_before, twice);
      }
      if (level.opacity >= 1) ended |= hits;
    }
    packet_->active &= ~ended;
  }

  /// Caps: where rays enter or leave the hull within what the level encloses, which is what is
  /// farther from 0. `above`: the lanes whose field is above the level there.
  unsigned cross_face(bool entering, const IsosurfaceLevel& level, int k, Lanes low, Lanes high,
                      unsigned above) {
    if (level.value == 0) return 0;
    const unsigned enclosed = level.value > 0 ? above : ~above;
    const unsigned lanes = along_.pass_face(entering, low, high) & enclosed & packet_->active;
    if (lanes == 0) return 0;
    return finish(
        level, k, along_.face_depths(entering), lanes,
        [&](std::size_t l, const Vector3d& /*gradient*/) { return along_.face_side(entering, l); });
  }

  /// Lanes whose field is on one side of the level on both planes, k - 1 and k, but on the other
  /// side where it turns between them: at depths `middle`.
  unsigned find_turns(const IsosurfaceLevel& level, int k, Lanes before, Lanes after,
                      Lanes& middle) const {
    const LaneTag d;
    const Lanes zero = hn::Zero(d), step = hn::Set(d, along_.slab().step);
    // As if the field were above the level.
    const auto below = hn::Le(before, zero);
    const auto upright = [&](Lanes v) HWY_ATTR { return hn::IfThenElse(below, hn::Neg(v), v); };
    const Lanes a = upright(before), b = upright(after);
    const Lanes fall = upright(hn::Load(d, packet_->slope)),
                rise = upright(hn::Load(d, slopes_[k]));
    // Where the tangents meet: a field that is bent upwards is above that.
    const Lanes t = hn::Div(hn::Sub(hn::Sub(b, a), hn::Mul(rise, step)), hn::Sub(fall, rise));
    const Lanes lowest = hn::Sub(hn::MulAdd(fall, t, a), hn::Mul(hn::Set(d, 0.1f), hn::Min(a, b)));
    const auto may = hn::And(hn::And(hn::Lt(fall, zero), hn::Gt(rise, zero)),
                             hn::And(hn::Ge(b, zero), hn::Le(lowest, zero)));
    unsigned open = mask_bits(d, may) & packet_->active;
    const unsigned in_before = ~mask_bits(d, below);
    unsigned found = 0;
    Lanes low = hn::Set(d, plane_depth(along_.slab(), k - 1)),
          high = hn::Set(d, plane_depth(along_.slab(), k));
    constexpr int turns = 10;
    for (int i = 0; i < turns && open != 0; ++i) {
      const Lanes z = hn::Mul(hn::Set(d, 0.5f), hn::Add(low, high));
      const AlongRays at = along_.evaluate(k, z);
      const auto falls = hn::Lt(upright(at.slope), zero);
      low = hn::IfThenElse(falls, z, low);
      high = hn::IfThenElse(falls, high, z);
      const unsigned in = mask_bits(d, hn::Gt(at.value, hn::Set(d, level.value)));
      const unsigned crossed = (in ^ in_before) & open;
      middle = hn::IfThenElse(lanes_of(crossed), z, middle);
      found |= crossed;
      open &= ~crossed;
    }
    return found;
  }

  static LaneMask lanes_of(unsigned bits) {
    const LaneTag d;
    alignas(64) float flags[max_lanes];
    for (int l = 0; l < num_lanes; ++l) flags[l] = static_cast<float>(bits >> l & 1);
    return hn::Ne(hn::Load(d, flags), hn::Zero(d));
  }

  /// Finds where lanes cross a level between depths low and high, where they are on its two sides:
  /// those of `inside` above it at `low`. Returns the lanes whose crossing is kept.
  unsigned refine(const IsosurfaceLevel& level, int k, Lanes low, Lanes high, unsigned inside,
                  unsigned lanes) {
    const LaneTag d;
    const LaneMask in_low = lanes_of(inside);
    constexpr int halvings = 14;
    for (int i = 0; i < halvings; ++i) {
      const Lanes z = hn::Mul(hn::Set(d, 0.5f), hn::Add(low, high));
      const LaneMask in = hn::Gt(along_.evaluate(k, z).value, hn::Set(d, level.value));
      const LaneMask as_low = hn::Not(hn::Xor(in, in_low));
      low = hn::IfThenElse(as_low, z, low);
      high = hn::IfThenElse(as_low, high, z);
    }
    return finish(level, k, hn::Mul(hn::Set(d, 0.5f), hn::Add(low, high)), lanes,
                  [inside](std::size_t l, const Vector3d& gradient) {
                    return (inside >> l & 1) != 0 ? gradient : -gradient;
                  });
  }

  /// Adds the crossings of lanes at depths z to the hits, but for those that are clipped away.
  /// to_side(lane, gradient): at right angles to the surface, to the side that the ray comes from.
  template <class ToSide>
  unsigned finish(const IsosurfaceLevel& level, int k, Lanes z, unsigned lanes, ToSide&& to_side) {
    const LaneTag d;
    const GradientAndColor at = along_.gradient_and_color(level, k, z);
    alignas(64) float depths[max_lanes], gradients[3][max_lanes], colors[3][max_lanes],
        weights[max_lanes];
    hn::Store(z, d, depths);
    for (int i = 0; i < 3; ++i) hn::Store(at.gradient[i], d, gradients[i]);
    for (int i = 0; i < 3; ++i) hn::Store(at.color[i], d, colors[i]);
    hn::Store(at.weight, d, weights);
    unsigned kept = 0;
    for (unsigned bits = lanes; bits != 0; bits &= bits - 1) {
      const auto l = static_cast<std::size_t>(__builtin_ctz(bits));
      IsosurfaceHit hit{packet_->ray[l], level.number, level.opacity, 0, {}, level.colors[0]};
      hit.depth = along_.slab().reference_depth + static_cast<double>(depths[l]);
      if (is_clipped(l, hit.depth)) continue;
      kept |= 1u << l;
      const Vector3d gradient{gradients[0][l], gradients[1][l], gradients[2][l]};
      hit.normal = normal_of(l, to_side(l, gradient));
      const float weight = weights[l];
      if (level.colors.size() > 1 && weight > 0) {
        hit.color = {colors[0][l] / weight, colors[1][l] / weight, colors[2][l] / weight};
      }
      out_.push_back(hit);
    }
    return kept;
  }

  Vector3d to_world(double x, double y, double z) const {
    const CameraAxes& axes = frame_.view.axes;
    return x * axes.x + y * axes.y + z * axes.forward;
  }

  bool is_clipped(std::size_t lane, double depth) const {
    const RayPacket& rays = packet_->rays;
    const Point3d p =
        frame_.view.eye + to_world(rays.origin_x[lane] + depth * rays.direction_x[lane],
                                   rays.origin_y[lane] + depth * rays.direction_y[lane], depth);
    return motes::is_clipped(frame_, p);
  }

  /// Along a vector in camera axes that points to the side from which the ray comes; against the
  /// ray where it is 0. (Which side that is the crossing tells: a grid's gradient is not quite at
  /// right angles to the surface, and seen from the side its angle to the ray may be of either
  /// sign.)
  Normal3f normal_of(std::size_t lane, const Vector3d& to_side) const {
    const Vector3d ray{packet_->rays.direction_x[lane], packet_->rays.direction_y[lane], 1};
    const double square = dot(to_side, to_side);
    const Vector3d normal = square > 0 ? to_side / std::sqrt(square) : -normalize(ray);
    const Vector3d world = to_world(normal.x, normal.y, normal.z);
    return {static_cast<float>(world.x), static_cast<float>(world.y), static_cast<float>(world.z)};
  }

  const IsosurfaceFrame& frame_;
  const FieldIsosurfaces& field_;
  std::vector<IsosurfaceHit>& out_;
  Field along_;
  MarchPacket* packet_ = nullptr;
  alignas(64) float values_[max_frame_planes][max_lanes], slopes_[max_frame_planes][max_lanes];
};

}  // namespace HWY_NAMESPACE
}  // namespace motes
HWY_AFTER_NAMESPACE();

#endif
