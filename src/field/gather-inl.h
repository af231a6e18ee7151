// The kernels that may reach some rays in a slab, found through the tree once for all of them.
// Included once per instruction set.
#if defined(MOTES_FIELD_GATHER_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MOTES_FIELD_GATHER_INL_H_
#undef MOTES_FIELD_GATHER_INL_H_
#else
#define MOTES_FIELD_GATHER_INL_H_
#endif

#include <hwy/highway.h>

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

  /// Makes room for `count` more and for what a vector writes beyond them.
  void reserve(std::size_t count) {
    if (size + count + max_lanes <= x.size()) return;
    const std::size_t room = 2 * (size + count + max_lanes);
    for (auto* array : {&x, &y, &z, &radius}) array->resize(room);
    index.resize(room);
  }
};

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
      const auto index = hn::Iota(du, static_cast<std::uint32_t>(at));
      hn::StoreU(hn::Compress(centers.x, reaches), d, out.x.data() + out.size);
      hn::StoreU(hn::Compress(centers.y, reaches), d, out.y.data() + out.size);
      hn::StoreU(hn::Compress(centers.z, reaches), d, out.z.data() + out.size);
      hn::StoreU(hn::Compress(radius, reaches), d, out.radius.data() + out.size);
      hn::StoreU(hn::Compress(index, hn::RebindMask(du, reaches)), du, out.index.data() + out.size);
      out.size += hn::CountTrue(d, reaches);
    }
  };
  traverse(
      kernels.bvh,
      [&](const Bvh::Node& node) {
        return node_hits(node, frame, frustum, constants.max_support_factor);
      },
      visit);
  // Fills the last vector with kernels that reach nothing.
  out.reserve(max_lanes);
  hn::StoreU(hn::Set(d, 1e15f), d, out.x.data() + out.size);
  hn::StoreU(hn::Zero(d), d, out.radius.data() + out.size);
}

}  // namespace HWY_NAMESPACE
}  // namespace motes
HWY_AFTER_NAMESPACE();

#endif
