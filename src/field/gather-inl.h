// The kernels that may reach some rays in a slab, found through the tree once for all of them.
// Included once per instruction set.
#if defined(MOTES_FIELD_GATHER_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MOTES_FIELD_GATHER_INL_H_
#undef MOTES_FIELD_GATHER_INL_H_
#else
#define MOTES_FIELD_GATHER_INL_H_
#endif

#include <hwy/highway.h>

#include <cmath>
#include <cstddef>
#include <cstdint>

#include "core/aligned.h"
#include "field/sampling-inl.h"
#include "samples/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace motes {
namespace HWY_NAMESPACE {

/// Kernels that may reach some rays in a slab: placed in the slab's frame, in the tree's order.
struct GatheredKernels {
  AlignedVector<float> x, y, z, radius;
  AlignedVector<std::uint32_t> index;  ///< of the kernel in its set
  std::size_t size = 0;
  // What finish_kernels() adds.
  AlignedVector<float> support_sq;
  AlignedVector<float> plane_support_sq;  ///< -1 for kernels that are not summed plane by plane
  AlignedVector<float> exponent_scale;    ///< -log2(e) / (2 radius^2)
  AlignedVector<float> peak;  ///< kappa * weight, of a normalised field over the kernel's integral
  AlignedVector<float> cut;   ///< a kernel is zero where its absolute value would be less
  AlignedVector<std::uint32_t> field;

  /// Makes room for `count` more and for what a vector writes beyond them.
  void reserve(std::size_t count) {
    if (size + count + max_lanes <= x.size()) return;
    const std::size_t room = 2 * (size + count + max_lanes);
    for (auto* array :
         {&x, &y, &z, &radius, &support_sq, &plane_support_sq, &exponent_scale, &peak, &cut}) {
      array->resize(room);
    }
    for (auto* array : {&index, &field}) array->resize(room);
  }
};

/// Works out what the sweep needs of the kernels beside their places.
inline void finish_kernels(const KernelSet& kernels, const SamplingConstants& constants,
                           GatheredKernels& out) {
  for (std::size_t i = 0; i < out.size; ++i) {
    const std::size_t at = out.index[i];
    const std::size_t f = kernels.field.empty() ? 0 : kernels.field[at];
    const FieldConstants& field = constants.fields[f];
    const float radius = out.radius[i];
    const float support = field.support_factor * radius;
    out.support_sq[i] = support * support;
    out.exponent_scale[i] = -0.5f * std::numbers::log2e_v<float> / (radius * radius);
    out.peak[i] = field.peak_factor * kernels.weight[at];
    out.cut[i] = field.support_value * std::abs(out.peak[i]);
    out.field[i] = static_cast<std::uint32_t>(f);
  }
  // Fills the last vector with kernels that reach nothing.
  for (std::size_t i = out.size; i < out.size + max_lanes; ++i) out.support_sq[i] = -1;
}

/// Finds the kernels that may reach `frustum`.
HWY_NOINLINE void gather_kernels(const KernelSet& kernels, const SamplingConstants& constants,
                                 const SlabFrame& frame, const Frustum& frustum,
                                 GatheredKernels& out) {
  const LaneTag d;
  const hn::RebindToUnsigned<LaneTag> du;
  out.size = 0;
  const auto visit = [&](std::size_t leaf) HWY_ATTR {
    out.reserve(Bvh::leaf_size);
    for (std::size_t i = 0; i < Bvh::leaf_size; i += hn::Lanes(d)) {
      const std::size_t at = leaf * Bvh::leaf_size + i;
      const Centers<Lanes> centers = place_centers(d, kernels, at, frame);
      const Lanes radius = hn::Load(d, kernels.radius.from(at));
      const Lanes support = hn::Mul(radius, hn::Set(d, constants.max_support_factor));
      const LaneMask reaches = find_reach(d, frame, frustum, centers, support).any;
      const auto index = numbers_from(static_cast<std::uint32_t>(at));
      hn::StoreU(hn::Compress(centers.x, reaches), d, out.x.data() + out.size);
      hn::StoreU(hn::Compress(centers.y, reaches), d, out.y.data() + out.size);
      hn::StoreU(hn::Compress(centers.z, reaches), d, out.z.data() + out.size);
      hn::StoreU(hn::Compress(radius, reaches), d, out.radius.data() + out.size);
      hn::StoreU(hn::Compress(index, hn::RebindMask(du, reaches)), du, out.index.data() + out.size);
      out.size += hn::CountTrue(d, reaches);
    }
  };
  out.reserve(max_lanes);
  traverse(
      kernels.bvh,
      [&](const Bvh::Node& node) {
        return node_hits(node, frame, frustum, constants.max_support_factor);
      },
      visit);
  finish_kernels(kernels, constants, out);
}

}  // namespace HWY_NAMESPACE
}  // namespace motes
HWY_AFTER_NAMESPACE();

#endif
