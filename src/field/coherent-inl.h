// The paper's algorithm (Knoll et al. 2014, sections 4.1, 4.2 and 5.3): a packet of rays traverses
// the tree once for a whole slab of samples, and every kernel that it meets is added to all samples
// of the buffer that the kernel overlaps. Included once per instruction set.
#if defined(MOTES_FIELD_COHERENT_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MOTES_FIELD_COHERENT_INL_H_
#undef MOTES_FIELD_COHERENT_INL_H_
#else
#define MOTES_FIELD_COHERENT_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <cstdint>
#include <vector>

#include "field/sampling-inl.h"
#include "field/shapes-inl.h"
#include "samples/lanes-inl.h"
#include "samples/samples.h"

HWY_BEFORE_NAMESPACE();
namespace motes {
namespace HWY_NAMESPACE {

/// A kernel as the inner loop needs it: place relative to the frame's reference, in camera axes.
struct PlacedKernel {
  float x, y, z;
  float inverse_radius_sq;
  float peak;       ///< kappa * weight, of a normalised field over the kernel's integral
  int first, last;  ///< planes of the slab, both included
};

/// Adds one kernel to the samples of planes first to last of one field. `values` is channel 0 of
/// the first plane, `stride` floats lie between planes. The distance along each ray is measured
/// from its point closest to the kernel, so that a sample costs one subtraction and two
/// multiplications before the exponential. Hot: nothing is checked.
template <bool kGradients, bool kAbsolute, class Shape>
HWY_INLINE void accumulate(const Shape& shape, const PacketFrame& frame, const PlacedKernel& kernel,
                           float* values, std::size_t stride) {
  const LaneTag d;
  using V = Lanes;
  const std::size_t lanes = hn::Lanes(d);
  const V direction_x = hn::Load(d, frame.direction_x),
          direction_y = hn::Load(d, frame.direction_y);
  const V length_sq =
      hn::MulAdd(direction_x, direction_x, hn::MulAdd(direction_y, direction_y, hn::Set(d, 1.0f)));
  const V inverse_length_sq = hn::Load(d, frame.inverse_length_sq);

  // From the kernel to the rays at depth 0 of the frame, then to their closest points at depth
  // `closest`.
  const V x = hn::Sub(hn::Load(d, frame.offset_x), hn::Set(d, kernel.x));
  const V y = hn::Sub(hn::Load(d, frame.offset_y), hn::Set(d, kernel.y));
  const V z = hn::Set(d, -kernel.z);
  const V along = hn::MulAdd(x, direction_x, hn::MulAdd(y, direction_y, z));
  const V closest = hn::Neg(hn::Mul(along, inverse_length_sq));
  const V closest_x = hn::MulAdd(closest, direction_x, x);
  const V closest_y = hn::MulAdd(closest, direction_y, y);
  const V closest_z = hn::Add(closest, z);
  const V closest_sq = hn::MulAdd(closest_x, closest_x,
                                  hn::MulAdd(closest_y, closest_y, hn::Mul(closest_z, closest_z)));

  // What the shape takes: scale (closest_sq + (depth - closest)^2 |D|^2)
  const V scale = hn::Set(d, Shape::distance_scale * kernel.inverse_radius_sq);
  const V base = hn::Mul(scale, closest_sq), along_scale = hn::Mul(scale, length_sq);
  const V peak = hn::Set(d, kernel.peak);
  const V minus_steepness = hn::Set(d, -kernel.peak * kernel.inverse_radius_sq);
  for (int k = kernel.first; k <= kernel.last; ++k, values += stride) {
    const float depth = frame.slab.first_depth + static_cast<float>(k) * frame.slab.step;
    const V s = hn::Sub(hn::Set(d, depth), closest);
    const V distance_sq = hn::MulAdd(hn::Mul(along_scale, s), s, base);
    const RadialLanes<V> radial = shape.template at<kGradients>(d, distance_sq);
    const V phi = hn::Mul(peak, radial.value);
    hn::Store(hn::Add(phi, hn::Load(d, values)), d, values);
    if constexpr (kGradients) {
      const V slope = hn::Mul(radial.steepness, minus_steepness);
      const V to_sample[3] = {hn::MulAdd(s, direction_x, closest_x),
                              hn::MulAdd(s, direction_y, closest_y), hn::Add(s, closest_z)};
      for (std::size_t i = 0; i < 3; ++i) {
        float* const gradient = values + (1 + i) * lanes;
        hn::Store(hn::MulAdd(slope, to_sample[i], hn::Load(d, gradient)), d, gradient);
      }
    }
    if constexpr (kAbsolute) {
      float* const absolute = values + (kGradients ? 4 : 1) * lanes;
      hn::Store(hn::Add(hn::Abs(phi), hn::Load(d, absolute)), d, absolute);
    }
  }
}

/// The same in a function of its own: of shapes that few scenes have.
template <bool kGradients, bool kAbsolute, class Shape>
HWY_NOINLINE void accumulate_apart(const Shape& shape, const PacketFrame& frame,
                                   const PlacedKernel& kernel, float* values, std::size_t stride) {
  accumulate<kGradients, kAbsolute>(shape, frame, kernel, values, stride);
}

/// Adds the kernels of a leaf that reach into the frame to the buffer. Returns kernel evaluations.
template <bool kGradients, bool kAbsolute>
HWY_INLINE std::uint64_t accumulate_leaf(const KernelSet& kernels,
                                         const SamplingConstants& constants, std::size_t leaf,
                                         const PacketFrame& frame, int buffer_offset,
                                         SampleBuffer& buffer) {
  LeafKernels placed;
  load_leaf(kernels, leaf, frame.slab, frame.frustum, constants.max_support_factor, placed);
  const std::size_t stride = buffer.layout().floats_per_sample();
  std::uint64_t samples = 0;
  for (unsigned bits = placed.reaches; bits != 0; bits &= bits - 1) {
    const auto i = static_cast<std::size_t>(__builtin_ctz(bits));
    const std::size_t at = leaf * Bvh::leaf_size + i;
    const std::size_t f = kernels.field_of(at);
    if (f == kernels.fields.size()) continue;  // only drawn
    const FieldConstants& field = constants.fields[f];
    const float inverse_radius_sq = 1.0f / (kernels.radius[at] * kernels.radius[at]);
    const PlacedKernel kernel{placed.x[i],
                              placed.y[i],
                              placed.z[i],
                              inverse_radius_sq,
                              field.peak_factor * kernels.weight[at],
                              static_cast<int>(placed.first[i]),
                              static_cast<int>(placed.last[i])};
    buffer.touch(buffer_offset + kernel.first, buffer_offset + kernel.last);
    float* const values = buffer.at(buffer_offset + kernel.first, static_cast<int>(f));
    // Not by a call where the kernel is what most are.
    if (HWY_LIKELY(constants.kernels[f]->kernel.shape.type == KernelType::gaussian)) {
      accumulate<kGradients, kAbsolute>(GaussianShape{field.threshold}, frame, kernel, values,
                                        stride);
    } else {
      with_shape(constants, f, [&](const auto& shape) {
        accumulate_apart<kGradients, kAbsolute>(shape, frame, kernel, values, stride);
      });
    }
    samples += static_cast<std::uint64_t>(kernel.last - kernel.first + 1);
  }
  return samples * static_cast<std::uint64_t>(frame.lanes);
}

/// Fills `buffer` (all zero before) with the fields at the samples of `packet` in `slab`. Returns
/// kernel evaluations. A long slab (the paper's single pass) is traversed once as well, but its
/// kernels are added piece by piece, each piece with a reference point of its own.
template <bool kGradients, bool kAbsolute>
HWY_NOINLINE std::uint64_t sample_coherent(const KernelSet& kernels,
                                           const SamplingConstants& constants, const View& view,
                                           const RayPacket& packet, const Slab& slab,
                                           SampleBuffer& buffer) {
  const PacketFrame frame = make_packet_frame(packet, slab, view);
  std::vector<PacketFrame> pieces;
  for (int begin = 0; slab.count > max_frame_planes && begin < slab.count;
       begin += max_frame_planes) {
    const int count = std::min(max_frame_planes, slab.count - begin);
    pieces.push_back(make_packet_frame(packet, {slab.first + begin, count}, view));
  }
  std::uint64_t evaluations = 0;
  const auto visit = [&](std::size_t leaf) {
    if (pieces.empty()) {
      evaluations +=
          accumulate_leaf<kGradients, kAbsolute>(kernels, constants, leaf, frame, 0, buffer);
      return;
    }
    LeafKernels placed;
    load_leaf(kernels, leaf, frame.slab, frame.frustum, constants.max_support_factor, placed);
    float first = static_cast<float>(slab.count), last = -1;
    for (unsigned bits = placed.reaches; bits != 0; bits &= bits - 1) {
      const int i = __builtin_ctz(bits);
      first = std::min(first, placed.first[i]);
      last = std::max(last, placed.last[i]);
    }
    for (int begin = static_cast<int>(first) / max_frame_planes * max_frame_planes;
         begin <= static_cast<int>(last); begin += max_frame_planes) {
      evaluations += accumulate_leaf<kGradients, kAbsolute>(
          kernels, constants, leaf, pieces[static_cast<std::size_t>(begin / max_frame_planes)],
          begin, buffer);
    }
  };
  traverse(
      kernels.bvh,
      [&](const Bvh::Node& node) {
        return node_hits(node, frame.slab, frame.frustum, constants.max_support_factor);
      },
      visit);
  return evaluations;
}

}  // namespace HWY_NAMESPACE
}  // namespace motes
HWY_AFTER_NAMESPACE();

#endif
