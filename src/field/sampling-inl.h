// What the samplers share: tests of the tree's nodes and of a leaf's kernels against a packet's
// part of a slab, sixteen at a time, and the exponential. Included once per instruction set (no
// include guard of the usual kind: Highway's foreach_target includes it again for each).
#if defined(MOTES_FIELD_SAMPLING_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MOTES_FIELD_SAMPLING_INL_H_
#undef MOTES_FIELD_SAMPLING_INL_H_
#else
#define MOTES_FIELD_SAMPLING_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "bvh/bvh.h"
#include "field/kernel_set.h"
#include "field/slab_frame.h"
#include "samples/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace motes {
namespace HWY_NAMESPACE {

/// Exponents below this are cut off: 2^-125 is the least power whose mantissa stays normal.
inline constexpr float min_exponent = -125.0f;

/// Minimax polynomial of 2^f for f in [-1/2, 1/2], relative error 8e-8.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V exp2_fraction(D d, V f) {
  V p = hn::Set(d, 1.327647189e-03f);
  p = hn::MulAdd(p, f, hn::Set(d, 9.675541334e-03f));
  p = hn::MulAdd(p, f, hn::Set(d, 5.550713274e-02f));
  p = hn::MulAdd(p, f, hn::Set(d, 2.402211972e-01f));
  p = hn::MulAdd(p, f, hn::Set(d, 6.931469671e-01f));
  return hn::MulAdd(p, f, hn::Set(d, 1.000000072e+00f));
}

/// 2^x, relative error below 3e-7, for x in [min_exponent, -min_exponent]; anything outside gives
/// garbage.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V exp2_bounded(D d, V x) {
  // Adding 1.5 * 2^23 rounds to an integer n and leaves n in the low bits of the sum.
  const V shifter = hn::Set(d, 12582912.0f);
  const V sum = hn::Add(x, shifter);
  const V p = exp2_fraction(d, hn::Sub(x, hn::Sub(sum, shifter)));
  // Times 2^n: add n to the exponent.
  const hn::RebindToSigned<D> di;
  return hn::BitCast(d, hn::Add(hn::BitCast(di, p), hn::ShiftLeft<23>(hn::BitCast(di, sum))));
}

/// What the kernels of a field share, in the units of the arithmetic.
struct FieldConstants {
  float support_factor;
  float peak_factor;
  // Of Gaussians:
  float threshold;      ///< exponent (base 2) at the support radius: -sigma^2/2 log2(e)
  float support_value;  ///< 2^threshold
};

struct SamplingConstants {
  FieldConstants fields[max_fields];
  const FieldKernels* kernels[max_fields];  ///< of the fields
  float max_support_factor = 0;
  /// Fields whose kernels have one shape are a group: its number, one a field, and its first field.
  /// (That of particles that are only drawn, behind the fields, is none.)
  std::uint32_t group[max_fields + 1];
  std::uint32_t first_field[max_fields];
  std::uint32_t num_groups = 0;
  bool choose_group = false;  ///< not all particles are of group 0

  KernelType type(std::uint32_t group_number) const {
    return kernels[first_field[group_number]]->kernel.shape.type;
  }
};

/// The number of field f's group: that of an earlier field of its shape, or a new one. Each table
/// is a shape of its own.
inline std::uint32_t find_group(const SamplingConstants& constants, const FieldKernels& field) {
  const KernelType type = field.kernel.shape.type;
  std::uint32_t g = 0;
  while (g < constants.num_groups && (type == KernelType::tabulated || constants.type(g) != type)) {
    ++g;
  }
  return g;
}

inline SamplingConstants make_constants(const KernelSet& kernels) {
  SamplingConstants constants;
  for (std::size_t f = 0; f < kernels.fields.size(); ++f) {
    const double sigma = kernels.fields[f].kernel.support();
    const double threshold =
        std::max(-0.5 * sigma * sigma * std::numbers::log2e, static_cast<double>(min_exponent));
    constants.fields[f] = {static_cast<float>(sigma),
                           static_cast<float>(kernels.fields[f].peak_factor()),
                           static_cast<float>(threshold), static_cast<float>(std::exp2(threshold))};
    constants.max_support_factor =
        std::max(constants.max_support_factor, static_cast<float>(sigma));
    constants.kernels[f] = &kernels.fields[f];
    constants.group[f] = find_group(constants, kernels.fields[f]);
    if (constants.group[f] == constants.num_groups) {
      constants.first_field[constants.num_groups++] = static_cast<std::uint32_t>(f);
    }
  }
  constants.group[kernels.fields.size()] = max_fields + 1;
  constants.choose_group = constants.num_groups > 1 || kernels.has_drawn_only;
  return constants;
}

/// Which children of a node may have a kernel that reaches into the frame: bit c for child c.
/// Conservative: the child's extended bounds are not wholly outside one of the frustum's planes.
HWY_INLINE unsigned node_hits(const Bvh::Node& node, const SlabFrame& frame, const Frustum& frustum,
                              float support_factor) {
  const hn::CappedTag<float, Bvh::width> d;
  using V = hn::Vec<decltype(d)>;
  const V slack = hn::Set(d, frame.slack);
  unsigned hits = 0;
  for (std::size_t c = 0; c < Bvh::width; c += hn::Lanes(d)) {
    const V reach = hn::MulAdd(hn::Set(d, support_factor), hn::Load(d, node.max_radius + c), slack);
    V outside = hn::Set(d, -1e30f);
    for (const FrustumPlane& plane : frustum.planes) {
      // The corner of the box that lies furthest inwards.
      const float* x = (plane.world[0] > 0 ? node.min_x : node.max_x) + c;
      const float* y = (plane.world[1] > 0 ? node.min_y : node.max_y) + c;
      const float* z = (plane.world[2] > 0 ? node.min_z : node.max_z) + c;
      V distance = hn::Set(d, -plane.world_offset);
      distance = hn::MulAdd(hn::Set(d, plane.world[0]), hn::Load(d, x), distance);
      distance = hn::MulAdd(hn::Set(d, plane.world[1]), hn::Load(d, y), distance);
      distance = hn::MulAdd(hn::Set(d, plane.world[2]), hn::Load(d, z), distance);
      outside = hn::Max(outside, distance);
    }
    hits |= mask_bits(d, hn::Le(outside, reach)) << c;
  }
  return hits;
}

/// v in camera axis `row` of the frame.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V to_camera(D d, const SlabFrame& frame, int row, V x, V y, V z) {
  const V sum =
      hn::MulAdd(hn::Set(d, frame.axes[row][0]), x, hn::Mul(hn::Set(d, frame.axes[row][1]), y));
  return hn::MulAdd(hn::Set(d, frame.axes[row][2]), z, sum);
}

/// How far a point lies outside a pair of opposite sides; 0 between them. `lateral` is its
/// coordinate across the sides, `n` the component of their normals along it.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V outside_sides(D d, const FrustumPlane& low, const FrustumPlane& high, float low_n,
                           float high_n, V lateral, V z) {
  const V a = hn::MulAdd(hn::Set(d, low_n), lateral,
                         hn::MulSub(hn::Set(d, low.z), z, hn::Set(d, low.offset)));
  const V b = hn::MulAdd(hn::Set(d, high_n), lateral,
                         hn::MulSub(hn::Set(d, high.z), z, hn::Set(d, high.offset)));
  return hn::Max(hn::Zero(d), hn::Max(a, b));
}

/// Centres of kernels in a frame.
template <class V>
struct Centers {
  V x, y, z;
};

/// Centres in the coordinates of the tree, placed in the frame.
template <class D, class V = hn::Vec<D>>
HWY_INLINE Centers<V> to_frame(D d, const SlabFrame& frame, V x, V y, V z) {
  V world[3] = {x, y, z};
  for (int j = 0; j < 3; ++j) {
    world[j] = hn::Sub(hn::Sub(world[j], hn::Set(d, frame.reference_high[j])),
                       hn::Set(d, frame.reference_low[j]));
  }
  return {to_camera(d, frame, 0, world[0], world[1], world[2]),
          to_camera(d, frame, 1, world[0], world[1], world[2]),
          to_camera(d, frame, 2, world[0], world[1], world[2])};
}

/// Kernels `at` to `at` + Lanes(d) - 1, placed in the frame.
template <class D, class V = hn::Vec<D>>
HWY_INLINE Centers<V> place_centers(D d, const KernelSet& kernels, std::size_t at,
                                    const SlabFrame& frame) {
  return to_frame(d, frame, hn::Load(d, kernels.x.data() + at), hn::Load(d, kernels.y.data() + at),
                  hn::Load(d, kernels.z.data() + at));
}

/// A lower bound of the squared distance of centres to the frustum's sides, exact where only one is
/// in the way.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V side_distance_sq(D d, const Frustum& frustum, const Centers<V>& centers) {
  const FrustumPlane* sides = frustum.planes;
  const V out_x =
      outside_sides(d, sides[0], sides[1], sides[0].x, sides[1].x, centers.x, centers.z);
  const V out_y =
      outside_sides(d, sides[2], sides[3], sides[2].y, sides[3].y, centers.y, centers.z);
  return hn::Mul(hn::MulAdd(out_x, out_x, hn::Mul(out_y, out_y)),
                 hn::Set(d, frustum.corner_factor));
}

/// Planes of a slab.
template <class D>
struct PlaneRange {
  hn::Vec<D> first, last;  ///< whole numbers
  hn::Mask<D> any;         ///< there are such
};

/// Those that lie at most `reach` away from depth z.
template <class D, class V = hn::Vec<D>>
HWY_INLINE PlaneRange<D> planes_within(D d, const SlabFrame& frame, V z, V reach) {
  const V inverse_step = hn::Set(d, 1.0f / frame.step);
  const V rounding = hn::Set(d, 1e-4f + 1e-6f * static_cast<float>(frame.count));  // of planes
  const V middle = hn::Mul(hn::Sub(z, hn::Set(d, frame.first_depth)), inverse_step);
  const V planes = hn::MulAdd(reach, inverse_step, rounding);
  const V last_plane = hn::Set(d, static_cast<float>(frame.count - 1));
  const V first = hn::Max(hn::Zero(d), hn::Ceil(hn::Sub(middle, planes)));
  const V last = hn::Min(last_plane, hn::Floor(hn::Add(middle, planes)));
  return {first, last, hn::Le(first, last)};
}

/// Which kernels may reach a sample within the frustum: not much more than do.
template <class D, class V = hn::Vec<D>>
HWY_INLINE hn::Mask<D> may_reach(D d, const SlabFrame& frame, const Frustum& frustum,
                                 const Centers<V>& centers, V support) {
  const V distance_sq = side_distance_sq(d, frustum, centers);
  return hn::And(hn::Le(distance_sq, hn::Mul(support, support)),
                 planes_within(d, frame, centers.z, support).any);
}

/// Which planes of the slab kernels can reach within the frustum; `any`: they may reach a sample at
/// all.
template <class D, class V = hn::Vec<D>>
HWY_INLINE PlaneRange<D> find_reach(D d, const SlabFrame& frame, const Frustum& frustum,
                                    const Centers<V>& centers, V support) {
  const V distance_sq = side_distance_sq(d, frustum, centers);
  const V support_sq = hn::Mul(support, support);
  // The samples at distance rho >= sqrt(distance_sq) from the centre, measured across the ray, lie
  // at most sqrt(R^2 - rho^2) cos + rho sin in front of it or behind.
  const V rho = hn::Sqrt(distance_sq);
  const V half_chord = hn::Sqrt(hn::Max(hn::Zero(d), hn::Sub(support_sq, distance_sq)));
  const V sine = hn::Set(d, frustum.max_sine);
  const V slanted = hn::MulAdd(half_chord, hn::Set(d, frustum.max_cosine), hn::Mul(rho, sine));
  const V reach = hn::IfThenElse(hn::Le(rho, hn::Mul(support, sine)), support, slanted);
  PlaneRange<D> planes = planes_within(d, frame, centers.z, reach);
  planes.any = hn::And(planes.any, hn::Le(distance_sq, support_sq));
  return planes;
}

/// The kernels of a leaf in a frame: where they lie, and which of them reach into the frustum.
struct LeafKernels {
  alignas(64) float x[Bvh::leaf_size], y[Bvh::leaf_size], z[Bvh::leaf_size];
  alignas(64) float first[Bvh::leaf_size],
      last[Bvh::leaf_size];  ///< planes it may reach, within the slab
  unsigned reaches;          ///< bit i: kernel i of the leaf does
};

/// Places the kernels of a leaf in the frame and culls them against the frustum.
HWY_INLINE void load_leaf(const KernelSet& kernels, std::size_t leaf, const SlabFrame& frame,
                          const Frustum& frustum, float support_factor, LeafKernels& out) {
  const hn::CappedTag<float, Bvh::leaf_size> d;
  out.reaches = 0;
  for (std::size_t i = 0; i < Bvh::leaf_size; i += hn::Lanes(d)) {
    const std::size_t at = leaf * Bvh::leaf_size + i;
    const auto centers = place_centers(d, kernels, at, frame);
    const auto support = hn::Mul(hn::Load(d, kernels.radius.from(at)), hn::Set(d, support_factor));
    const auto reach = find_reach(d, frame, frustum, centers, support);
    hn::Store(centers.x, d, out.x + i);
    hn::Store(centers.y, d, out.y + i);
    hn::Store(centers.z, d, out.z + i);
    hn::Store(reach.first, d, out.first + i);
    hn::Store(reach.last, d, out.last + i);
    out.reaches |= mask_bits(d, reach.any) << i;
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace motes
HWY_AFTER_NAMESPACE();

#endif
