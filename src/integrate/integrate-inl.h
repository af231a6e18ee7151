// Pass 2: classifies, lights and composites the samples of a buffer, front to back (Knoll et al.
// 2014, Eq. 3 and Listing 1; several fields one after the other, section 5.5). Included once per
// instruction set.
#if defined(MOTES_INTEGRATE_INTEGRATE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MOTES_INTEGRATE_INTEGRATE_INL_H_
#undef MOTES_INTEGRATE_INTEGRATE_INL_H_
#else
#define MOTES_INTEGRATE_INTEGRATE_INL_H_
#endif

#include <hwy/contrib/math/math-inl.h>
#include <hwy/highway.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <limits>
#include <vector>

#include "integrate/classifier.h"
#include "integrate/shading.h"
#include "samples/lanes-inl.h"
#include "samples/samples.h"

HWY_BEFORE_NAMESPACE();
namespace motes {
namespace HWY_NAMESPACE {

/// 1 - exp(-x) for x >= 0, relative error below 1e-7 (thin samples by the thousand must not drift).
/// `may_exceed_one`: x may.
HWY_INLINE Lanes opacity(LaneTag d, Lanes x, bool may_exceed_one) {
  // Minimax polynomial of (1 - exp(-x)) / x on [0, 1], in pairs so that the sum is not one long
  // chain.
  const auto pair = [&](float constant, float linear) HWY_ATTR {
    return hn::MulAdd(hn::Set(d, linear), x, hn::Set(d, constant));
  };
  const Lanes x2 = hn::Mul(x, x);
  const Lanes low = hn::MulAdd(pair(1.666630980e-01f, -4.164557738e-02f), x2,
                               pair(9.999999975e-01f, -4.999997703e-01f));
  const Lanes high =
      hn::MulAdd(hn::Set(d, 1.283807181e-04f), x2, pair(8.273095536e-03f, -1.298663742e-03f));
  const Lanes thin = hn::Mul(hn::MulAdd(high, hn::Mul(x2, x2), low), x);
  if (!may_exceed_one) return thin;
  const LaneMask is_thick = hn::Gt(x, hn::Set(d, 1.0f));
  if (HWY_LIKELY(hn::AllFalse(d, is_thick))) return thin;
  const Lanes thick = hn::Sub(hn::Set(d, 1.0f), hn::Exp(d, hn::Neg(hn::Min(x, hn::Set(d, 80.0f)))));
  return hn::IfThenElse(is_thick, thick, thin);
}

/// Where each lane's argument lies in a classifier's table.
struct TablePlace {
  hn::Vec<hn::RebindToSigned<LaneTag>> segment;
  Lanes fraction;  ///< of the segment, in [0, 1]: clamped at the table's ends
};

/// How a table is read: a single segment is a broadcast, a row of one or two vectors a permutation
/// (of two only with AVX-512), longer ones are gathered.
enum class TableKind { one_segment, one_vector, two_vectors, many };

/// The simplest that does for all of them.
HWY_INLINE TableKind kind_of(const std::vector<Classifier>& classifiers) {
  int most = 1;
  for (const Classifier& c : classifiers) most = std::max(most, c.num_segments);
  if (most == 1) return TableKind::one_segment;
  if (most <= num_lanes) return TableKind::one_vector;
  return HWY_TARGET <= HWY_AVX3 && most <= 2 * num_lanes ? TableKind::two_vectors : TableKind::many;
}

/// A row of the table. Known to the compiler where a row is one vector.
template <TableKind kKind>
HWY_INLINE const float* row_of(const Classifier& c, int row) {
  if constexpr (kKind >= TableKind::two_vectors) return c.row(row);
  return c.table.data() + row * max_lanes;
}

/// row[segment] of each lane.
template <TableKind kKind>
HWY_INLINE Lanes look_up(LaneTag d, const Classifier& c, int row,
                         hn::Vec<hn::RebindToSigned<LaneTag>> segment) {
  const float* const entries = row_of<kKind>(c, row);
  if constexpr (kKind == TableKind::one_segment) {
    return hn::Set(d, entries[0]);
  } else if constexpr (kKind == TableKind::one_vector) {
    return hn::TableLookupLanes(hn::Load(d, entries), hn::IndicesFromVec(d, segment));
  } else if constexpr (kKind == TableKind::two_vectors) {
#if HWY_TARGET <= HWY_AVX3
    return Lanes{_mm512_permutex2var_ps(hn::Load(d, entries).raw, segment.raw,
                                        hn::Load(d, entries + num_lanes).raw)};
#endif
  } else {
    return hn::GatherIndex(d, entries, segment);
  }
}

template <TableKind kKind>
HWY_INLINE TablePlace find_segment(LaneTag d, const Classifier& c, Lanes argument) {
  const hn::RebindToSigned<LaneTag> di;
  auto segment = hn::Zero(di);
  const float* const begins = row_of<kKind>(c, Classifier::begin);
  if (kKind != TableKind::one_segment && c.inverse_spacing > 0) {
    // Named colour maps are evenly spaced.
    const Lanes from_begin =
        hn::Mul(hn::Sub(argument, hn::Set(d, begins[0])), hn::Set(d, c.inverse_spacing));
    const Lanes place =
        hn::Min(hn::Max(from_begin, hn::Zero(d)), hn::Set(d, static_cast<float>(c.num_segments)));
    segment = hn::Min(hn::ConvertTo(di, place), hn::Set(di, c.num_segments - 1));
    return {segment, hn::Sub(place, hn::ConvertTo(d, segment))};
  }
  if (kKind != TableKind::one_segment && c.num_segments <= 2 * max_lanes) {
    for (int s = 1; s < c.num_segments; ++s) {
      const auto behind = hn::Ge(argument, hn::Set(d, begins[s]));
      segment = hn::Sub(segment, hn::VecFromMask(di, hn::RebindMask(di, behind)));
    }
  } else if constexpr (kKind == TableKind::many) {
    // Bisection: the last segment whose begin is not above the argument.
    int span = 1;
    while (span < c.num_segments) span *= 2;
    for (span /= 2; span > 0; span /= 2) {
      const auto candidate =
          hn::Min(hn::Add(segment, hn::Set(di, span)), hn::Set(di, c.num_segments - 1));
      const auto behind = hn::Ge(argument, hn::GatherIndex(d, begins, candidate));
      segment = hn::IfThenElse(hn::RebindMask(di, behind), candidate, segment);
    }
  }
  const Lanes begin = look_up<kKind>(d, c, Classifier::begin, segment);
  const Lanes inverse_width = look_up<kKind>(d, c, Classifier::inverse_width, segment);
  const Lanes fraction = hn::Mul(hn::Sub(argument, begin), inverse_width);
  return {segment, hn::Min(hn::Max(fraction, hn::Zero(d)), hn::Set(d, 1.0f))};
}

/// Red, green, blue (0 to 2) or extinction times step (3) at a place of the table.
template <TableKind kKind>
HWY_INLINE Lanes table_value(LaneTag d, const Classifier& c, int i, const TablePlace& place) {
  return hn::MulAdd(place.fraction, look_up<kKind>(d, c, Classifier::rise + i, place.segment),
                    look_up<kKind>(d, c, Classifier::base + i, place.segment));
}

/// The classifier's argument for the buffer's values. Finite also where there is no logarithm, so
/// that it lies above a Visibility::above of -infinity and a flat segment makes no NaN of it.
HWY_INLINE Lanes argument_of(LaneTag d, const Classifier& c, Lanes value) {
  if (!c.log_scale) return value;
  const Lanes tiny = hn::Set(d, std::numeric_limits<float>::min());
  const Lanes logarithm = hn::Add(hn::Log10(d, hn::Max(value, tiny)), hn::Set(d, c.log_shift));
  return hn::IfThenElse(hn::Ge(value, tiny), logarithm,
                        hn::Set(d, std::numeric_limits<float>::lowest()));
}

/// x^power for x in [0, 1], power > 0.
HWY_INLINE Lanes power_of(LaneTag d, Lanes x, float power) {
  // Whole numbers are the usual case: x^32 is five multiplications.
  const auto whole = static_cast<unsigned>(std::min(power, 1024.0f));
  if (static_cast<float>(whole) == power) {
    Lanes result = hn::Set(d, 1.0f);
    for (unsigned bits = whole; bits != 0; bits >>= 1) {
      if ((bits & 1) != 0) result = hn::Mul(result, x);
      x = hn::Mul(x, x);
    }
    return result;
  }
  const Lanes tiny = hn::Set(d, std::numeric_limits<float>::min());
  const Lanes exponent = hn::Mul(hn::Set(d, power), hn::Log(d, hn::Max(x, tiny)));
  return hn::IfThenZeroElse(hn::Lt(x, tiny), hn::Exp(d, hn::Max(exponent, hn::Set(d, -86.0f))));
}

/// 1 / sqrt(x), relative error below 4e-7; 0 for x = 0 and whatever is too small to be told from
/// it.
HWY_INLINE Lanes inverse_sqrt(LaneTag d, Lanes x) {
  const Lanes guess = hn::ApproximateReciprocalSqrt(x);
  // One step of Newton's method.
  const Lanes half = hn::Mul(hn::Mul(hn::Set(d, 0.5f), x), guess);
  const Lanes better = hn::Mul(guess, hn::NegMulAdd(half, guess, hn::Set(d, 1.5f)));
  return hn::IfThenElseZero(hn::Gt(x, hn::Set(d, 1e-36f)), better);
}

/// Light on the samples of a field: factor on the colour, and what is added to it.
struct Light {
  Lanes factor, highlight;
};

/// Two-sided Phong lighting (design of Motes, docs/field.md). `channels` is the field's channel 0;
/// `to_eye` the unit vectors towards the eye.
HWY_INLINE Light light_field(LaneTag d, const ShadingConstants& shading, const SampleLayout& layout,
                             float min_radius, const float* channels, const Lanes to_eye[3]) {
  const std::size_t lanes = hn::Lanes(d);
  Lanes g[3];
  for (std::size_t i = 0; i < 3; ++i) g[i] = hn::Load(d, channels + (1 + i) * lanes);
  const Lanes norm_sq = hn::MulAdd(g[0], g[0], hn::MulAdd(g[1], g[1], hn::Mul(g[2], g[2])));
  Lanes inverse_norm = inverse_sqrt(d, norm_sq);
  // Where kernels cancel there is no normal.
  const Lanes absolute = hn::Abs(hn::Load(
      d, channels +
             (layout.absolute ? static_cast<std::size_t>(layout.absolute_channel()) * lanes : 0)));
  const Lanes norm = hn::Mul(norm_sq, inverse_norm);
  const LaneMask has_normal =
      hn::Ge(hn::Mul(norm, hn::Set(d, min_radius)), hn::Mul(hn::Set(d, 1e-6f), absolute));
  inverse_norm = hn::IfThenElseZero(has_normal, inverse_norm);

  const auto along = [&](const Lanes v[3]) HWY_ATTR {
    const Lanes sum = hn::MulAdd(g[0], v[0], hn::MulAdd(g[1], v[1], hn::Mul(g[2], v[2])));
    return hn::Min(hn::Abs(hn::Mul(sum, inverse_norm)), hn::Set(d, 1.0f));
  };
  Lanes n_l, n_h;
  if (shading.headlight) {
    n_l = n_h = along(to_eye);
  } else {
    Lanes l[3], h[3];
    for (int i = 0; i < 3; ++i) {
      l[i] = hn::Set(d, shading.light[i]);
      h[i] = hn::Add(l[i], to_eye[i]);
    }
    const Lanes h_scale =
        inverse_sqrt(d, hn::MulAdd(h[0], h[0], hn::MulAdd(h[1], h[1], hn::Mul(h[2], h[2]))));
    for (Lanes& component : h) component = hn::Mul(component, h_scale);
    n_l = along(l);
    n_h = along(h);
  }
  return {hn::MulAdd(hn::Set(d, shading.diffuse), n_l, hn::Set(d, shading.ambient)),
          hn::Mul(hn::Set(d, shading.specular), power_of(d, n_h, shading.shininess))};
}

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

/// A field at a sample that some ray may see.
struct VisibleSample {
  std::uint16_t sample;  ///< of the slab
  std::uint16_t field;
};

/// The visible samples of the only field, one after the other.
struct OneFieldSamples {
  static constexpr bool one_field = true;
  std::uint64_t bits;  ///< bit i: sample i

  bool empty() const { return bits == 0; }
  VisibleSample front() const { return {static_cast<std::uint16_t>(std::countr_zero(bits)), 0}; }
  void pop() { bits &= bits - 1; }
  /// No other field of the sample follows.
  bool is_last_field(VisibleSample) const { return true; }
};

/// The visible samples of several fields, at each sample in their order.
struct ManyFieldsSamples {
  static constexpr bool one_field = false;
  const VisibleSample *next, *end;

  bool empty() const { return next == end; }
  VisibleSample front() const { return *next; }
  void pop() { ++next; }
  bool is_last_field(VisibleSample one) const { return empty() || next->sample != one.sample; }
};

/// Lists the samples whose bits are set, bit i of visible[f] being sample i of field f; `out` has
/// room for one more than all.
inline ManyFieldsSamples list_visible(std::size_t num_fields, const std::uint64_t* visible,
                                      VisibleSample* out) {
  std::uint64_t any = 0;
  for (std::size_t f = 0; f < num_fields; ++f) any |= visible[f];
  VisibleSample* next = out;
  for (; any != 0; any &= any - 1) {
    const int i = std::countr_zero(any);
    // Without branches, which nobody could predict.
    for (std::size_t f = 0; f < num_fields; ++f) {
      *next = {static_cast<std::uint16_t>(i), static_cast<std::uint16_t>(f)};
      next += visible[f] >> i & 1;
    }
  }
  return {out, next};
}

/// What a field adds to rays at one sample.
struct Contribution {
  Lanes opacity;
  Lanes color[3];  ///< lit; not weighted by the opacity
};

/// Colours of a block's rays so far.
struct BlockColors {
  Lanes color[3], alpha;

  /// Adds one field's part of a sample, whose opacity is 0 where there is none. Listing 1 of the
  /// paper.
  HWY_INLINE void composite(LaneTag d, Lanes sample_opacity, const Lanes* sample_color) {
    const Lanes transparency = hn::Sub(hn::Set(d, 1.0f), alpha);
    const Lanes weight = hn::Mul(transparency, sample_opacity);
    color[0] = hn::MulAdd(weight, sample_color[0], color[0]);
    color[1] = hn::MulAdd(weight, sample_color[1], color[1]);
    color[2] = hn::MulAdd(weight, sample_color[2], color[2]);
    // Not alpha + weight: rays wait for their alpha, and this is one operation less.
    alpha = hn::MulAdd(transparency, sample_opacity, alpha);
  }
};

/// Rays of a block on their way through a slab, samples counted from its begin.
struct BlockRays {
  Lanes first, last;
  bool any_ended = false;  ///< in this slab

  HWY_INLINE LaneMask live_at(Lanes index) const {
    return hn::And(hn::Le(first, index), hn::Le(index, last));
  }
  HWY_INLINE void end_at(LaneMask ends, Lanes index) {
    last = hn::IfThenElse(ends, index, last);
    any_ended = true;
  }
};

/// What a block's samples are classified and lit with.
struct BlockShading {
  const std::vector<Classifier>& classifiers;
  const ShadingConstants& constants;
  const SampleLayout& layout;
  Lanes length;
  Lanes to_eye[3];  ///< with gradients

  template <bool kGradients, TableKind kKind>
  HWY_INLINE void classify_as(LaneTag d, std::size_t field, const float* channels,
                              Contribution& out) const {
    const Classifier& c = classifiers[field];
    const Lanes argument = argument_of(d, c, hn::Load(d, channels));
    const TablePlace place = find_segment<kKind>(d, c, argument);
    const bool may_exceed_one = c.max_depth * constants.max_ray_length > 1;
    out.opacity = opacity(d, hn::Mul(table_value<kKind>(d, c, 3, place), length), may_exceed_one);
    out.color[0] = table_value<kKind>(d, c, 0, place);
    out.color[1] = table_value<kKind>(d, c, 1, place);
    out.color[2] = table_value<kKind>(d, c, 2, place);
    if constexpr (kGradients) {
      const Light light =
          light_field(d, constants, layout, constants.min_radius[field], channels, to_eye);
      for (Lanes& channel : out.color) {
        channel = hn::MulAdd(channel, light.factor, light.highlight);
      }
    }
  }
};

/// Adds the samples of a source. Each is a long chain of operations: two side by side keep the
/// processor busy.
template <bool kGradients, TableKind kKind, class Source>
HWY_INLINE void add_samples(LaneTag d, const BlockShading& shading, const SlabSamples& samples,
                            Source source, BlockRays& rays, BlockColors& colors) {
  constexpr float no_sample = std::numeric_limits<float>::max();
  const Lanes termination = hn::Set(d, shading.constants.termination_opacity);
  const auto classify = [&](VisibleSample at, Contribution& out) HWY_ATTR {
    const std::size_t field = Source::one_field ? 0 : at.field;
    shading.classify_as<kGradients, kKind>(d, field, samples.at(at.sample, field), out);
  };
  while (!source.empty()) {
    const VisibleSample one = source.front();
    source.pop();
    const bool ends_sample = source.is_last_field(one), is_pair = !source.empty();
    const VisibleSample other = is_pair ? source.front() : one;
    if (is_pair) source.pop();
    const Lanes index = hn::Set(d, static_cast<float>(one.sample));
    const Lanes other_index = hn::Set(d, is_pair ? static_cast<float>(other.sample) : no_sample);
    const LaneMask live = rays.live_at(index), other_live = rays.live_at(other_index);
    Contribution a, b;
    classify(one, a);
    classify(other, b);
    colors.composite(d, hn::IfThenElseZero(live, a.opacity), a.color);
    BlockColors both = colors;
    both.composite(d, hn::IfThenElseZero(other_live, b.opacity), b.color);
    // After all fields of a sample rays that are opaque enough end: seldom, so only if one may it
    // is asked at which of the two samples.
    const LaneMask opaque = hn::Gt(both.alpha, termination);
    if (HWY_UNLIKELY(!hn::AllFalse(d, hn::And(hn::Or(live, other_live), opaque)))) {
      LaneMask goes_on = other_live;
      if (ends_sample) {
        const LaneMask ends = hn::And(live, hn::Gt(colors.alpha, termination));
        rays.end_at(ends, index);
        goes_on = hn::AndNot(ends, other_live);
      }
      both = colors;
      both.composite(d, hn::IfThenElseZero(goes_on, b.opacity), b.color);
      if (is_pair && source.is_last_field(other)) {
        rays.end_at(hn::And(goes_on, hn::Gt(both.alpha, termination)), other_index);
      }
      const float next = source.empty() ? no_sample : static_cast<float>(source.front().sample);
      if (hn::AllFalse(d, hn::Ge(rays.last, hn::Set(d, next)))) source = {};
    }
    colors = both;
  }
}

/// Adds the samples whose bits are set, as list_visible() takes them.
template <bool kGradients, TableKind kKind>
HWY_INLINE void add_visible(LaneTag d, const BlockShading& shading, const SlabSamples& samples,
                            const std::uint64_t* visible, BlockRays& rays, BlockColors& colors) {
  const std::size_t num_fields = shading.classifiers.size();
  if (num_fields == 1) {
    add_samples<kGradients, kKind>(d, shading, samples, OneFieldSamples{visible[0]}, rays, colors);
  } else {
    VisibleSample list[max_slab * max_fields + 1];
    add_samples<kGradients, kKind>(d, shading, samples, list_visible(num_fields, visible, list),
                                   rays, colors);
  }
}

/// Composites the samples of `slab`, at most max_slab (field 0, channel 0 of its first at
/// `first_sample`), into the rays' colours. Bit i of visible[f]: field f may be seen at sample i. A
/// ray that reaches the termination opacity ends. Hot: nothing is checked.
template <bool kGradients>
HWY_NOINLINE void integrate_slab(const std::vector<Classifier>& classifiers,
                                 const ShadingConstants& constants, const Slab& slab,
                                 const SampleLayout& layout, const float* first_sample,
                                 const std::uint64_t* visible, RayState& rays) {
  const LaneTag d;
  const SlabSamples samples{first_sample, layout.floats_per_sample(),
                            static_cast<std::size_t>(layout.channels() * layout.lanes)};
  const Lanes slab_first = hn::Set(d, static_cast<float>(slab.first));
  const Lanes length = hn::Load(d, rays.length);
  BlockShading shading{classifiers, constants, layout, length, {length, length, length}};
  if constexpr (kGradients) {
    shading.to_eye[2] = hn::Div(hn::Set(d, -1.0f), length);
    shading.to_eye[0] = hn::Mul(hn::Load(d, rays.direction_x), shading.to_eye[2]);
    shading.to_eye[1] = hn::Mul(hn::Load(d, rays.direction_y), shading.to_eye[2]);
  }
  BlockRays state{hn::Sub(hn::Load(d, rays.first), slab_first),
                  hn::Sub(hn::Load(d, rays.last), slab_first)};
  BlockColors colors{{hn::Load(d, rays.r), hn::Load(d, rays.g), hn::Load(d, rays.b)},
                     hn::Load(d, rays.a)};
  const TableKind kind = kind_of(classifiers);
  if (kind == TableKind::one_segment) {
    add_visible<kGradients, TableKind::one_segment>(d, shading, samples, visible, state, colors);
  } else if (kind == TableKind::one_vector) {
    add_visible<kGradients, TableKind::one_vector>(d, shading, samples, visible, state, colors);
  } else if (kind == TableKind::two_vectors) {
    if constexpr (HWY_TARGET <= HWY_AVX3) {
      add_visible<kGradients, TableKind::two_vectors>(d, shading, samples, visible, state, colors);
    }
  } else {
    add_visible<kGradients, TableKind::many>(d, shading, samples, visible, state, colors);
  }
  if (state.any_ended) {
    rays.end = slab.first + static_cast<int>(hn::GetLane(hn::MaxOfLanes(d, state.last)));
  }
  hn::Store(colors.color[0], d, rays.r);
  hn::Store(colors.color[1], d, rays.g);
  hn::Store(colors.color[2], d, rays.b);
  hn::Store(colors.alpha, d, rays.a);
  hn::Store(hn::Add(state.last, slab_first), d, rays.last);
}

inline void integrate(const std::vector<Classifier>& classifiers, const ShadingConstants& shading,
                      const Slab& slab, const SampleLayout& layout, const float* first_sample,
                      const std::uint64_t* visible, RayState& rays) {
  if (layout.gradients) {
    integrate_slab<true>(classifiers, shading, slab, layout, first_sample, visible, rays);
  } else {
    integrate_slab<false>(classifiers, shading, slab, layout, first_sample, visible, rays);
  }
}

/// The same for any number of samples of which it is not known yet which may be seen.
inline void integrate_buffer(const std::vector<Classifier>& classifiers,
                             const ShadingConstants& shading, const Slab& slab,
                             SampleBuffer& buffer, RayState& rays) {
  const LaneTag d;
  for (int begin = 0; begin < slab.count && slab.first + begin <= rays.end; begin += max_slab) {
    const int count = std::min(slab.count - begin, max_slab);
    std::uint64_t visible[max_fields] = {};
    for (std::size_t f = 0; f < classifiers.size(); ++f) {
      for (int i = 0; i < count; ++i) {
        const Lanes values = hn::Load(d, buffer.at(begin + i, static_cast<int>(f)));
        visible[f] |= std::uint64_t{may_be_seen(d, values, classifiers[f].visibility)} << i;
      }
    }
    integrate(classifiers, shading, {slab.first + begin, count}, buffer.layout(),
              buffer.at(begin, 0), visible, rays);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace motes
HWY_AFTER_NAMESPACE();

#endif
