// The kernels of one field that reach some rays in a slab, and their sums at points of these rays.
// Included once per instruction set.
#if defined(MOTES_ISOSURFACE_LOCAL_KERNELS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MOTES_ISOSURFACE_LOCAL_KERNELS_INL_H_
#undef MOTES_ISOSURFACE_LOCAL_KERNELS_INL_H_
#else
#define MOTES_ISOSURFACE_LOCAL_KERNELS_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/aligned.h"
#include "field/sampling-inl.h"
#include "field/shapes-inl.h"
#include "samples/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace motes {
namespace HWY_NAMESPACE {

/// Kernels placed in a slab's frame, in the tree's order.
struct LocalKernels {
  AlignedVector<float> x, y, z, support;
  AlignedVector<float> scale;        ///< of squared distances, as the kernels' shape takes them
  AlignedVector<float> peak, steep;  ///< kappa * weight, and that over the squared radius
  std::vector<std::uint32_t> kernel;
  std::size_t size = 0;

  /// Makes room for `count` more and for what a vector reads beyond them.
  void reserve(std::size_t count) {
    if (size + count + max_lanes <= x.size()) return;
    const std::size_t room = 2 * (size + count + max_lanes);
    for (auto* array : {&x, &y, &z, &support, &scale, &peak, &steep}) array->resize(room);
    kernel.resize(room);
  }
};

/// Depth of a slab's plane k relative to its reference.
inline float plane_depth(const SlabFrame& slab, int k) {
  return slab.first_depth + static_cast<float>(k) * slab.step;
}

/// Planes of a slab between which kernels can reach into a frustum: first and last are whole
/// numbers that enclose what they reach, so that all of it lies between planes that they have.
template <class D>
HWY_INLINE PlaneRange<D> enclosing_planes(D d, const SlabFrame& frame, const Frustum& frustum,
                                          const Centers<hn::Vec<D>>& centers, hn::Vec<D> support) {
  using V = hn::Vec<D>;
  const V inverse_step = hn::Set(d, 1.0f / frame.step);
  const V rounding = hn::Set(d, 1e-4f + 1e-6f * static_cast<float>(frame.count));
  const V middle = hn::Mul(hn::Sub(centers.z, hn::Set(d, frame.first_depth)), inverse_step);
  const V planes = hn::MulAdd(support, inverse_step, rounding);
  const V last_plane = hn::Set(d, static_cast<float>(frame.count - 1));
  const V first = hn::Max(hn::Zero(d), hn::Floor(hn::Sub(middle, planes)));
  const V last = hn::Min(last_plane, hn::Ceil(hn::Add(middle, planes)));
  const auto near = hn::Le(side_distance_sq(d, frustum, centers), hn::Mul(support, support));
  return {first, last, hn::And(near, hn::Le(first, last))};
}

/// Finds the kernels of field f that reach `frustum`.
HWY_NOINLINE void gather_field(const KernelSet& kernels, const SamplingConstants& constants,
                               std::size_t f, const SlabFrame& frame, const Frustum& frustum,
                               LocalKernels& out) {
  const LaneTag d;
  const FieldConstants& field = constants.fields[f];
  float distance_scale = 1;
  with_shape(constants, f, [&](const auto& shape) { distance_scale = shape.distance_scale; });
  out.size = 0;
  const auto add_leaf = [&](std::size_t leaf) HWY_ATTR {
    out.reserve(Bvh::leaf_size);
    for (std::size_t i = 0; i < Bvh::leaf_size; i += hn::Lanes(d)) {
      const std::size_t at = leaf * Bvh::leaf_size + i;
      const Centers<Lanes> centers = place_centers(d, kernels, at, frame);
      const Lanes support =
          hn::Mul(hn::Load(d, kernels.radius.from(at)), hn::Set(d, field.support_factor));
      unsigned bits = mask_bits(d, enclosing_planes(d, frame, frustum, centers, support).any);
      if (bits == 0) continue;
      alignas(64) float places[3][max_lanes];
      hn::Store(centers.x, d, places[0]);
      hn::Store(centers.y, d, places[1]);
      hn::Store(centers.z, d, places[2]);
      for (; bits != 0; bits &= bits - 1) {
        const auto lane = static_cast<std::size_t>(__builtin_ctz(bits));
        const std::size_t kernel = at + lane;
        if (kernel >= kernels.size() || kernels.field_of(kernel) != f) continue;
        const float radius = kernels.radius[kernel];
        out.x[out.size] = places[0][lane];
        out.y[out.size] = places[1][lane];
        out.z[out.size] = places[2][lane];
        out.support[out.size] = field.support_factor * radius;
        out.scale[out.size] = distance_scale / (radius * radius);
        out.peak[out.size] = field.peak_factor * kernels.weight[kernel];
        out.steep[out.size] = out.peak[out.size] / (radius * radius);
        out.kernel[out.size] = static_cast<std::uint32_t>(kernel);
        ++out.size;
      }
    }
  };
  out.reserve(0);
  traverse(
      kernels.bvh,
      [&](const Bvh::Node& node) { return node_hits(node, frame, frustum, field.support_factor); },
      add_leaf);
  // Fills the last vector with kernels that reach nothing.
  std::fill_n(out.support.begin() + static_cast<std::ptrdiff_t>(out.size), max_lanes, -1.0f);
}

/// The points of a packet's rays at some depths, one a lane.
struct PacketPoints {
  Lanes x, y, z, direction_x, direction_y;
};

/// From a kernel's centre to the points, and the kernel there.
struct KernelAtPoints {
  Lanes x, y, z;
  RadialLanes<Lanes> phi;  ///< not times the peak
};

template <class Shape>
HWY_INLINE KernelAtPoints kernel_at(const Shape& shape, const LocalKernels& kernels, std::size_t i,
                                    const PacketPoints& points) {
  const LaneTag d;
  const Lanes x = hn::Sub(points.x, hn::Set(d, kernels.x[i]));
  const Lanes y = hn::Sub(points.y, hn::Set(d, kernels.y[i]));
  const Lanes z = hn::Sub(points.z, hn::Set(d, kernels.z[i]));
  const Lanes square = hn::MulAdd(x, x, hn::MulAdd(y, y, hn::Mul(z, z)));
  return {x, y, z, shape.template at<true>(d, hn::Mul(square, hn::Set(d, kernels.scale[i])))};
}

/// A field along rays: its value, and its derivative by the depth.
struct AlongRays {
  Lanes value, slope;
};

/// Adds kernel i to `sums`.
template <class Shape>
HWY_INLINE AlongRays add_kernel(const Shape& shape, const LocalKernels& kernels, std::size_t i,
                                const PacketPoints& points, const AlongRays& sums) {
  const LaneTag d;
  const KernelAtPoints at = kernel_at(shape, kernels, i, points);
  const Lanes along =
      hn::MulAdd(at.x, points.direction_x, hn::MulAdd(at.y, points.direction_y, at.z));
  const Lanes steepness = hn::Mul(hn::Set(d, kernels.steep[i]), at.phi.steepness);
  return {hn::MulAdd(hn::Set(d, kernels.peak[i]), at.phi.value, sums.value),
          hn::NegMulAdd(steepness, along, sums.slope)};
}

}  // namespace HWY_NAMESPACE
}  // namespace motes
HWY_AFTER_NAMESPACE();

#endif
