// Single rays in any direction: whether anything is in their way, and what they meet first. Eight
// children of a node at once, sixteen balls of a leaf. Included once per instruction set.
#if defined(MOTES_SURFACE_SINGLE_RAY_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MOTES_SURFACE_SINGLE_RAY_INL_H_
#undef MOTES_SURFACE_SINGLE_RAY_INL_H_
#else
#define MOTES_SURFACE_SINGLE_RAY_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "bvh/bvh.h"
#include "samples/lanes-inl.h"
#include "surface/shapes-inl.h"
#include "surface/surface.h"
#include "surface/trace.h"

HWY_BEFORE_NAMESPACE();
namespace motes {
namespace HWY_NAMESPACE {

/// A ray, or the part of one up to `length`, of unit direction. Internal lengths.
struct Ray {
  float high[3], low[3];  ///< the origin is high + low, to 2^-48
  float direction[3], inverse[3];
  float length;
  float slack;  ///< bound of the rounding of a box's place
  /// Hits so near to the origin, in radii, are none: they are of the same surface once more.
  float skip;
  std::uint32_t own_particle, own_stick;  ///< where it begins, and what it therefore cannot hit
};

inline Ray make_ray(const SurfacePoint& from, const Vector3d& unit_direction, double length,
                    float skip) {
  const Point3d& origin = from.place;
  Ray ray;
  double farthest = 0;
  for (int i = 0; i < 3; ++i) {
    ray.high[i] = static_cast<float>(origin[i]);
    ray.low[i] = static_cast<float>(origin[i] - static_cast<double>(ray.high[i]));
    ray.direction[i] = static_cast<float>(unit_direction[i]);
    // Along a plane: not so steep that products with coordinates overflow.
    const double d = std::max(std::abs(unit_direction[i]), 1e-18);
    ray.inverse[i] = static_cast<float>(std::copysign(1 / d, unit_direction[i]));
    farthest = std::max(farthest, std::abs(origin[i]));
  }
  ray.length = static_cast<float>(length);
  ray.slack = static_cast<float>(2e-6 * (2 + farthest));
  ray.skip = skip;
  ray.own_particle = from.particle;
  ray.own_stick = from.stick;
  return ray;
}

/// What a ray meets first, so far.
struct NearestHit {
  float distance = std::numeric_limits<float>::infinity();
  std::uint32_t particle = no_particle, stick = no_stick;
};

class RayTracer {
 public:
  explicit RayTracer(const Surface& surface) : surface_(surface), kernels_(*surface.kernels) {}

  /// Whether anything is in the ray's way. The search begins around the particle that the ray comes
  /// from, where what is in the way mostly is, and goes up the tree.
  bool occluded(const Ray& ray) {
    if (kernels_.bvh.nodes.empty()) return false;
    std::uint32_t level = leaf_level();
    std::uint32_t index = 0;
    if (ray.own_particle != no_particle) index = ray.own_particle / Bvh::leaf_size;
    if (hits_leaf(ray, index)) return true;
    while (level-- > 0) {
      const std::uint32_t from = index % Bvh::width;
      index /= Bvh::width;
      push_children(ray, level, index, ray.length, ~(1u << from));
      while (size_ != 0) {
        const Entry entry = stack_[--size_];
        if (entry.level != leaf_level()) {
          push_children(ray, entry.level, entry.index, ray.length, ~0u);
        } else if (hits_leaf(ray, entry.index)) {
          size_ = 0;
          return true;
        }
      }
    }
    return false;
  }

  NearestHit nearest(const Ray& ray) {
    NearestHit hit;
    hit.distance = ray.length;
    if (kernels_.bvh.nodes.empty()) return hit;
    push_children(ray, 0, 0, hit.distance, ~0u);
    while (size_ != 0) {
      const Entry entry = stack_[--size_];
      if (entry.near > hit.distance) continue;
      if (entry.level != leaf_level()) {
        push_children(ray, entry.level, entry.index, hit.distance, ~0u);
      } else {
        meet_leaf<false>(ray, entry.index, hit);
      }
    }
    return hit;
  }

 private:
  struct Entry {
    float near;
    std::uint32_t level, index;
  };

  std::uint32_t leaf_level() const {
    return static_cast<std::uint32_t>(kernels_.bvh.level_begin.size());
  }

  /// Puts those children in `which` on the stack that the ray meets before `length`, the nearest on
  /// top.
  void push_children(const Ray& ray, std::uint32_t level, std::uint32_t index, float length,
                     unsigned which) {
    const std::size_t node = kernels_.bvh.level_begin[level] + index;
    alignas(32) float near[Bvh::width];
    const std::size_t begin = size_;
    for (unsigned mask = meet_children(ray, node, length, near) & which; mask != 0;
         mask &= mask - 1) {
      const auto c = static_cast<std::uint32_t>(__builtin_ctz(mask));
      const Entry entry{near[c], level + 1, index * static_cast<std::uint32_t>(Bvh::width) + c};
      std::size_t i = size_++;
      for (; i > begin && stack_[i - 1].near < entry.near; --i) stack_[i] = stack_[i - 1];
      stack_[i] = entry;
    }
  }

  unsigned meet_children(const Ray& ray, std::size_t index, float length, float* nears) const {
    const hn::CappedTag<float, Bvh::width> d;
    using V = hn::Vec<decltype(d)>;
    const Bvh::Node& node = kernels_.bvh.nodes[index];
    const float* const reach = surface_.reach.of(index);
    const float* const mins[3] = {node.min_x, node.min_y, node.min_z};
    const float* const maxs[3] = {node.max_x, node.max_y, node.max_z};
    unsigned hits = 0;
    for (std::size_t c = 0; c < Bvh::width; c += hn::Lanes(d)) {
      const V reaches = hn::LoadU(d, reach + c);
      const V margin = hn::Add(reaches, hn::Set(d, ray.slack));
      V near = hn::Zero(d), far = hn::Set(d, length);
      for (int i = 0; i < 3; ++i) {
        const V origin = hn::Set(d, ray.high[i]), inverse = hn::Set(d, ray.inverse[i]);
        const V low = hn::Sub(hn::Sub(hn::Load(d, mins[i] + c), margin), origin);
        const V high = hn::Sub(hn::Add(hn::Load(d, maxs[i] + c), margin), origin);
        // By the direction and not by size, so that a child that is not there stays away.
        const bool forward = ray.inverse[i] > 0;
        near = hn::Max(near, hn::Mul(forward ? low : high, inverse));
        far = hn::Min(far, hn::Mul(forward ? high : low, inverse));
      }
      hn::Store(near, d, nears + c);
      hits |= mask_bits(d, hn::And(hn::Le(near, far), hn::Ge(reaches, hn::Zero(d)))) << c;
    }
    return hits;
  }

  bool hits_leaf(const Ray& ray, std::size_t leaf) {
    NearestHit hit;
    hit.distance = ray.length;
    return meet_leaf<true>(ray, leaf, hit);
  }

  /// The ray against a leaf's balls and sticks; kAny: any hit will do. True if there was one.
  template <bool kAny>
  bool meet_leaf(const Ray& ray, std::size_t leaf, NearestHit& hit) const {
    const std::size_t first = leaf * Bvh::leaf_size;
    const bool has_sticks = !surface_.sticks.begin.empty();
    float reach = 0;
    if (has_sticks) {
      const std::size_t node = kernels_.bvh.level_begin.back() + leaf / Bvh::width;
      reach = surface_.reach.of(node)[leaf % Bvh::width];
    }
    unsigned near = 0;
    bool any = meet_balls<kAny>(ray, first, reach, hit, near);
    if (!has_sticks) return any;
    for (; near != 0 && !(kAny && any); near &= near - 1) {
      const auto i = static_cast<std::size_t>(__builtin_ctz(near));
      any = meet_sticks<kAny>(ray, first + i, hit) || any;
    }
    return any;
  }

  /// Where the ray passes centres.
  template <class V>
  struct Passage {
    V distance;          ///< along the ray
    Vector3v<V> across;  ///< from there to the centre
  };
  template <class D, class V = hn::Vec<D>>
  HWY_INLINE static Passage<V> pass(D d, const Ray& ray, V x, V y, V z) {
    const auto from = [&](V v, int i) HWY_ATTR {
      return hn::Sub(hn::Sub(v, hn::Set(d, ray.high[i])), hn::Set(d, ray.low[i]));
    };
    const Vector3v<V> center{from(x, 0), from(y, 1), from(z, 2)};
    const Vector3v<V> direction = direction_of(d, ray);
    const V distance = dot(d, center, direction);
    return {distance, add_scaled(d, center, hn::Neg(distance), direction)};
  }
  template <class D>
  HWY_INLINE static Vector3v<hn::Vec<D>> direction_of(D d, const Ray& ray) {
    return {hn::Set(d, ray.direction[0]), hn::Set(d, ray.direction[1]),
            hn::Set(d, ray.direction[2])};
  }

  /// near: bits of the particles that the ray passes within `reach`.
  template <bool kAny>
  HWY_INLINE bool meet_balls(const Ray& ray, std::size_t first, float reach, NearestHit& hit,
                             unsigned& near) const {
    const LaneTag d;
    const std::size_t there = std::min(kernels_.size() - first, Bvh::leaf_size);
    unsigned allowed = (1u << there) - 1;
    if (ray.own_stick == no_stick && ray.own_particle - first < Bvh::leaf_size) {
      allowed &= ~(1u << (ray.own_particle - first));
    }
    bool any = false;
    for (std::size_t i = 0; i < Bvh::leaf_size; i += hn::Lanes(d)) {
      const Passage<Lanes> passage = pass(d, ray, hn::Load(d, kernels_.x.data() + first + i),
                                          hn::Load(d, kernels_.y.data() + first + i),
                                          hn::Load(d, kernels_.z.data() + first + i));
      const Lanes square = dot(d, passage.across, passage.across);
      near |= mask_bits(d, hn::Le(square, hn::Set(d, reach * reach))) << i;
      const Lanes radius = hn::Load(d, surface_.radius.from(first + i));
      const Lanes discriminant = hn::MulSub(radius, radius, square);
      const LaneMask meets =
          hn::And(hn::Ge(discriminant, hn::Zero(d)), hn::Gt(radius, hn::Zero(d)));
      if (hn::AllFalse(d, meets)) continue;
      const Lanes root = hn::Sqrt(hn::Max(discriminant, hn::Zero(d)));
      const Chord<LaneTag> chord{hn::Sub(passage.distance, root), hn::Add(passage.distance, root),
                                 meets};
      any = take<kAny>(d, ray, chord, radius, allowed >> i, hit,
                       [&](unsigned lane) {
                         hit.particle = static_cast<std::uint32_t>(first + i + lane);
                         hit.stick = no_stick;
                       }) ||
            any;
      if (kAny && any) return true;
    }
    near &= (1u << there) - 1;
    return any;
  }

  /// The ray against the sticks of a particle: few, so by few lanes.
  template <bool kAny>
  HWY_INLINE bool meet_sticks(const Ray& ray, std::size_t particle, NearestHit& hit) const {
    using D = hn::CappedTag<float, 4>;
    using V = hn::Vec<D>;
    const D d;
    const Sticks& sticks = surface_.sticks;
    const auto center = [&](const UninitializedVector<float>& array)
                            HWY_ATTR { return hn::Set(d, array[particle]); };
    const Passage<V> passage =
        pass(d, ray, center(kernels_.x), center(kernels_.y), center(kernels_.z));
    const Vector3v<V> origin{hn::Neg(passage.across.x), hn::Neg(passage.across.y),
                             hn::Neg(passage.across.z)};
    bool any = false;
    const std::size_t end = sticks.begin[particle + 1];
    for (std::size_t at = sticks.begin[particle]; at < end; at += hn::Lanes(d)) {
      const StickLanes<V> lanes = load_sticks(d, sticks, at);
      Chord<D> chord =
          meet_stick(d, origin, direction_of(d, ray), lanes.axis, lanes.length, lanes.radius);
      chord.first = hn::Add(passage.distance, chord.first);
      chord.last = hn::Add(passage.distance, chord.last);
      unsigned allowed = (1u << std::min(end - at, hn::Lanes(d))) - 1;
      if (ray.own_stick - at < hn::Lanes(d)) allowed &= ~(1u << (ray.own_stick - at));
      any = take<kAny>(d, ray, chord, lanes.radius, allowed, hit,
                       [&](unsigned lane) {
                         hit.particle = static_cast<std::uint32_t>(particle);
                         hit.stick = static_cast<std::uint32_t>(at + lane);
                       }) ||
            any;
    }
    return any;
  }

  /// The hits of the `allowed` lanes before hit.distance; set(lane) for the nearest, unless any
  /// will do. True if there are some.
  template <bool kAny, class D, class SetHit>
  HWY_INLINE static bool take(D d, const Ray& ray, const Chord<D>& chord, hn::Vec<D> radius,
                              unsigned allowed, NearestHit& hit, const SetHit& set) {
    const auto skip = hn::Mul(radius, hn::Set(d, ray.skip));
    const auto distance = hn::IfThenElse(hn::Gt(chord.first, skip), chord.first, chord.last);
    const auto hits = hn::And(
        chord.any, hn::And(hn::Gt(distance, skip), hn::Lt(distance, hn::Set(d, hit.distance))));
    unsigned bits = mask_bits(d, hits) & allowed;
    if (kAny || bits == 0) return bits != 0;
    alignas(64) float distances[max_lanes];
    hn::Store(distance, d, distances);
    for (; bits != 0; bits &= bits - 1) {
      const auto lane = static_cast<unsigned>(__builtin_ctz(bits));
      if (!(distances[lane] < hit.distance)) continue;
      hit.distance = distances[lane];
      set(lane);
    }
    return true;
  }

  const Surface& surface_;
  const KernelSet& kernels_;
  // A node pops itself before it pushes at most 8 children, so 7 a level and one remain.
  std::array<Entry, (Bvh::width - 1) * Bvh::max_levels + 1> stack_;
  std::size_t size_ = 0;
};

}  // namespace HWY_NAMESPACE
}  // namespace motes
HWY_AFTER_NAMESPACE();

#endif
