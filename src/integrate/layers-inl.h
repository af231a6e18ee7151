// Pass 2 where surfaces are in the way: samples and layers composited in the order in which rays
// meet them. Included once per instruction set.
#if defined(MOTES_INTEGRATE_LAYERS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MOTES_INTEGRATE_LAYERS_INL_H_
#undef MOTES_INTEGRATE_LAYERS_INL_H_
#else
#define MOTES_INTEGRATE_LAYERS_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <cstddef>
#include <limits>

#include "integrate/classify-inl.h"
#include "integrate/composite-inl.h"
#include "samples/lanes-inl.h"
#include "samples/layers.h"
#include "samples/samples.h"

HWY_BEFORE_NAMESPACE();
namespace motes {
namespace HWY_NAMESPACE {

/// The layer that each ray meets next.
struct NextLayer {
  Lanes sample, fraction, opacity, color[3];

  HWY_INLINE NextLayer(LaneTag d, const BlockLayers& layers) {
    const hn::RebindToSigned<LaneTag> di;
    static_assert(max_lanes == 16);
    const auto lane = hn::BitCast(di, numbers_from(0));
    const auto place = hn::Add(hn::ShiftLeft<4>(hn::Load(di, layers.next)), lane);
    sample = hn::GatherIndex(d, layers.sample.data(), place);
    fraction = hn::GatherIndex(d, layers.fraction.data(), place);
    opacity = hn::GatherIndex(d, layers.opacity.data(), place);
    const float* const channels[] = {layers.r.data(), layers.g.data(), layers.b.data()};
    for (std::size_t i = 0; i < 3; ++i) color[i] = hn::GatherIndex(d, channels[i], place);
  }
};

/// Lets rays through the layer that they meet next; those of them that go on.
HWY_INLINE LaneMask composite_next(LaneTag d, LaneMask which, Lanes termination,
                                   const NextLayer& layer, BlockLayers& layers, BlockRays& rays) {
  const Lanes weight = rays.pass(d, which, layer.opacity);
  for (std::size_t i = 0; i < 3; ++i) {
    rays.color[i] = hn::MulAdd(weight, layer.color[i], rays.color[i]);
  }
  const hn::RebindToSigned<LaneTag> di;
  const auto one = hn::IfThenElseZero(hn::RebindMask(di, which), hn::Set(di, 1));
  hn::Store(hn::Add(hn::Load(di, layers.next), one), di, layers.next);
  return hn::And(which, hn::Le(rays.alpha, termination));
}

/// Lets rays through all layers that they meet before that sample.
HWY_INLINE void composite_before(LaneTag d, LaneMask which, Lanes sample, Lanes termination,
                                 BlockLayers& layers, BlockRays& rays) {
  for (;;) {
    const NextLayer layer(d, layers);
    const LaneMask meets = hn::And(which, hn::Lt(layer.sample, sample));
    if (hn::AllFalse(d, meets)) return;
    which = composite_next(d, meets, termination, layer, layers, rays);
  }
}

/// Composites the step of a sample from `begin` to `end`: all fields of it that may be seen, from
/// seen[i] on.
template <bool kGradients>
HWY_INLINE void composite_part(LaneTag d, const BlockShading& shading, const SlabSamples& samples,
                               const SeenSamples& seen, std::size_t i, LaneMask which, Lanes begin,
                               Lanes end, BlockRays& rays) {
  constexpr std::size_t at_once = samples_at_once / 2;
  for (bool last = false; !last; ++i) {
    last = seen.ends_sample(i);
    SamplesAtOnce<at_once> one;
    one.field.fill(seen.field(i));
    one.channels.fill(samples.at(seen.sample(i), seen.field(i)));
    one.length.fill(
        hn::Mul(rays.share_of_field(d, seen.field(i), seen.sample(i), begin, end), shading.length));
    Contributions<at_once> out;
    classify<kGradients, false, false, TableKind::many>(d, shading, one, out);
    const Lanes weight = rays.pass(d, which, out.opacity[0]);
    rays.add<kGradients>(d, shading.frame.constants, out, 0, weight);
  }
}

/// Composites what clip planes leave of a sample, seen[i] and what follows of it, with the layers
/// within its step.
template <bool kGradients>
HWY_INLINE void composite_between(LaneTag d, const BlockShading& shading,
                                  const SlabSamples& samples, const SeenSamples& seen,
                                  std::size_t i, Lanes termination, BlockLayers& layers,
                                  BlockRays& rays) {
  const Lanes sample = hn::Set(d, static_cast<float>(rays.slab_first + seen.sample(i)));
  LaneMask which = rays.alive_at(d, seen.sample(i));
  const Lanes number = hn::Set(d, static_cast<float>(seen.sample(i)));
  Lanes begin = hn::IfThenElseZero(hn::Eq(rays.first, number), rays.enters);
  const Lanes whole = hn::IfThenElse(hn::Eq(rays.last, number), rays.leaves, hn::Set(d, 1.0f));
  for (;;) {
    const NextLayer layer(d, layers);
    const LaneMask meets = hn::And(which, hn::Eq(layer.sample, sample));
    const Lanes fraction = hn::IfThenElse(meets, layer.fraction, whole);
    const Lanes end = hn::Max(begin, hn::Min(fraction, whole));
    composite_part<kGradients>(d, shading, samples, seen, i, which, begin, end, rays);
    const LaneMask go_on = hn::And(meets, hn::Le(rays.alpha, termination));
    if (hn::AllFalse(d, go_on)) return;
    which = composite_next(d, go_on, termination, layer, layers, rays);
    begin = end;
  }
}

/// Adds the samples of a slab that some ray may see, and the layers before them. As add_seen(), for
/// all tables.
template <bool kGradients>
HWY_NOINLINE void add_seen_with_layers(LaneTag d, const BlockShading& shading,
                                       const SlabSamples& samples, const SeenSamples& seen,
                                       BlockLayers& layers, BlockRays& rays) {
  const Lanes termination = hn::Set(d, shading.frame.constants.termination_opacity);
  for (std::size_t i = 0; i < seen.count; ++i) {
    if (i > 0 && !seen.ends_sample(i - 1)) continue;
    const int sample = seen.sample(i);
    const Lanes number = hn::Set(d, static_cast<float>(rays.slab_first + sample));
    composite_before(d, rays.alive_at(d, sample), number, termination, layers, rays);
    if (!rays.end_opaque(d, termination, sample - 1)) return;
    composite_between<kGradients>(d, shading, samples, seen, i, termination, layers, rays);
    if (!rays.end_opaque(d, termination, sample)) return;
  }
}

/// Lets rays through all layers that are left.
HWY_INLINE void composite_rest(LaneTag d, Lanes termination, BlockLayers& layers, BlockRays& rays) {
  composite_before(d, hn::Le(rays.alpha, termination),
                   hn::Set(d, std::numeric_limits<float>::infinity()), termination, layers, rays);
}

/// Whether a ray meets a layer before the end of the slab.
HWY_INLINE bool any_layer_before(LaneTag d, const BlockLayers& layers, float end) {
  return !hn::AllFalse(d, hn::Lt(NextLayer(d, layers).sample, hn::Set(d, end)));
}

}  // namespace HWY_NAMESPACE
}  // namespace motes
HWY_AFTER_NAMESPACE();

#endif
