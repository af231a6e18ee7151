// Classifies and lights samples, some side by side. Included once per instruction set.
#if defined(MOTES_INTEGRATE_CLASSIFY_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MOTES_INTEGRATE_CLASSIFY_INL_H_
#undef MOTES_INTEGRATE_CLASSIFY_INL_H_
#else
#define MOTES_INTEGRATE_CLASSIFY_INL_H_
#endif

#include <hwy/contrib/math/math-inl.h>
#include <hwy/highway.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "integrate/classifier.h"
#include "integrate/shading.h"
#include "samples/lanes-inl.h"
#include "samples/samples.h"
#include "samples/transpose-inl.h"

HWY_BEFORE_NAMESPACE();
namespace motes {
namespace HWY_NAMESPACE {

/// Samples that are classified side by side. Each is a long chain of operations: taken step by step
/// together they keep the processor busy. Fewer where there are half the registers.
inline constexpr int samples_at_once = HWY_TARGET <= HWY_AVX3 ? 4 : 2;

/// c[0] + c[1] x + ... for each of some x.
template <std::size_t N, std::size_t M>
HWY_INLINE std::array<Lanes, N> polynomial(LaneTag d, const float (&c)[M],
                                           const std::array<Lanes, N>& x) {
  std::array<Lanes, N> sum;
  sum.fill(hn::Set(d, c[M - 1]));
  for (std::size_t i = M - 1; i-- > 0;) {
    const Lanes coefficient = hn::Set(d, c[i]);
    unroll<N>([&](std::size_t n)
                  MOTES_INLINE HWY_ATTR { sum[n] = hn::MulAdd(sum[n], x[n], coefficient); });
  }
  return sum;
}

/// 1 - exp(-x) for x in [0, largest], relative error below 1e-7 (thin samples by the thousand must
/// not drift). kPlain: `largest` is at most 1.
template <bool kPlain, std::size_t N>
HWY_INLINE void to_opacity(LaneTag d, float largest, std::array<Lanes, N>& x) {
  // Minimax polynomials of (1 - exp(-x)) / x on [0, 1/32], [0, 1/8] and [0, 1].
  constexpr float shortest[] = {9.999999607e-01f, -4.999773329e-01f, 1.647277037e-01f};
  constexpr float shorter[] = {9.999999848e-01f, -4.999960939e-01f, 1.665098696e-01f,
                               -3.964177391e-02f};
  constexpr float longer[] = {9.999999975e-01f,  -4.999997703e-01f, 1.666630980e-01f,
                              -4.164557738e-02f, 8.273095536e-03f,  -1.298663742e-03f,
                              1.283807181e-04f};
  std::array<Lanes, N> thin = largest <= 0.03125f ? polynomial(d, shortest, x)
                              : largest <= 0.125f ? polynomial(d, shorter, x)
                                                  : polynomial(d, longer, x);
  unroll<N>([&](std::size_t n) MOTES_INLINE HWY_ATTR { thin[n] = hn::Mul(thin[n], x[n]); });
  if constexpr (!kPlain) {
    unroll<N>([&](std::size_t n) MOTES_INLINE HWY_ATTR {
      const LaneMask is_thick = hn::Gt(x[n], hn::Set(d, 1.0f));
      if (HWY_LIKELY(hn::AllFalse(d, is_thick))) return;
      const Lanes bounded = hn::Min(x[n], hn::Set(d, 80.0f));
      const Lanes thick = hn::Sub(hn::Set(d, 1.0f), hn::Exp(d, hn::Neg(bounded)));
      thin[n] = hn::IfThenElse(is_thick, thick, thin[n]);
    });
  }
  x = thin;
}

/// How a table is read: a single segment is a broadcast, a row of one or two vectors a permutation
/// (of two only with AVX-512), of longer ones the record of each lane's segment is loaded.
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
#if HWY_TARGET <= HWY_AVX3
    // Under a mask of all: g++ 12 warns of what the other form leaves open.
    return Lanes{_mm512_maskz_permutexvar_ps(0xffff, segment.raw, hn::Load(d, entries).raw)};
#else
    return hn::TableLookupLanes(hn::Load(d, entries), hn::IndicesFromVec(d, segment));
#endif
  } else if constexpr (kKind == TableKind::two_vectors) {
#if HWY_TARGET <= HWY_AVX3
    return Lanes{_mm512_permutex2var_ps(hn::Load(d, entries).raw, segment.raw,
                                        hn::Load(d, entries + num_lanes).raw)};
#endif
  } else {
    return hn::GatherIndex(d, entries, segment);
  }
}

/// Where a sample's argument lies in a classifier's table.
struct TablePlace {
  hn::Vec<hn::RebindToSigned<LaneTag>> segment;
  Lanes fraction;  ///< of the segment, in [0, 1]: clamped at the table's ends
};

/// Named colour maps are evenly spaced.
template <TableKind kKind>
HWY_INLINE TablePlace place_evenly(LaneTag d, const Classifier& c, float begin, Lanes argument) {
  const hn::RebindToSigned<LaneTag> di;
  const Lanes per_segment = hn::Set(d, c.inverse_spacing);
  const Lanes first = hn::Set(d, -begin * c.inverse_spacing);
  // Just short of the end, so that the last segment's end is no segment of its own.
  const Lanes end = hn::Set(d, static_cast<float>(c.num_segments) * (1 - 0x1p-23f));
  const Lanes from_begin = hn::MulAdd(argument, per_segment, first);
  const Lanes place = hn::Min(hn::Max(from_begin, hn::Zero(d)), end);
  // Adding 1.5 * 2^23 rounds to an integer and leaves it in the low bits of the sum.
  const Lanes shifter = hn::Set(d, 12582912.0f);
#if HWY_TARGET <= HWY_AVX3
  const Lanes sum{
      _mm512_add_round_ps(place.raw, shifter.raw, _MM_FROUND_TO_NEG_INF | _MM_FROUND_NO_EXC)};
#else
  // Half a segment less rounds down; between two segments either will do.
  const Lanes sum = hn::Add(hn::Sub(place, hn::Set(d, 0.5f)), shifter);
#endif
  auto segment = hn::BitCast(di, sum);
  // A permutation of AVX-512 reads no more than the low bits.
  if constexpr (HWY_TARGET > HWY_AVX3 || kKind == TableKind::many) {
    segment = hn::And(segment, hn::Set(di, 0xffff));
  }
  return {segment, hn::Sub(place, hn::Sub(sum, shifter))};
}

/// Bisection for long tables: the last segment whose begin is not above the argument.
HWY_INLINE hn::Vec<hn::RebindToSigned<LaneTag>> bisect(LaneTag d, const Classifier& c,
                                                       const float* begins, Lanes argument) {
  const hn::RebindToSigned<LaneTag> di;
  auto segment = hn::Zero(di);
  int span = 1;
  while (span < c.num_segments) span *= 2;
  for (span /= 2; span > 0; span /= 2) {
    const auto candidate =
        hn::Min(hn::Add(segment, hn::Set(di, span)), hn::Set(di, c.num_segments - 1));
    const auto behind = hn::Ge(argument, hn::GatherIndex(d, begins, candidate));
    segment = hn::IfThenElse(hn::RebindMask(di, behind), candidate, segment);
  }
  return segment;
}

template <TableKind kKind>
HWY_INLINE TablePlace find_segment(LaneTag d, const Classifier& c, Lanes argument) {
  const hn::RebindToSigned<LaneTag> di;
  const float* const begins = row_of<kKind>(c, Classifier::begin);
  if (kKind != TableKind::one_segment && c.inverse_spacing > 0) {
    return place_evenly<kKind>(d, c, begins[0], argument);
  }
  auto segment = hn::Zero(di);
  if (kKind != TableKind::one_segment && c.num_segments <= 2 * max_lanes) {
    for (int s = 1; s < c.num_segments; ++s) {
      const auto behind = hn::RebindMask(di, hn::Ge(argument, hn::Set(d, begins[s])));
      segment = hn::Sub(segment, hn::VecFromMask(di, behind));
    }
  } else if constexpr (kKind == TableKind::many) {
    segment = bisect(d, c, begins, argument);
  }
  const Lanes begin = look_up<kKind>(d, c, Classifier::begin, segment);
  const Lanes inverse_width = look_up<kKind>(d, c, Classifier::inverse_width, segment);
  const Lanes fraction = hn::Mul(hn::Sub(argument, begin), inverse_width);
  return {segment, hn::Min(hn::Max(fraction, hn::Zero(d)), hn::Set(d, 1.0f))};
}

/// Red, green, blue (0 to 2) or extinction times step (3) at a place of the table.
template <TableKind kKind>
HWY_INLINE Lanes read_table(LaneTag d, const Classifier& c, int i, const TablePlace& place) {
  return hn::MulAdd(place.fraction, look_up<kKind>(d, c, Classifier::rise + i, place.segment),
                    look_up<kKind>(d, c, Classifier::base + i, place.segment));
}

/// Red, green, blue and extinction times step at a place of the table.
HWY_INLINE std::array<Lanes, 4> read_record(LaneTag d, const Classifier& c,
                                            const TablePlace& place) {
  const hn::RebindToUnsigned<LaneTag> du;
  static_assert(Classifier::record_size == 8);
  std::size_t offset[num_lanes];
  extract_numbers(du, hn::BitCast(du, hn::ShiftLeft<3>(place.segment)), offset);
  std::array<Lanes, 4> base, rise;
  load_fours(d, c.records.data(), offset, base);
  load_fours(d, c.records.data() + 4, offset, rise);
  for (std::size_t i = 0; i < 4; ++i) base[i] = hn::MulAdd(place.fraction, rise[i], base[i]);
  return base;
}

/// The classifier's argument for a value of the buffer, with a logarithmic scale. Finite also where
/// there is no logarithm, so that it lies above a Visibility::above of -infinity and a flat segment
/// makes no NaN of it.
HWY_NOINLINE Lanes logarithmic_argument(LaneTag d, const Classifier& c, Lanes value) {
  const Lanes tiny = hn::Set(d, std::numeric_limits<float>::min());
  const Lanes logarithm = hn::Add(hn::Log10(d, hn::Max(value, tiny)), hn::Set(d, c.log_shift));
  return hn::IfThenElse(hn::Ge(value, tiny), logarithm,
                        hn::Set(d, std::numeric_limits<float>::lowest()));
}

/// x^power for x in [0, 1], power >= 0.
HWY_NOINLINE Lanes general_power(LaneTag d, Lanes x, float power) {
  if (power == 0) return hn::Set(d, 1.0f);
  const Lanes tiny = hn::Set(d, std::numeric_limits<float>::min());
  const Lanes exponent = hn::Mul(hn::Set(d, power), hn::Log(d, hn::Max(x, tiny)));
  return hn::IfThenZeroElse(hn::Lt(x, tiny), hn::Exp(d, hn::Max(exponent, hn::Set(d, -86.0f))));
}

/// Shininess that takes a few multiplications alone: x^32 is five.
inline bool is_plain_power(float power) {
  return power >= 1 && power <= 1024 && power == std::floor(power);
}

/// x^power for an odd power.
template <std::size_t N>
HWY_INLINE void raise_to_odd(LaneTag, unsigned power, std::array<Lanes, N>& x) {
  std::array<Lanes, N> square = x;
  for (power >>= 1; power != 0; power >>= 1) {
    unroll<N>([&](std::size_t n)
                  MOTES_INLINE HWY_ATTR { square[n] = hn::Mul(square[n], square[n]); });
    if ((power & 1) == 0) continue;
    unroll<N>([&](std::size_t n) MOTES_INLINE HWY_ATTR { x[n] = hn::Mul(x[n], square[n]); });
  }
}

/// x^power for x in [0, 1], power >= 0. kPlain: is_plain_power().
template <bool kPlain, std::size_t N>
HWY_INLINE void raise(LaneTag d, float power, std::array<Lanes, N>& x) {
  if (!kPlain && !is_plain_power(power)) {
    for (Lanes& each : x) each = general_power(d, each, power);
    return;
  }
  auto left = static_cast<unsigned>(power);
  for (; (left & 1) == 0; left >>= 1) {
    unroll<N>([&](std::size_t n) MOTES_INLINE HWY_ATTR { x[n] = hn::Mul(x[n], x[n]); });
  }
  if (HWY_UNLIKELY(left != 1)) raise_to_odd(d, left, x);
}

/// 2 / sqrt(x), relative error below 4e-7; anything for x = 0.
template <std::size_t N>
HWY_INLINE std::array<Lanes, N> twice_inverse_sqrt(LaneTag d, const std::array<Lanes, N>& x) {
  std::array<Lanes, N> root;
  unroll<N>([&](std::size_t n)
                MOTES_INLINE HWY_ATTR { root[n] = hn::ApproximateReciprocalSqrt(x[n]); });
  // One step of Newton's method.
  unroll<N>([&](std::size_t n) MOTES_INLINE HWY_ATTR {
    const Lanes square = hn::Mul(hn::Mul(x[n], root[n]), root[n]);
    root[n] = hn::Mul(root[n], hn::Sub(hn::Set(d, 3.0f), square));
  });
  return root;
}

/// What a frame's samples are classified and lit with.
struct FrameShading {
  const std::vector<Classifier>& classifiers;
  const ShadingConstants& constants;
  SampleLayout layout;
  bool zero_shows;     ///< something may be seen where there is no kernel
  bool outside_shows;  ///< so it may outside of rays' first and last samples
  float max_depth;     ///< largest optical depth of a sample
  /// Where kernels cancel there is no normal: |gradient| <= least_gradient sum |phi|; one a field.
  float least_gradient[max_fields];

  FrameShading(const std::vector<Classifier>& the_classifiers,
               const ShadingConstants& the_constants, const SampleLayout& the_layout)
      : classifiers(the_classifiers),
        constants(the_constants),
        layout(the_layout),
        zero_shows(false),
        outside_shows(the_constants.clipped),
        max_depth(0) {
    for (std::size_t f = 0; f < classifiers.size(); ++f) {
      zero_shows |= classifiers[f].visibility.shows_zero();
      outside_shows |= zero_shows;
      max_depth = std::max(max_depth, classifiers[f].max_depth * constants.max_ray_length);
      least_gradient[f] = 1e-6f / constants.min_radius[f];
    }
  }
};

/// Where a light is for a block's rays: half of the unit vectors to it, and halfway from it to the
/// eye.
struct LightVectors {
  Lanes half_to_light[3], half_halfway[3];
  bool headlight;

  HWY_INLINE void set(LaneTag d, const LightConstants& light, const Lanes half_to_eye[3]) {
    headlight = light.headlight;
    for (int i = 0; i < 3; ++i) {
      half_to_light[i] = headlight ? half_to_eye[i] : hn::Set(d, 0.5f * light.direction[i]);
      half_halfway[i] = headlight ? half_to_eye[i] : hn::Add(half_to_light[i], half_to_eye[i]);
    }
    if (headlight) return;
    const Lanes sum_sq = hn::MulAdd(
        half_halfway[0], half_halfway[0],
        hn::MulAdd(half_halfway[1], half_halfway[1], hn::Mul(half_halfway[2], half_halfway[2])));
    const Lanes scale = hn::IfThenElseZero(hn::Gt(sum_sq, hn::Set(d, 1e-36f)),
                                           hn::Div(hn::Set(d, 0.5f), hn::Sqrt(sum_sq)));
    for (Lanes& each : half_halfway) each = hn::Mul(each, scale);
  }
};

/// And a block's.
struct BlockShading {
  const FrameShading& frame;
  Lanes length;                     ///< of the rays' directions
  LightVectors lights[max_lights];  ///< with gradients; as many as constants.lights

  BlockShading(LaneTag d, const FrameShading& the_frame, const RayState& rays)
      : frame(the_frame), length(hn::Load(d, rays.length)) {
    if (!frame.layout.gradients) return;
    const Lanes half_to_eye[3] = {hn::Load(d, rays.half_to_eye[0]),
                                  hn::Load(d, rays.half_to_eye[1]),
                                  hn::Load(d, rays.half_to_eye[2])};
    for (std::size_t l = 0; l < frame.constants.lights.size(); ++l) {
      lights[l].set(d, frame.constants.lights[l], half_to_eye);
    }
  }
};

/// Of all lights the sums of their intensities times the cosines of samples' normals with the
/// light, and with the direction halfway to the eye, of which the latter is raised to the
/// shininess.
template <std::size_t N>
struct Light {
  std::array<Lanes, N> diffuse, specular;
};

/// Samples that are classified side by side.
template <std::size_t N>
struct SamplesAtOnce {
  std::array<const float*, N> channels;  ///< their field's channel 0
  std::array<std::size_t, N> field;
  std::array<Lanes, N> length;  ///< of the rays that they stand for, in steps of depth
};

/// Gradients of some samples, and two over their norms; 0 where there is no normal.
template <std::size_t N>
struct Normals {
  std::array<Lanes, N> x, y, z, scale;

  HWY_INLINE void load(LaneTag d, const FrameShading& frame, const SamplesAtOnce<N>& samples) {
    const SampleLayout& layout = frame.layout;
    const auto absolute_at =
        static_cast<std::size_t>(layout.absolute ? layout.absolute_channel() * num_lanes : 0);
    const auto& channels = samples.channels;
    std::array<Lanes, N> norm_sq, least;
    unroll<N>([&](std::size_t n) MOTES_INLINE HWY_ATTR {
      x[n] = hn::Load(d, channels[n] + num_lanes);
      y[n] = hn::Load(d, channels[n] + 2 * num_lanes);
      z[n] = hn::Load(d, channels[n] + 3 * num_lanes);
      norm_sq[n] = hn::MulAdd(x[n], x[n], hn::MulAdd(y[n], y[n], hn::Mul(z[n], z[n])));
      least[n] = hn::Mul(hn::Load(d, channels[n] + absolute_at),
                         hn::Set(d, frame.least_gradient[samples.field[n]]));
    });
    const std::array<Lanes, N> twice_inverse = twice_inverse_sqrt(d, norm_sq);
    unroll<N>([&](std::size_t n) MOTES_INLINE HWY_ATTR {
      const Lanes least_sq = hn::MulAdd(least[n], least[n], hn::Set(d, 1e-36f));
      scale[n] = hn::IfThenElseZero(hn::Gt(norm_sq[n], least_sq), twice_inverse[n]);
    });
  }

  /// Cosines of the angles with twice the vectors, without their signs.
  HWY_INLINE std::array<Lanes, N> along(LaneTag d, const Lanes half[3]) const {
    std::array<Lanes, N> cosine;
    unroll<N>([&](std::size_t n) MOTES_INLINE HWY_ATTR {
      const Lanes sum =
          hn::MulAdd(x[n], half[0], hn::MulAdd(y[n], half[1], hn::Mul(z[n], half[2])));
      cosine[n] = hn::Min(hn::Abs(hn::Mul(sum, scale[n])), hn::Set(d, 1.0f));
    });
    return cosine;
  }
};

/// Two-sided Phong lighting (docs/field.md).
template <bool kPlain, std::size_t N>
HWY_INLINE Light<N> light_samples(LaneTag d, const BlockShading& shading,
                                  const SamplesAtOnce<N>& samples) {
  const ShadingConstants& constants = shading.frame.constants;
  Normals<N> normals;
  normals.load(d, shading.frame, samples);
  const auto light_from = [&](std::size_t l) MOTES_INLINE HWY_ATTR {
    Light<N> light;
    light.diffuse = light.specular = normals.along(d, shading.lights[l].half_to_light);
    if (!shading.lights[l].headlight) {
      light.specular = normals.along(d, shading.lights[l].half_halfway);
    }
    raise<kPlain>(d, constants.shininess, light.specular);
    return light;
  };
  if constexpr (kPlain) return light_from(0);
  Light<N> sum;
  sum.diffuse.fill(hn::Zero(d));
  sum.specular.fill(hn::Zero(d));
  for (std::size_t l = 0; l < constants.lights.size(); ++l) {
    const Light<N> light = light_from(l);
    const Lanes intensity = hn::Set(d, constants.lights[l].intensity);
    unroll<N>([&](std::size_t n) MOTES_INLINE HWY_ATTR {
      sum.diffuse[n] = hn::MulAdd(intensity, light.diffuse[n], sum.diffuse[n]);
      sum.specular[n] = hn::MulAdd(intensity, light.specular[n], sum.specular[n]);
    });
  }
  return sum;
}

/// What samples add to their rays.
template <std::size_t N>
struct Contributions {
  std::array<Lanes, N> opacity;
  std::array<Lanes, N> color[3];  ///< not weighted by the opacity
  Light<N> light;                 ///< with gradients
};

/// There is one light of intensity 1, and nothing is needed that takes a call: no logarithm, no
/// opacity of thick samples, no power but is_plain_power().
/// Registers need not be kept for it then.
inline bool is_plain(const FrameShading& frame) {
  const std::vector<LightConstants>& lights = frame.constants.lights;
  return lights.size() == 1 && lights[0].intensity == 1 &&
         is_plain_power(frame.constants.shininess) && frame.max_depth <= 1 &&
         std::none_of(frame.classifiers.begin(), frame.classifiers.end(),
                      [](const Classifier& c) { return c.log_scale; });
}

/// kPlain: is_plain(). kOneField: there is but one field.
template <bool kGradients, bool kPlain, bool kOneField, TableKind kKind, std::size_t N>
HWY_INLINE void classify(LaneTag d, const BlockShading& shading, const SamplesAtOnce<N>& samples,
                         Contributions<N>& out) {
  const auto classifier_of = [&](std::size_t n) MOTES_INLINE HWY_ATTR -> const Classifier& {
    return shading.frame.classifiers[kOneField ? 0 : samples.field[n]];
  };
  std::array<Lanes, N> argument;
  unroll<N>([&](std::size_t n)
                MOTES_INLINE HWY_ATTR { argument[n] = hn::Load(d, samples.channels[n]); });
  if constexpr (!kPlain) {
    for (std::size_t n = 0; n < N; ++n) {
      const Classifier& c = classifier_of(n);
      if (c.log_scale) argument[n] = logarithmic_argument(d, c, argument[n]);
    }
  }
  std::array<TablePlace, N> places;
  unroll<N>([&](std::size_t n) MOTES_INLINE HWY_ATTR {
    places[n] = find_segment<kKind>(d, classifier_of(n), argument[n]);
  });
  if constexpr (kKind == TableKind::many) {
    unroll<N>([&](std::size_t n) MOTES_INLINE HWY_ATTR {
      const std::array<Lanes, 4> values = read_record(d, classifier_of(n), places[n]);
      for (std::size_t i = 0; i < 3; ++i) out.color[i][n] = values[i];
      out.opacity[n] = values[3];
    });
  }
  // Colours last: they need not be kept then while opacities are worked out.
  const auto read = [&](int i, std::array<Lanes, N>& values) MOTES_INLINE HWY_ATTR {
    if constexpr (kKind == TableKind::many) return;
    unroll<N>([&](std::size_t n) MOTES_INLINE HWY_ATTR {
      values[n] = read_table<kKind>(d, classifier_of(n), i, places[n]);
    });
  };
  read(3, out.opacity);
  unroll<N>([&](std::size_t n) MOTES_INLINE HWY_ATTR {
    out.opacity[n] = hn::Mul(out.opacity[n], samples.length[n]);
  });
  to_opacity<kPlain>(d, shading.frame.max_depth, out.opacity);
  unroll<3>([&](std::size_t i) MOTES_INLINE HWY_ATTR { read(static_cast<int>(i), out.color[i]); });
  if constexpr (kGradients) out.light = light_samples<kPlain>(d, shading, samples);
}

/// What is left of a colour in the light.
template <std::size_t N>
HWY_INLINE Lanes diffuse_factor(LaneTag d, const ShadingConstants& constants, const Light<N>& light,
                                std::size_t n) {
  return hn::MulAdd(hn::Set(d, constants.diffuse), light.diffuse[n], hn::Set(d, constants.ambient));
}

}  // namespace HWY_NAMESPACE
}  // namespace motes
HWY_AFTER_NAMESPACE();

#endif
