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
#include "integrate/shading.h"
#include "samples/lanes-inl.h"
#include "samples/samples.h"

HWY_BEFORE_NAMESPACE();
namespace motes {
namespace HWY_NAMESPACE {

/// The samples of a slab: [sample][field][channel][lane].
struct SlabSamples {
  const float* first;  ///< sample 0, field 0, channel 0
  std::size_t stride, field_stride;
  const float* at(int sample, std::size_t field) const {
    return first + static_cast<std::size_t>(sample) * stride + field * field_stride;
  }
};

/// Samples of a slab, at most: a bit each.
inline constexpr int max_slab = 64;

/// Samples of a slab that some ray may see, the next few.
template <std::size_t kMost>
struct SampleChunk {
  static constexpr std::size_t most = kMost;
  std::array<int, kMost> sample;
  std::size_t count = 0;

  /// Takes them out of `bits`, bit i being sample i.
  explicit SampleChunk(std::uint64_t& bits) {
    for (; count < kMost && bits != 0; bits &= bits - 1) {
      sample[count++] = std::countr_zero(bits);
    }
  }
};

/// Rays of a block on their way through a slab, samples counted from its begin.
struct BlockRays {
  Lanes first, last;
  LaneMask alive;                ///< have samples in the slab and have not ended
  Lanes color[3], transparency;  ///< so far
  Lanes highlight;               ///< light that is white, before the factor for specular light
  bool any_ended = false;

  /// Lets `rays` through a sample; what they see of it.
  HWY_INLINE Lanes pass(LaneTag, LaneMask rays, Lanes opacity) {
    const Lanes weight = hn::IfThenElseZero(rays, hn::Mul(transparency, opacity));
    transparency = hn::Sub(transparency, weight);
    return weight;
  }

  HWY_INLINE LaneMask opaque(LaneTag, Lanes least_transparency) const {
    return hn::And(alive, hn::Lt(transparency, least_transparency));
  }

  /// Adds what of a field's sample is seen: its part of what rays get, in the n-th place of `from`.
  /// Listing 1 of the paper.
  template <bool kGradients, std::size_t N>
  HWY_INLINE void add(LaneTag d, const ShadingConstants& constants, const Contributions<N>& from,
                      std::size_t n, Lanes weight) {
    if constexpr (kGradients) {
      highlight = hn::MulAdd(weight, from.light.specular[n], highlight);
      weight = hn::Mul(weight, diffuse_factor(d, constants, from.light, n));
    }
    unroll<3>([&](std::size_t i) MOTES_INLINE HWY_ATTR {
      color[i] = hn::MulAdd(weight, from.color[i][n], color[i]);
    });
  }

  /// Ends rays that are opaque enough after all fields of a sample; false if none goes on.
  HWY_INLINE bool end_opaque(LaneTag d, Lanes least_transparency, int sample) {
    const LaneMask ends = opaque(d, least_transparency);
    if (HWY_LIKELY(hn::AllFalse(d, ends))) return true;
    last = hn::IfThenElse(ends, hn::Set(d, static_cast<float>(sample)), last);
    alive = hn::AndNot(ends, alive);
    any_ended = true;
    return !hn::AllFalse(d, alive);
  }

  HWY_INLINE LaneMask alive_at(LaneTag d, int sample) const {
    const Lanes index = hn::Set(d, static_cast<float>(sample));
    return hn::And(alive, hn::And(hn::Le(first, index), hn::Le(index, last)));
  }
};

/// Composites samples of one field, one after the other, ending rays at each: false if none goes
/// on. Samples behind the chunk's are left out.
template <bool kGradients, std::size_t N>
HWY_INLINE bool composite_chunk(LaneTag d, const ShadingConstants& constants,
                                const SampleChunk<samples_at_once>& chunk,
                                const Contributions<N>& samples, bool zero_shows,
                                Lanes least_transparency, BlockRays& rays) {
  bool go_on = true;
  unroll<N>([&](std::size_t n) MOTES_INLINE HWY_ATTR {
    if (n >= chunk.count || !go_on) return;
    const LaneMask add = HWY_UNLIKELY(zero_shows) ? rays.alive_at(d, chunk.sample[n]) : rays.alive;
    const Lanes weight = rays.pass(d, add, samples.opacity[n]);
    rays.add<kGradients>(d, constants, samples, n, weight);
    go_on = rays.end_opaque(d, least_transparency, chunk.sample[n]);
  });
  return go_on;
}

/// The same for a full chunk at which every ray under way has a sample and none ends, as in most;
/// changes nothing and returns false if one does.
template <bool kGradients, std::size_t N>
HWY_INLINE bool composite_unended(LaneTag d, const ShadingConstants& constants,
                                  const Contributions<N>& samples, Lanes least_transparency,
                                  BlockRays& rays) {
  BlockRays after = rays;
  std::array<Lanes, N> weight;
  unroll<N>([&](std::size_t n) MOTES_INLINE HWY_ATTR {
    weight[n] = after.pass(d, rays.alive, samples.opacity[n]);
  });
  if (HWY_UNLIKELY(!hn::AllFalse(d, after.opaque(d, least_transparency)))) return false;
  rays.transparency = after.transparency;
  unroll<N>([&](std::size_t n) MOTES_INLINE HWY_ATTR {
    rays.add<kGradients>(d, constants, samples, n, weight[n]);
  });
  return true;
}

/// Adds the visible samples of the only field; bit i of `visible` is sample i. `zero_shows`:
/// something may be seen where there is no kernel, so that a ray's first and last sample matter;
/// else samples outside of the volume show nothing by themselves.
template <bool kGradients, bool kPlain, TableKind kKind>
HWY_INLINE void add_field(LaneTag d, const BlockShading& shading, const SlabSamples& samples,
                          bool zero_shows, std::uint64_t visible, BlockRays& rays_out) {
  BlockRays rays = rays_out;
  const ShadingConstants& constants = shading.constants;
  const Lanes least_transparency = hn::Set(d, 1 - constants.termination_opacity);
  // False if no ray goes on.
  const auto add_chunk = [&]<std::size_t N>(const SampleChunk<samples_at_once>& chunk) HWY_ATTR {
    std::array<const float*, N> channels;
    unroll<N>([&](std::size_t n) MOTES_INLINE HWY_ATTR {
      channels[n] = samples.at(chunk.sample[std::min(n, chunk.count - 1)], 0);
    });
    Contributions<N> out;
    classify<kGradients, kPlain, kKind>(d, shading, 0, channels, out);
    if (HWY_LIKELY(chunk.count == N && !zero_shows) &&
        composite_unended<kGradients>(d, constants, out, least_transparency, rays)) {
      return true;
    }
    return composite_chunk<kGradients>(d, constants, chunk, out, zero_shows, least_transparency,
                                       rays);
  };
  while (visible != 0) {
    const SampleChunk<samples_at_once> chunk(visible);
    const bool go_on = chunk.count > samples_at_once / 2
                           ? add_chunk.template operator()<samples_at_once>(chunk)
                           : add_chunk.template operator()<samples_at_once / 2>(chunk);
    if (!go_on) break;
  }
  rays_out = rays;
}

/// Of several fields each is seen at some samples: so many at once fill the batches of all. Not
/// more, since a ray may end at the first.
using FieldsChunk = SampleChunk<2 * samples_at_once>;

/// What a field adds at a sample, on its way from classification to compositing.
struct StoredContribution {
  alignas(64) float opacity[max_lanes], color[3][max_lanes];
};

/// Classifies a field at those samples of a chunk where it may be seen, into `out`, an element a
/// sample of the chunk.
template <bool kGradients, bool kPlain, TableKind kKind>
HWY_INLINE void classify_chunk(LaneTag d, const BlockShading& shading, const SlabSamples& samples,
                               std::size_t field, std::uint64_t visible, const FieldsChunk& chunk,
                               StoredContribution* out) {
  std::array<std::size_t, FieldsChunk::most> members;
  std::size_t count = 0;
  for (std::size_t n = 0; n < chunk.count; ++n) {
    members[count] = n;
    count += visible >> chunk.sample[n] & 1;
  }
  const auto classify_some = [&]<std::size_t N>(std::size_t begin) HWY_ATTR {
    std::array<const float*, N> channels;
    for (std::size_t n = 0; n < N; ++n) {
      channels[n] = samples.at(chunk.sample[members[std::min(begin + n, count - 1)]], field);
    }
    Contributions<N> some;
    classify<kGradients, kPlain, kKind>(d, shading, field, channels, some);
    for (std::size_t n = 0; n < N && begin + n < count; ++n) {
      StoredContribution& each = out[members[begin + n]];
      hn::Store(some.opacity[n], d, each.opacity);
      if constexpr (kGradients) {
        const ShadingConstants& constants = shading.constants;
        const Lanes diffuse = diffuse_factor(d, constants, some.light, n);
        const Lanes highlight = hn::Mul(hn::Set(d, constants.specular), some.light.specular[n]);
        for (auto& color : some.color) color[n] = hn::MulAdd(color[n], diffuse, highlight);
      }
      for (std::size_t i = 0; i < 3; ++i) hn::Store(some.color[i][n], d, each.color[i]);
    }
  };
  std::size_t begin = 0;
  for (; begin + 2 < count; begin += samples_at_once) {
    classify_some.template operator()<samples_at_once>(begin);
  }
  if (begin < count) classify_some.template operator()<2>(begin);
}

/// The same for several fields; bit i of visible[f] is sample i of field f.
template <bool kGradients, bool kPlain, TableKind kKind>
HWY_INLINE void add_fields(LaneTag d, const BlockShading& shading, const SlabSamples& samples,
                           bool zero_shows, const std::uint64_t* visible, BlockRays& rays_out) {
  BlockRays rays = rays_out;
  const Lanes least_transparency = hn::Set(d, 1 - shading.constants.termination_opacity);
  const std::size_t num_fields = shading.classifiers.size();
  static thread_local AlignedVector<StoredContribution> stored(max_fields * FieldsChunk::most);
  StoredContribution* const contributions = stored.data();
  std::uint64_t left = 0;
  for (std::size_t f = 0; f < num_fields; ++f) left |= visible[f];
  while (left != 0) {
    const FieldsChunk chunk(left);
    for (std::size_t f = 0; f < num_fields; ++f) {
      classify_chunk<kGradients, kPlain, kKind>(d, shading, samples, f, visible[f], chunk,
                                                contributions + f * FieldsChunk::most);
    }
    for (std::size_t n = 0; n < chunk.count; ++n) {
      const LaneMask add =
          HWY_UNLIKELY(zero_shows) ? rays.alive_at(d, chunk.sample[n]) : rays.alive;
      for (std::size_t f = 0; f < num_fields; ++f) {
        if ((visible[f] >> chunk.sample[n] & 1) == 0) continue;
        const StoredContribution& each = contributions[f * FieldsChunk::most + n];
        const Lanes weight = rays.pass(d, add, hn::Load(d, each.opacity));
        for (std::size_t i = 0; i < 3; ++i) {
          rays.color[i] = hn::MulAdd(weight, hn::Load(d, each.color[i]), rays.color[i]);
        }
      }
      if (!rays.end_opaque(d, least_transparency, chunk.sample[n])) {
        left = 0;
        break;
      }
    }
  }
  rays_out = rays;
}

template <bool kGradients, bool kPlain, TableKind kKind>
HWY_NOINLINE void add_visible(LaneTag d, const BlockShading& shading, const SlabSamples& samples,
                              bool zero_shows, const std::uint64_t* visible, BlockRays& rays) {
  if (shading.classifiers.size() == 1) {
    add_field<kGradients, kPlain, kKind>(d, shading, samples, zero_shows, visible[0], rays);
  } else {
    add_fields<kGradients, kPlain, kKind>(d, shading, samples, zero_shows, visible, rays);
  }
}

/// Pass 2 with a frame's transfer functions and lighting.
class Integrator {
 public:
  Integrator(const std::vector<Classifier>& classifiers, const ShadingConstants& constants,
             const SampleLayout& layout)
      : classifiers_(classifiers),
        constants_(constants),
        layout_(layout),
        zero_shows_(std::any_of(classifiers.begin(), classifiers.end(),
                                [](const Classifier& c) { return c.visibility.shows_zero(); })),
        add_visible_(layout.gradients ? choose<true>() : choose<false>()) {}

  /// Something may be seen where there is no kernel.
  bool zero_shows() const { return zero_shows_; }

  /// Composites the samples of `slab`, at most max_slab, into the rays' colours. Bit i of
  /// visible[f]: field f may be seen at sample i. A ray that reaches the termination opacity ends.
  /// Hot: nothing is checked.
  void run(const Slab& slab, const SlabSamples& samples, const std::uint64_t* visible,
           RayState& rays) const {
    const LaneTag d;
    const Lanes slab_first = hn::Set(d, static_cast<float>(slab.first));
    BlockRays block;
    block.first = hn::Sub(hn::Load(d, rays.first), slab_first);
    block.last = hn::Sub(hn::Load(d, rays.last), slab_first);
    block.alive = hn::And(hn::Le(block.first, hn::Set(d, static_cast<float>(slab.count - 1))),
                          hn::Ge(block.last, hn::Zero(d)));
    block.color[0] = hn::Load(d, rays.r);
    block.color[1] = hn::Load(d, rays.g);
    block.color[2] = hn::Load(d, rays.b);
    block.transparency = hn::Load(d, rays.transparency);
    block.highlight = hn::Zero(d);
    const BlockShading shading(d, classifiers_, constants_, layout_, rays);
    add_visible_(d, shading, samples, zero_shows_, visible, block);
    if (HWY_UNLIKELY(block.any_ended)) {
      rays.end = slab.first + static_cast<int>(hn::GetLane(hn::MaxOfLanes(d, block.last)));
      hn::Store(hn::Add(block.last, slab_first), d, rays.last);
    }
    const Lanes specular = hn::Set(d, constants_.specular);
    for (Lanes& each : block.color) each = hn::MulAdd(specular, block.highlight, each);
    hn::Store(block.color[0], d, rays.r);
    hn::Store(block.color[1], d, rays.g);
    hn::Store(block.color[2], d, rays.b);
    hn::Store(block.transparency, d, rays.transparency);
  }

  /// The same for any number of samples of which it is not known yet which may be seen.
  void run(const Slab& slab, SampleBuffer& buffer, RayState& rays) const {
    const LaneTag d;
    for (int begin = 0; begin < slab.count && slab.first + begin <= rays.end; begin += max_slab) {
      const int count = std::min(slab.count - begin, max_slab);
      std::uint64_t visible[max_fields] = {};
      for (std::size_t f = 0; f < classifiers_.size(); ++f) {
        for (int i = 0; i < count; ++i) {
          const Lanes values = hn::Load(d, buffer.at(begin + i, static_cast<int>(f)));
          visible[f] |= std::uint64_t{may_be_seen(d, values, classifiers_[f].visibility)} << i;
        }
      }
      run({slab.first + begin, count},
          {buffer.at(begin, 0), layout_.floats_per_sample(),
           static_cast<std::size_t>(layout_.channels() * layout_.lanes)},
          visible, rays);
    }
  }

 private:
  using AddVisible = void (*)(LaneTag, const BlockShading&, const SlabSamples&, bool,
                              const std::uint64_t*, BlockRays&);

  template <bool kGradients>
  AddVisible choose() const {
    const bool plain = is_plain(classifiers_, constants_);
    const auto of_kind = [&]<TableKind kKind>() -> AddVisible {
      return plain ? &add_visible<kGradients, true, kKind> : &add_visible<kGradients, false, kKind>;
    };
    switch (kind_of(classifiers_)) {
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

  const std::vector<Classifier>& classifiers_;
  const ShadingConstants& constants_;
  const SampleLayout layout_;
  const bool zero_shows_;
  const AddVisible add_visible_;
};

}  // namespace HWY_NAMESPACE
}  // namespace motes
HWY_AFTER_NAMESPACE();

#endif
