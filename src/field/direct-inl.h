// The direct method (Knoll et al. 2014, section 3.3): at each sample the kernels that overlap it
// are found through the tree, then summed. Included once per instruction set.
#if defined(MOTES_FIELD_DIRECT_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MOTES_FIELD_DIRECT_INL_H_
#undef MOTES_FIELD_DIRECT_INL_H_
#else
#define MOTES_FIELD_DIRECT_INL_H_
#endif

#include <hwy/highway.h>

#include <cstdint>

#include "field/coherent-inl.h"
#include "field/sampling-inl.h"
#include "samples/samples.h"

HWY_BEFORE_NAMESPACE();
namespace motes {
namespace HWY_NAMESPACE {

/// Fills `buffer` (all zero before) as sample_coherent() does, but with a search of the tree for
/// every plane of samples. Returns kernel evaluations.
template <bool kGradients, bool kAbsolute>
HWY_NOINLINE std::uint64_t sample_direct(const KernelSet& kernels,
                                         const SamplingConstants& constants, const View& view,
                                         const RayPacket& packet, const Slab& slab,
                                         SampleBuffer& buffer) {
  std::uint64_t evaluations = 0;
  for (int k = 0; k < slab.count; ++k) {
    const PacketFrame frame = make_packet_frame(packet, {slab.first + k, 1}, view);
    traverse(
        kernels.bvh,
        [&](const Bvh::Node& node) {
          return node_hits(node, frame.slab, frame.frustum, constants.max_support_factor);
        },
        [&](std::size_t leaf) {
          evaluations +=
              accumulate_leaf<kGradients, kAbsolute>(kernels, constants, leaf, frame, k, buffer);
        });
  }
  return evaluations;
}

}  // namespace HWY_NAMESPACE
}  // namespace motes
HWY_AFTER_NAMESPACE();

#endif
