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
#include "isosurface/local_kernels-inl.h"

HWY_BEFORE_NAMESPACE();
namespace motes {
namespace HWY_NAMESPACE {

/// A packet's rays, and how far they have come.
struct MarchPacket {
  RayPacket rays;
  std::uint32_t ray[max_lanes];                          ///< number in the grid
  unsigned active = 0;                                   ///< bit l: lane l goes on
  alignas(64) float value[max_lanes], slope[max_lanes];  ///< on the last plane before the slab's
};

/// Marches packets through one slab of one field.
class SlabMarch {
 public:
  SlabMarch(const IsosurfaceFrame& frame, const SamplingConstants& constants,
            const FieldIsosurfaces& field, std::vector<IsosurfaceHit>& out)
      : frame_(frame), constants_(constants), field_(field), out_(out) {}

  /// Finds the kernels that reach `rays` in `slab`; false if there are none.
  bool enter(const RayBounds& rays, const Slab& slab, const View& view) {
    slab_ = make_slab_frame(rays, slab, view);
    gather_field(*frame_.kernels, constants_, field_.field, slab_, make_frustum(rays, slab_, view),
                 kernels_);
    return kernels_.size != 0;
  }

  void run(MarchPacket& packet, const View& view, bool first) {
    packet_ = &packet;
    place(packet, view);
    sample_planes();
    const LaneTag d;
    if (first) {
      hn::Store(hn::Load(d, values_[0]), d, packet.value);
      hn::Store(hn::Load(d, slopes_[0]), d, packet.slope);
    }
    for (int k = 1; k < slab_.count && packet.active != 0; ++k) {
      cross_interval(k);
      hn::Store(hn::Load(d, values_[k]), d, packet.value);
      hn::Store(hn::Load(d, slopes_[k]), d, packet.slope);
    }
  }

 private:
  /// Places the packet's rays in the slab's frame, and finds the kernels that reach them.
  void place(const MarchPacket& packet, const View& view) {
    const double depth = slab_.reference_depth;
    for (int l = 0; l < num_lanes; ++l) {
      const double x = packet.rays.direction_x[l], y = packet.rays.direction_y[l];
      offset_x_[l] = static_cast<float>(packet.rays.origin_x[l] + depth * x - slab_.reference_x);
      offset_y_[l] = static_cast<float>(packet.rays.origin_y[l] + depth * y - slab_.reference_y);
      direction_x_[l] = static_cast<float>(x);
      direction_y_[l] = static_cast<float>(y);
    }
    const Frustum frustum = make_frustum(bounds_of(packet.rays), slab_, view);
    const LaneTag d;
    reaching_.clear();
    for (std::size_t i = 0; i < kernels_.size; i += hn::Lanes(d)) {
      const Centers<Lanes> centers{hn::Load(d, &kernels_.x[i]), hn::Load(d, &kernels_.y[i]),
                                   hn::Load(d, &kernels_.z[i])};
      const Lanes support = hn::Load(d, &kernels_.support[i]);
      const auto planes = enclosing_planes(d, slab_, frustum, centers, support);
      unsigned bits = mask_bits(d, hn::And(planes.any, hn::Ge(support, hn::Zero(d))));
      alignas(64) float first[max_lanes], last[max_lanes];
      hn::Store(planes.first, d, first);
      hn::Store(planes.last, d, last);
      for (; bits != 0; bits &= bits - 1) {
        const auto lane = static_cast<std::size_t>(__builtin_ctz(bits));
        reaching_.push_back({static_cast<std::uint32_t>(i + lane), static_cast<int>(first[lane]),
                             static_cast<int>(last[lane])});
      }
    }
  }

  PacketPoints points_at(Lanes z) const {
    const LaneTag d;
    const Lanes x = hn::Load(d, direction_x_), y = hn::Load(d, direction_y_);
    return {hn::MulAdd(z, x, hn::Load(d, offset_x_)), hn::MulAdd(z, y, hn::Load(d, offset_y_)), z,
            x, y};
  }
  float depth_of(int k) const { return slab_.first_depth + static_cast<float>(k) * slab_.step; }

  void sample_planes() {
    const LaneTag d;
    for (int k = 0; k < slab_.count; ++k) {
      hn::Store(hn::Zero(d), d, values_[k]);
      hn::Store(hn::Zero(d), d, slopes_[k]);
    }
    with_shape(constants_, field_.field, [&](const auto& shape) HWY_ATTR {
      for (const Reaching& kernel : reaching_) {
        for (int k = kernel.first; k <= kernel.last; ++k) {
          const AlongRays sums =
              add_kernel(shape, kernels_, kernel.index, points_at(hn::Set(d, depth_of(k))),
                         {hn::Load(d, values_[k]), hn::Load(d, slopes_[k])});
          hn::Store(sums.value, d, values_[k]);
          hn::Store(sums.slope, d, slopes_[k]);
        }
      }
    });
  }

  /// The field at depths z between planes k - 1 and k.
  HWY_NOINLINE AlongRays evaluate(int k, Lanes z) const {
    const LaneTag d;
    AlongRays sums{hn::Zero(d), hn::Zero(d)};
    const PacketPoints points = points_at(z);
    with_shape(constants_, field_.field, [&](const auto& shape) HWY_ATTR {
      for (const Reaching& kernel : reaching_) {
        if (kernel.first >= k || kernel.last < k) continue;
        sums = add_kernel(shape, kernels_, kernel.index, points, sums);
      }
    });
    return sums;
  }

  /// Finds the crossings between planes k - 1 and k.
  void cross_interval(int k) {
    const LaneTag d;
    const Lanes low = hn::Set(d, depth_of(k - 1)), high = hn::Set(d, depth_of(k));
    unsigned ended = 0;
    for (const IsosurfaceLevel& level : field_.levels) {
      const Lanes value = hn::Set(d, level.value);
      const Lanes before = hn::Sub(hn::Load(d, packet_->value), value);
      const Lanes after = hn::Sub(hn::Load(d, values_[k]), value);
      const unsigned in_before = mask_bits(d, hn::Gt(before, hn::Zero(d)));
      const unsigned in_after = mask_bits(d, hn::Gt(after, hn::Zero(d)));
      unsigned hits = 0;
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

  /// Lanes whose field is on one side of the level on both planes, k - 1 and k, but on the other
  /// side where it turns between them: at depths `middle`.
  unsigned find_turns(const IsosurfaceLevel& level, int k, Lanes before, Lanes after,
                      Lanes& middle) const {
    const LaneTag d;
    const Lanes zero = hn::Zero(d), step = hn::Set(d, slab_.step);
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
    Lanes low = hn::Set(d, depth_of(k - 1)), high = hn::Set(d, depth_of(k));
    constexpr int turns = 10;
    for (int i = 0; i < turns && open != 0; ++i) {
      const Lanes z = hn::Mul(hn::Set(d, 0.5f), hn::Add(low, high));
      const AlongRays at = evaluate(k, z);
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
      const LaneMask in = hn::Gt(evaluate(k, z).value, hn::Set(d, level.value));
      const LaneMask as_low = hn::Not(hn::Xor(in, in_low));
      low = hn::IfThenElse(as_low, z, low);
      high = hn::IfThenElse(as_low, high, z);
    }
    return finish(level, k, hn::Mul(hn::Set(d, 0.5f), hn::Add(low, high)), lanes);
  }

  /// Adds the crossings of lanes at depths z to the hits, but for those that are clipped away.
  unsigned finish(const IsosurfaceLevel& level, int k, Lanes z, unsigned lanes) {
    const LaneTag d;
    Lanes gradient[3] = {hn::Zero(d), hn::Zero(d), hn::Zero(d)};
    Lanes color[4] = {hn::Zero(d), hn::Zero(d), hn::Zero(d), hn::Zero(d)};
    const PacketPoints points = points_at(z);
    with_shape(constants_, field_.field, [&](const auto& shape) HWY_ATTR {
      for (const Reaching& kernel : reaching_) {
        if (kernel.first >= k || kernel.last < k) continue;
        const std::size_t i = kernel.index;
        const KernelAtPoints at = kernel_at(shape, kernels_, i, points);
        const Lanes steepness = hn::Mul(hn::Set(d, kernels_.steep[i]), at.phi.steepness);
        gradient[0] = hn::NegMulAdd(steepness, at.x, gradient[0]);
        gradient[1] = hn::NegMulAdd(steepness, at.y, gradient[1]);
        gradient[2] = hn::NegMulAdd(steepness, at.z, gradient[2]);
        const Color& c =
            level.colors[level.colors.size() == 1 ? 0 : frame_.species[kernels_.kernel[i]]];
        const Lanes weight = hn::Abs(hn::Mul(hn::Set(d, kernels_.peak[i]), at.phi.value));
        color[0] = hn::MulAdd(weight, hn::Set(d, c.r), color[0]);
        color[1] = hn::MulAdd(weight, hn::Set(d, c.g), color[1]);
        color[2] = hn::MulAdd(weight, hn::Set(d, c.b), color[2]);
        color[3] = hn::Add(color[3], weight);
      }
    });
    alignas(64) float depths[max_lanes], gradients[3][max_lanes], colors[4][max_lanes];
    hn::Store(z, d, depths);
    for (int i = 0; i < 3; ++i) hn::Store(gradient[i], d, gradients[i]);
    for (int i = 0; i < 4; ++i) hn::Store(color[i], d, colors[i]);
    unsigned kept = 0;
    for (unsigned bits = lanes; bits != 0; bits &= bits - 1) {
      const auto l = static_cast<std::size_t>(__builtin_ctz(bits));
      IsosurfaceHit hit{packet_->ray[l], level.number, level.opacity, 0, {}, level.colors[0]};
      hit.depth = slab_.reference_depth + static_cast<double>(depths[l]);
      if (is_clipped(l, hit.depth)) continue;
      kept |= 1u << l;
      hit.normal = normal_of(l, {gradients[0][l], gradients[1][l], gradients[2][l]});
      const float weight = colors[3][l];
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
    if (frame_.clip_planes.empty()) return false;
    const RayPacket& rays = packet_->rays;
    const Vector3d p = (frame_.view.eye - Point3d{}) +
                       to_world(rays.origin_x[lane] + depth * rays.direction_x[lane],
                                rays.origin_y[lane] + depth * rays.direction_y[lane], depth);
    return std::any_of(
        frame_.clip_planes.begin(), frame_.clip_planes.end(),
        [&](const ClipPlane& plane) { return dot(plane.normal, p) > plane.distance; });
  }

  /// From a gradient in camera axes; against the ray where there is none.
  Normal3f normal_of(std::size_t lane, const Vector3d& gradient) const {
    const Vector3d ray{packet_->rays.direction_x[lane], packet_->rays.direction_y[lane], 1};
    const double square = dot(gradient, gradient);
    Vector3d normal = square > 0 ? gradient / std::sqrt(square) : -normalize(ray);
    if (dot(normal, ray) > 0) normal = -normal;
    const Vector3d world = to_world(normal.x, normal.y, normal.z);
    return {static_cast<float>(world.x), static_cast<float>(world.y), static_cast<float>(world.z)};
  }

  /// A kernel that reaches the packet between planes first and last.
  struct Reaching {
    std::uint32_t index;
    int first, last;
  };

  const IsosurfaceFrame& frame_;
  const SamplingConstants& constants_;
  const FieldIsosurfaces& field_;
  std::vector<IsosurfaceHit>& out_;
  SlabFrame slab_;
  LocalKernels kernels_;
  MarchPacket* packet_ = nullptr;
  std::vector<Reaching> reaching_;
  alignas(64) float offset_x_[max_lanes], offset_y_[max_lanes];
  alignas(64) float direction_x_[max_lanes], direction_y_[max_lanes];
  alignas(64) float values_[max_frame_planes][max_lanes], slopes_[max_frame_planes][max_lanes];
};

}  // namespace HWY_NAMESPACE
}  // namespace motes
HWY_AFTER_NAMESPACE();

#endif
