// Rays on their way through the samples of a slab. Included once per instruction set.
#if defined(MOTES_INTEGRATE_COMPOSITE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MOTES_INTEGRATE_COMPOSITE_INL_H_
#undef MOTES_INTEGRATE_COMPOSITE_INL_H_
#else
#define MOTES_INTEGRATE_COMPOSITE_INL_H_
#endif

#include <hwy/highway.h>

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

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

/// Samples of the slab's fields that some ray may see, in the order in which rays meet them.
struct SeenSamples {
  static constexpr std::size_t most = std::size_t{max_slab} * max_fields;
  struct Seen {
    std::uint8_t sample, field;
  };
  std::array<Seen, most + 1> seen;
  std::size_t count = 0;

  /// Bit i of visible[f]: field f may be seen at sample i.
  SeenSamples(const std::uint64_t* visible, std::size_t num_fields) {
    std::uint64_t left = 0;
    for (std::size_t f = 0; f < num_fields; ++f) left |= visible[f];
    for (; left != 0; left &= left - 1) {
      const int sample = std::countr_zero(left);
      for (std::size_t f = 0; f < num_fields; ++f) {
        seen[count] = {static_cast<std::uint8_t>(sample), static_cast<std::uint8_t>(f)};
        count += visible[f] >> sample & 1;
      }
    }
  }

  int sample(std::size_t i) const { return seen[i].sample; }
  std::size_t field(std::size_t i) const { return seen[i].field; }
  /// The last of the fields of its sample.
  bool ends_sample(std::size_t i) const {
    return i + 1 == count || seen[i + 1].sample != seen[i].sample;
  }
};

/// How much there is of a field from `begin` to `end` of the step of that sample, all of it 1.
HWY_INLINE Lanes share_of(LaneTag d, const FieldRange& range, Lanes sample, Lanes begin,
                          Lanes end) {
  const Lanes first = hn::Load(d, range.first), last = hn::Load(d, range.last);
  const Lanes from =
      hn::IfThenElse(hn::Eq(sample, first), hn::Max(begin, hn::Load(d, range.enters)), begin);
  const Lanes to =
      hn::IfThenElse(hn::Eq(sample, last), hn::Min(end, hn::Load(d, range.leaves)), end);
  const LaneMask within = hn::And(hn::Le(first, sample), hn::Le(sample, last));
  return hn::IfThenElseZero(within, hn::Max(hn::Sub(to, from), hn::Zero(d)));
}

/// Rays of a block on their way through a slab, samples counted from its begin.
struct BlockRays {
  Lanes first, last;
  Lanes enters, leaves;      ///< where in their steps the first sample begins and the last ends
  const FieldRange* fields;  ///< as in RayState
  int slab_first;            ///< number of the slab's first sample
  LaneMask alive;            ///< have samples in the slab and have not ended
  Lanes color[3], alpha;     ///< so far
  Lanes highlight;           ///< light that is white, before the factor for specular light
  bool any_ended = false;

  HWY_INLINE void load_colors(LaneTag d, const RayState& rays) {
    color[0] = hn::Load(d, rays.r);
    color[1] = hn::Load(d, rays.g);
    color[2] = hn::Load(d, rays.b);
    alpha = hn::Load(d, rays.a);
    highlight = hn::Zero(d);
  }
  HWY_INLINE void load_cuts(LaneTag d, const RayState& rays, bool clipped) {
    enters = clipped ? hn::Load(d, rays.enters) : hn::Zero(d);
    leaves = clipped ? hn::Load(d, rays.leaves) : hn::Set(d, 1.0f);
  }
  HWY_INLINE void store_colors(LaneTag d, RayState& rays) const {
    hn::Store(color[0], d, rays.r);
    hn::Store(color[1], d, rays.g);
    hn::Store(color[2], d, rays.b);
    hn::Store(alpha, d, rays.a);
  }

  /// Lets `rays` through a sample; what they see of it.
  HWY_INLINE Lanes pass(LaneTag d, LaneMask rays, Lanes opacity) {
    const Lanes transparency = hn::Sub(hn::Set(d, 1.0f), alpha);
    const Lanes weight = hn::IfThenElseZero(rays, hn::Mul(transparency, opacity));
    alpha = hn::Add(alpha, weight);
    return weight;
  }

  HWY_INLINE LaneMask opaque(LaneTag, Lanes termination) const {
    return hn::And(alive, hn::Gt(alpha, termination));
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
  HWY_INLINE bool end_opaque(LaneTag d, Lanes termination, int sample) {
    const LaneMask ends = opaque(d, termination);
    if (HWY_LIKELY(hn::AllFalse(d, ends))) return true;
    last = hn::IfThenElse(ends, hn::Set(d, static_cast<float>(sample)), last);
    alive = hn::AndNot(ends, alive);
    any_ended = true;
    return !hn::AllFalse(d, alive);
  }

  /// Whether one of the slab's samples is cut by clip planes.
  HWY_INLINE bool any_cut(LaneTag d, int count) const {
    const Lanes begin = hn::Zero(d), end = hn::Set(d, static_cast<float>(count));
    const auto within = [&](Lanes sample) HWY_ATTR {
      return hn::And(alive, hn::And(hn::Ge(sample, begin), hn::Lt(sample, end)));
    };
    const LaneMask first_cut = hn::And(within(first), hn::Gt(enters, begin));
    const LaneMask last_cut = hn::And(within(last), hn::Lt(leaves, hn::Set(d, 1.0f)));
    return !hn::AllFalse(d, hn::Or(first_cut, last_cut));
  }

  /// What they have of a field from `begin` to `end` of the step of a sample, all of it 1.
  HWY_INLINE Lanes share_of_field(LaneTag d, std::size_t field, int sample, Lanes begin,
                                  Lanes end) const {
    if (fields == nullptr) return hn::Sub(end, begin);
    return share_of(d, fields[field], hn::Set(d, static_cast<float>(slab_first + sample)), begin,
                    end);
  }

  /// Whether one of the fields is not at all of the slab.
  HWY_INLINE bool any_field_lacks(LaneTag d, const Slab& slab, std::size_t num_fields) const {
    const Lanes begin = hn::Set(d, static_cast<float>(slab.first));
    const Lanes end = hn::Set(d, static_cast<float>(slab.first + slab.count));
    LaneMask all = alive;
    for (std::size_t f = 0; f < num_fields; ++f) {
      const FieldRange& range = fields[f];
      const Lanes from = hn::Add(hn::Load(d, range.first), hn::Load(d, range.enters));
      const Lanes to = hn::Add(hn::Load(d, range.last), hn::Load(d, range.leaves));
      all = hn::And(all, hn::And(hn::Le(from, begin), hn::Ge(to, end)));
    }
    return !hn::AllFalse(d, hn::AndNot(all, alive));
  }

  HWY_INLINE LaneMask alive_at(LaneTag d, int sample) const {
    const Lanes index = hn::Set(d, static_cast<float>(sample));
    return hn::And(alive, hn::And(hn::Le(first, index), hn::Le(index, last)));
  }
};

}  // namespace HWY_NAMESPACE
}  // namespace motes
HWY_AFTER_NAMESPACE();

#endif
