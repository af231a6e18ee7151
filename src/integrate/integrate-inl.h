// Pass 2: classifies, lights and composites the samples of a buffer, front to back (Knoll et al.
// 2014, Eq. 3 and Listing 1; several fields one after the other, section 5.5). Included once per
// instruction set.
#if defined(MOTES_INTEGRATE_INTEGRATE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MOTES_INTEGRATE_INTEGRATE_INL_H_
#undef MOTES_INTEGRATE_INTEGRATE_INL_H_
#else
#define MOTES_INTEGRATE_INTEGRATE_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "integrate/classifier.h"
#include "integrate/classify-inl.h"
#include "integrate/composite-inl.h"
#include "integrate/layers-inl.h"
#include "integrate/shading.h"
#include "samples/lanes-inl.h"
#include "samples/layers.h"
#include "samples/samples.h"

HWY_BEFORE_NAMESPACE();
namespace motes {
namespace HWY_NAMESPACE {

/// Composites samples one after the other, ending rays where their opacity is enough after all
/// fields of a sample: false if none goes on. They are those from `first` on, as far as there are.
template <bool kGradients, std::size_t N>
HWY_INLINE bool composite_in_turn(LaneTag d, const FrameShading& frame, const SeenSamples& seen,
                                  std::size_t first, const Contributions<N>& samples,
                                  Lanes termination, BlockRays& rays) {
  bool go_on = true;
  unroll<N>([&](std::size_t n) MOTES_INLINE HWY_ATTR {
    if (first + n >= seen.count || !go_on) return;
    const int sample = seen.sample(first + n);
    // Samples outside of the volume mostly show nothing by themselves.
    const LaneMask add = HWY_UNLIKELY(frame.outside_shows) ? rays.alive_at(d, sample) : rays.alive;
    const Lanes weight = rays.pass(d, add, samples.opacity[n]);
    rays.add<kGradients>(d, frame.constants, samples, n, weight);
    if (seen.ends_sample(first + n)) go_on = rays.end_opaque(d, termination, sample);
  });
  return go_on;
}

/// The same if all N are there, every ray under way has a sample at each and none ends, as is most
/// often so; else changes nothing and returns false.
template <bool kGradients, std::size_t N>
HWY_INLINE bool composite_unended(LaneTag d, const FrameShading& frame,
                                  const Contributions<N>& samples, Lanes termination,
                                  BlockRays& rays) {
  BlockRays after = rays;
  std::array<Lanes, N> weight;
  unroll<N>([&](std::size_t n) MOTES_INLINE HWY_ATTR {
    weight[n] = after.pass(d, rays.alive, samples.opacity[n]);
  });
  if (HWY_UNLIKELY(!hn::AllFalse(d, after.opaque(d, termination)))) return false;
  rays.alpha = after.alpha;
  unroll<N>([&](std::size_t n) MOTES_INLINE HWY_ATTR {
    rays.add<kGradients>(d, frame.constants, samples, n, weight[n]);
  });
  return true;
}

/// Adds the samples of a slab that some ray may see. kEverywhere: fields have all of the slab, else
/// what rays.fields says.
template <bool kGradients, bool kPlain, bool kOneField, TableKind kKind, bool kEverywhere = true>
HWY_NOINLINE void add_seen(LaneTag d, const BlockShading& shading, const SlabSamples& samples,
                           const SeenSamples& seen, BlockRays& rays) {
  const FrameShading& frame = shading.frame;
  const Lanes termination = hn::Set(d, frame.constants.termination_opacity);
  // False if no ray goes on.
  const auto add_some = [&]<std::size_t N>(std::size_t first) HWY_ATTR {
    SamplesAtOnce<N> some;
    unroll<N>([&](std::size_t n) MOTES_INLINE HWY_ATTR {
      const std::size_t i = std::min(first + n, seen.count - 1);
      some.field[n] = kOneField ? 0 : seen.field(i);
      some.channels[n] = samples.at(seen.sample(i), some.field[n]);
      some.length[n] = shading.length;
      if constexpr (!kEverywhere) {
        const Lanes share =
            rays.share_of_field(d, some.field[n], seen.sample(i), hn::Zero(d), hn::Set(d, 1.0f));
        some.length[n] = hn::Mul(share, shading.length);
      }
    });
    Contributions<N> out;
    classify<kGradients, kPlain, kOneField, kKind>(d, shading, some, out);
    if (HWY_LIKELY(first + N <= seen.count && !frame.outside_shows) &&
        composite_unended<kGradients>(d, frame, out, termination, rays)) {
      return true;
    }
    return composite_in_turn<kGradients>(d, frame, seen, first, out, termination, rays);
  };
  for (std::size_t i = 0; i < seen.count; i += samples_at_once) {
    const bool go_on = seen.count - i > samples_at_once / 2
                           ? add_some.template operator()<samples_at_once>(i)
                           : add_some.template operator()<samples_at_once / 2>(i);
    if (!go_on) break;
  }
}

/// Pass 2 with a frame's transfer functions and lighting.
class Integrator {
 public:
  Integrator(const std::vector<Classifier>& classifiers, const ShadingConstants& constants,
             const SampleLayout& layout)
      : frame_(classifiers, constants, layout),
        add_seen_(layout.gradients ? choose<true>() : choose<false>()),
        add_seen_in_part_(layout.gradients
                              ? &add_seen<true, false, false, TableKind::many, false>
                              : &add_seen<false, false, false, TableKind::many, false>),
        add_seen_with_layers_(layout.gradients ? &add_seen_with_layers<true>
                                               : &add_seen_with_layers<false>) {}

  /// Something may be seen where there is no kernel.
  bool zero_shows() const { return frame_.zero_shows; }

  /// Composites the samples of `slab`, at most max_slab, into the rays' colours. Bit i of
  /// visible[f]: field f may be seen at sample i. A ray that reaches the termination opacity ends.
  /// `layers` are those in the rays' way, or null if there are none and no clip planes either. Hot:
  /// nothing is checked.
  void run(const Slab& slab, const SlabSamples& samples, const std::uint64_t* visible,
           RayState& rays, BlockLayers* layers = nullptr) const {
    const LaneTag d;
    const Lanes slab_first = hn::Set(d, static_cast<float>(slab.first));
    BlockRays block;
    block.first = hn::Sub(hn::Load(d, rays.first), slab_first);
    block.last = hn::Sub(hn::Load(d, rays.last), slab_first);
    block.alive = hn::And(hn::Le(block.first, hn::Set(d, static_cast<float>(slab.count - 1))),
                          hn::Ge(block.last, hn::Zero(d)));
    block.fields = rays.fields;
    block.slab_first = slab.first;
    block.load_colors(d, rays);
    const SeenSamples seen(visible, frame_.classifiers.size());
    const BlockShading shading(d, frame_, rays);
    block.load_cuts(d, rays, frame_.constants.clipped);
    if (layers != nullptr &&
        (any_layer_before(d, *layers, static_cast<float>(slab.first + slab.count)) ||
         block.any_cut(d, slab.count))) {
      add_seen_with_layers_(d, shading, samples, seen, *layers, block);
    } else if (rays.fields != nullptr &&
               block.any_field_lacks(d, slab, frame_.classifiers.size())) {
      add_seen_in_part_(d, shading, samples, seen, block);
    } else {
      add_seen_(d, shading, samples, seen, block);
    }
    if (HWY_UNLIKELY(block.any_ended)) {
      rays.end = slab.first + static_cast<int>(hn::GetLane(hn::MaxOfLanes(d, block.last)));
      hn::Store(hn::Add(block.last, slab_first), d, rays.last);
    }
    const Lanes specular = hn::Set(d, frame_.constants.specular);
    for (Lanes& each : block.color) each = hn::MulAdd(specular, block.highlight, each);
    block.store_colors(d, rays);
  }

  /// The same for any number of samples of which it is not known yet which may be seen.
  void run(const Slab& slab, SampleBuffer& buffer, RayState& rays,
           BlockLayers* layers = nullptr) const {
    const LaneTag d;
    const SampleLayout& layout = frame_.layout;
    for (int begin = 0; begin < slab.count && slab.first + begin <= rays.end; begin += max_slab) {
      const int count = std::min(slab.count - begin, max_slab);
      std::uint64_t visible[max_fields] = {};
      for (std::size_t f = 0; f < frame_.classifiers.size(); ++f) {
        const Visibility visibility = frame_.classifiers[f].visibility;
        for (int i = 0; i < count; ++i) {
          const Lanes values = hn::Load(d, buffer.at(begin + i, static_cast<int>(f)));
          visible[f] |= std::uint64_t{may_be_seen(d, values, visibility)} << i;
        }
      }
      run({slab.first + begin, count},
          {buffer.at(begin, 0), layout.floats_per_sample(),
           static_cast<std::size_t>(layout.channels() * layout.lanes)},
          visible, rays, layers);
    }
  }

  /// Composites the layers behind the rays' last samples.
  void finish(BlockLayers& layers, RayState& rays) const {
    const LaneTag d;
    BlockRays block;
    block.load_colors(d, rays);
    composite_rest(d, hn::Set(d, frame_.constants.termination_opacity), layers, block);
    block.store_colors(d, rays);
  }

 private:
  using AddSeen = void (*)(LaneTag, const BlockShading&, const SlabSamples&, const SeenSamples&,
                           BlockRays&);

  template <bool kGradients>
  AddSeen choose() const {
    const auto of_kind = [&]<TableKind kKind>() -> AddSeen {
      const bool plain = is_plain(frame_);
      if (frame_.classifiers.size() == 1) {
        return plain ? &add_seen<kGradients, true, true, kKind>
                     : &add_seen<kGradients, false, true, kKind>;
      }
      return plain ? &add_seen<kGradients, true, false, kKind>
                   : &add_seen<kGradients, false, false, kKind>;
    };
    switch (kind_of(frame_.classifiers)) {
      case TableKind::one_segment:
        return of_kind.template operator()<TableKind::one_segment>();
      case TableKind::one_vector:
        return of_kind.template operator()<TableKind::one_vector>();
      case TableKind::two_vectors:
        if constexpr (HWY_TARGET <= HWY_AVX3) {
          return of_kind.template operator()<TableKind::two_vectors>();
        }
        break;
      case TableKind::many:
        break;
    }
    return of_kind.template operator()<TableKind::many>();
  }

  const FrameShading frame_;
  const AddSeen add_seen_, add_seen_in_part_;
  void (*const add_seen_with_layers_)(LaneTag, const BlockShading&, const SlabSamples&,
                                      const SeenSamples&, BlockLayers&, BlockRays&);
};

}  // namespace HWY_NAMESPACE
}  // namespace motes
HWY_AFTER_NAMESPACE();

#endif
