// The kernels' shapes for a vector of distances. Included once per instruction set.
//
// A shape takes the squared distance in units that suit it: the squared distance in lengths times
// distance_scale, which is that of a kernel of radius 1 over the squared radius.
#if defined(MOTES_FIELD_SHAPES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MOTES_FIELD_SHAPES_INL_H_
#undef MOTES_FIELD_SHAPES_INL_H_
#else
#define MOTES_FIELD_SHAPES_INL_H_
#endif

#include <hwy/highway.h>

#include <array>
#include <cstdint>
#include <numbers>

#include "field/kernel_set.h"
#include "field/radial_table.h"
#include "field/sampling-inl.h"
#include "samples/lanes-inl.h"
#include "samples/transpose-inl.h"

HWY_BEFORE_NAMESPACE();
namespace motes {
namespace HWY_NAMESPACE {

/// phi at q, of peak 1, and -(d phi / d q) / q: the gradient is steepness times -(x - x_i) / r^2.
template <class V>
struct RadialLanes {
  V value, steepness;
};

/// A shape of which the samples of a column and a row are products: the squared distance is the
/// base-2 exponent.
struct GaussianShape {
  static constexpr bool is_product = true;
  static constexpr float distance_scale = -0.5f * std::numbers::log2e_v<float>;
  float threshold;  ///< exponent at the support radius

  template <bool kSteepness, class D, class V = hn::Vec<D>>
  HWY_INLINE RadialLanes<V> at(D d, V exponent) const {
    const auto inside = hn::Ge(exponent, hn::Set(d, threshold));
    const V value = hn::IfThenElseZero(inside, exp2_bounded(d, exponent));
    return {value, value};
  }
};

/// 1 / sqrt(x), relative error below 3e-7; finite where x is 0.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V inverse_sqrt(D d, V x) {
  const V bounded = hn::Max(x, hn::Set(d, 1e-30f));
  const V y = hn::ApproximateReciprocalSqrt(bounded);
  const V half_y = hn::Mul(hn::Set(d, 0.5f), y);
  return hn::MulAdd(half_y, hn::NegMulAdd(hn::Mul(bounded, y), y, hn::Set(d, 1.0f)), y);
}

/// max(reach - q, 0).
template <class D, class V = hn::Vec<D>>
HWY_INLINE V below(D d, float reach, V q) {
  return hn::Max(hn::Sub(hn::Set(d, reach), q), hn::Zero(d));
}

/// What all others have in common: they are functions of q^2, and where their support ends they
/// come to zero by themselves.
struct SumShape {
  static constexpr bool is_product = false;
  static constexpr float distance_scale = 1;

  /// What at() takes in place of q_sq: more, in shapes that wait long for what they find first.
  template <bool kSteepness, class D, class V = hn::Vec<D>>
  HWY_INLINE V find(D, V q_sq) const {
    return q_sq;
  }
};

struct CubicSplineShape : SumShape {
  template <bool kSteepness, class D, class V = hn::Vec<D>>
  HWY_INLINE RadialLanes<V> at(D d, V q_sq) const {
    const V inverse = inverse_sqrt(d, q_sq), q = hn::Mul(q_sq, inverse);
    const V outer = below(d, 2, q), inner = below(d, 1, q);
    const V outer_sq = hn::Mul(hn::Set(d, 0.25f), hn::Mul(outer, outer));
    const V inner_sq = hn::Mul(inner, inner);
    RadialLanes<V> phi{hn::NegMulAdd(inner_sq, inner, hn::Mul(outer_sq, outer)), outer};
    if constexpr (kSteepness) {
      phi.steepness = hn::Mul(hn::Mul(hn::Set(d, 3.0f), hn::Sub(outer_sq, inner_sq)), inverse);
    }
    return phi;
  }
};

struct QuinticSplineShape : SumShape {
  template <bool kSteepness, class D, class V = hn::Vec<D>>
  HWY_INLINE RadialLanes<V> at(D d, V q_sq) const {
    const V inverse = inverse_sqrt(d, q_sq), q = hn::Mul(q_sq, inverse);
    const V outer = below(d, 3, q), middle = below(d, 2, q), inner = below(d, 1, q);
    const auto fourth = [&](float factor, V x) HWY_ATTR {
      const V x_sq = hn::Mul(x, x);
      return hn::Mul(hn::Set(d, factor), hn::Mul(x_sq, x_sq));
    };
    const V outer_4 = fourth(1.0f / 66, outer), middle_4 = fourth(6.0f / 66, middle);
    const V inner_4 = fourth(15.0f / 66, inner);
    const V outer_5 = hn::Mul(outer_4, outer);
    RadialLanes<V> phi{hn::MulAdd(inner_4, inner, hn::NegMulAdd(middle_4, middle, outer_5)), outer};
    if constexpr (kSteepness) {
      const V sum = hn::Add(hn::Sub(outer_4, middle_4), inner_4);
      phi.steepness = hn::Mul(hn::Mul(hn::Set(d, 5.0f), sum), inverse);
    }
    return phi;
  }
};

/// Wendland's kernels are powers of t = 1 - q / 2 times polynomials in q.
template <class V>
struct WendlandPlace {
  V q, t;
};

template <class D, class V = hn::Vec<D>>
HWY_INLINE WendlandPlace<V> wendland_place(D d, V q_sq) {
  const V q = hn::Mul(q_sq, inverse_sqrt(d, q_sq));
  const V t = hn::NegMulAdd(hn::Set(d, 0.5f), q, hn::Set(d, 1.0f));
  return {q, hn::Max(t, hn::Zero(d))};
}

struct WendlandC2Shape : SumShape {
  template <bool kSteepness, class D, class V = hn::Vec<D>>
  HWY_INLINE RadialLanes<V> at(D d, V q_sq) const {
    const auto [q, t] = wendland_place(d, q_sq);
    const V t_3 = hn::Mul(hn::Mul(t, t), t);
    const V value = hn::Mul(hn::Mul(t_3, t), hn::MulAdd(hn::Set(d, 2.0f), q, hn::Set(d, 1.0f)));
    return {value, hn::Mul(hn::Set(d, 5.0f), t_3)};
  }
};

struct WendlandC4Shape : SumShape {
  template <bool kSteepness, class D, class V = hn::Vec<D>>
  HWY_INLINE RadialLanes<V> at(D d, V q_sq) const {
    const auto [q, t] = wendland_place(d, q_sq);
    const V one = hn::Set(d, 1.0f);
    const V t_2 = hn::Mul(t, t), t_5 = hn::Mul(hn::Mul(t_2, t_2), t);
    const V polynomial =
        hn::MulAdd(q, hn::MulAdd(q, hn::Set(d, 35.0f / 12), hn::Set(d, 3.0f)), one);
    const V steepness = hn::Mul(t_5, hn::MulAdd(q, hn::Set(d, 35.0f / 3), hn::Set(d, 14.0f / 3)));
    return {hn::Mul(hn::Mul(t_5, t), polynomial), steepness};
  }
};

struct WendlandC6Shape : SumShape {
  template <bool kSteepness, class D, class V = hn::Vec<D>>
  HWY_INLINE RadialLanes<V> at(D d, V q_sq) const {
    const auto [q, t] = wendland_place(d, q_sq);
    const V one = hn::Set(d, 1.0f);
    const V t_2 = hn::Mul(t, t), t_4 = hn::Mul(t_2, t_2), t_7 = hn::Mul(hn::Mul(t_4, t_2), t);
    V polynomial = hn::MulAdd(q, hn::Set(d, 4.0f), hn::Set(d, 6.25f));
    polynomial = hn::MulAdd(q, hn::MulAdd(q, polynomial, hn::Set(d, 4.0f)), one);
    V steepness = hn::MulAdd(q, hn::Set(d, 22.0f), hn::Set(d, 19.25f));
    steepness = hn::Mul(t_7, hn::MulAdd(q, steepness, hn::Set(d, 5.5f)));
    return {hn::Mul(hn::Mul(t_7, t), polynomial), steepness};
  }
};

/// Where in a table some distances are.
template <class D, class V = hn::Vec<D>>
struct TablePlaces {
  hn::Vec<hn::RebindToUnsigned<D>> bits;  ///< the lowest 22 of them number the segments
  V t;                                    ///< from the segments' middles
  V steepness;                            ///< where the slope by the place is 1
  hn::Mask<D> inside;                     ///< of the support

  static constexpr std::uint32_t number_mask = (1u << 22) - 1;
};

template <bool kSteepness, class D, class V = hn::Vec<D>>
HWY_INLINE TablePlaces<D> find_places(D d, const RadialTable& table, const TableSegments& segments,
                                      V q_sq) {
  TablePlaces<D> out;
  V q = q_sq;
  if (segments.of_squares) {
    out.steepness = hn::Set(d, -2 * segments.per_unit);
  } else {
    // The processor's own square root and division take long, but run beside all other operations,
    // whose place Newton's steps would take.
    q = hn::Sqrt(q_sq);
    if constexpr (kSteepness) {
      out.steepness = hn::Div(hn::Set(d, -segments.per_unit), hn::Max(q, hn::Set(d, 1e-15f)));
    }
  }
  // Relative to the middle of segment 0. A number this large has no fraction: it is rounded, and
  // its bits are an integer's.
  const V place = hn::MulAdd(q, hn::Set(d, segments.per_unit), hn::Set(d, -0.5f));
  const V large = hn::Set(d, 0x1.8p23f);
  const V rounded = hn::Add(hn::Min(place, hn::Set(d, segments.last)), large);
  out.bits = hn::BitCast(hn::RebindToUnsigned<D>(), rounded);
  out.t = hn::Sub(place, hn::Sub(rounded, large));
  out.inside = hn::Le(q_sq, hn::Set(d, table.support_sq));
  return out;
}

/// Polynomials of which coefficient(k) gives the k-th coefficients, at their places.
template <bool kSteepness, std::size_t kDegree, class D, class Coefficient, class V = hn::Vec<D>>
HWY_INLINE RadialLanes<V> polynomials_at(D, const TablePlaces<D>& places,
                                         Coefficient&& coefficient) {
  const V t = places.t;
  V slope = coefficient(kDegree);
  V value = hn::MulAdd(slope, t, coefficient(kDegree - 1));
  unroll<kDegree - 1>([&](std::size_t i) MOTES_INLINE HWY_ATTR {
    if constexpr (kSteepness) slope = hn::MulAdd(slope, t, value);
    value = hn::MulAdd(value, t, coefficient(kDegree - 2 - i));
  });
  RadialLanes<V> phi{hn::IfThenElseZero(places.inside, value), t};
  if constexpr (kSteepness) {
    phi.steepness = hn::IfThenElseZero(places.inside, hn::Mul(slope, places.steepness));
  }
  return phi;
}

/// A table's own steps, of which each lane loads its record.
struct TabulatedShape : SumShape {
  const RadialTable* table;

  template <bool kSteepness, class D, class V = hn::Vec<D>>
  HWY_INLINE TablePlaces<D> find(D d, V q_sq) const {
    return find_places<kSteepness>(d, *table, table->steps, q_sq);
  }

  template <bool kSteepness, class D, class V = hn::Vec<D>>
  HWY_INLINE RadialLanes<V> at(D d, const TablePlaces<D>& places) const {
    static_assert(RadialTable::record_size == 4);
    const hn::RebindToUnsigned<D> du;
    const auto number = hn::And(places.bits, hn::Set(du, TablePlaces<D>::number_mask));
    std::size_t offset[hn::MaxLanes(D())];
    extract_numbers(du, hn::ShiftLeft<2>(number), offset);
    std::array<V, RadialTable::record_size> c;
    load_fours(d, table->records.data(), offset, c);
    return polynomials_at<kSteepness, 3>(d, places, [&](std::size_t k) { return c[k]; });
  }
  template <bool kSteepness, class D, class V = hn::Vec<D>>
  HWY_INLINE RadialLanes<V> at(D d, V q_sq) const {
    return at<kSteepness>(d, find<kSteepness>(d, q_sq));
  }
};

#if HWY_TARGET <= HWY_AVX2
/// A smooth table: a permutation of a register finds a coefficient.
struct SmoothTableShape : SumShape {
  const RadialTable* table;
  Lanes coefficients[RadialTable::smooth_degree + 1];

  explicit SmoothTableShape(const RadialTable& from) : table(&from) {
    static_assert(RadialTable::smooth_row >= num_lanes);
    for (std::size_t k = 0; k <= RadialTable::smooth_degree; ++k) {
      coefficients[k] = hn::Load(LaneTag(), from.rows.data() + RadialTable::smooth_row * k);
    }
  }

  template <bool kSteepness, class D, class V = hn::Vec<D>>
  HWY_INLINE RadialLanes<V> at(D d, V q_sq) const {
    const auto places = find_places<kSteepness>(d, *table, table->smooth, q_sq);
    const auto look_up = [&](std::size_t k) MOTES_INLINE HWY_ATTR {
      // Permutations take no more of the bits than it takes to tell the lanes apart.
      if constexpr (hn::MaxLanes(D()) == 16) {
        return V{_mm512_permutexvar_ps(places.bits.raw, coefficients[k].raw)};
      } else if constexpr (num_lanes == 16) {
        const V lower = hn::LowerHalf(d, coefficients[k]);
        return V{_mm256_permutevar8x32_ps(lower.raw, places.bits.raw)};
      } else {
        return V{_mm256_permutevar8x32_ps(coefficients[k].raw, places.bits.raw)};
      }
    };
    return polynomials_at<kSteepness, RadialTable::smooth_degree>(d, places, look_up);
  }
};
#endif

#if HWY_TARGET <= HWY_AVX3
/// A table's own steps, up to 32 * kPairs: permutations of pairs of registers find a coefficient.
template <std::size_t kPairs>
struct ShortTableShape : SumShape {
  static constexpr std::size_t most = 32 * kPairs;
  static_assert(kPairs == 1 || kPairs == 2);
  const RadialTable* table;
  /// By coefficient, 16 segments each.
  __m512 coefficients[RadialTable::record_size][2 * kPairs];

  explicit ShortTableShape(const RadialTable& from) : table(&from) {
    alignas(64) float c[RadialTable::record_size][most] = {};
    for (std::size_t i = 0; i < from.records.size(); ++i) {
      c[i % RadialTable::record_size][i / RadialTable::record_size] = from.records[i];
    }
    for (std::size_t k = 0; k < RadialTable::record_size; ++k) {
      for (std::size_t i = 0; i < 2 * kPairs; ++i) {
        coefficients[k][i] = _mm512_load_ps(c[k] + 16 * i);
      }
    }
  }

  template <bool kSteepness, class D, class V = hn::Vec<D>>
  HWY_INLINE RadialLanes<V> at(D d, V q_sq) const {
    const auto places = find_places<kSteepness>(d, *table, table->steps, q_sq);
    const __m512i number = widened(places.bits.raw);
    const __mmask16 upper = _mm512_test_epi32_mask(number, _mm512_set1_epi32(32));
    const auto look_up = [&](std::size_t k) MOTES_INLINE HWY_ATTR {
      const __m512* const c = coefficients[k];
      __m512 found = _mm512_permutex2var_ps(c[0], number, c[1]);
      if constexpr (kPairs == 2) {
        found = _mm512_mask_mov_ps(found, upper, _mm512_permutex2var_ps(c[2], number, c[3]));
      }
      if constexpr (hn::MaxLanes(D()) == 16) {
        return V{found};
      } else {
        return V{_mm512_castps512_ps256(found)};
      }
    };
    return polynomials_at<kSteepness, 3>(d, places, look_up);
  }

 private:
  static HWY_INLINE __m512i widened(__m512i number) { return number; }
  /// The upper half is of no interest.
  static HWY_INLINE __m512i widened(__m256i number) { return _mm512_castsi256_si512(number); }
};
#endif

/// 2^exponent for exponents of at most 0; 0 where that is too small for a float.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V factor_of(D d, V exponent) {
#if HWY_TARGET <= HWY_AVX3
  // Fraction and power are one operation each, and underflow comes out right.
  if constexpr (hn::MaxLanes(D()) == 16) {
    const V fraction{_mm512_reduce_ps(exponent.raw, _MM_FROUND_TO_NEAREST_INT)};
    const V whole = hn::Sub(exponent, fraction);
    return V{_mm512_scalef_ps(exp2_fraction(d, fraction).raw, whole.raw)};
  } else {
    static_assert(hn::MaxLanes(D()) == 8);
    const V fraction{_mm256_reduce_ps(exponent.raw, _MM_FROUND_TO_NEAREST_INT)};
    const V whole = hn::Sub(exponent, fraction);
    return V{_mm256_scalef_ps(exp2_fraction(d, fraction).raw, whole.raw)};
  }
#else
  return hn::IfThenElseZero(hn::Ge(exponent, hn::Set(d, min_exponent)), exp2_bounded(d, exponent));
#endif
}

/// A column's or row's share of a kernel from its share of the squared distance: a factor of a
/// Gaussian, of other shapes that share itself, in their units.
template <class Shape, class D, class V = hn::Vec<D>>
HWY_INLINE V share_of(D d, V minus_inverse_radius_sq, V distance_sq) {
  const V scale = hn::Mul(minus_inverse_radius_sq, hn::Set(d, -Shape::distance_scale));
  const V scaled = hn::Mul(scale, distance_sq);
  if constexpr (Shape::is_product) {
    return factor_of(d, scaled);
  } else {
    return scaled;
  }
}

/// Calls use(shape) with the shape of field f's kernels.
template <class Use>
HWY_INLINE void with_shape(const SamplingConstants& constants, std::size_t f, Use&& use) {
  const FieldKernels& field = *constants.kernels[f];
  switch (field.kernel.shape.type) {
    case KernelType::gaussian:
      return use(GaussianShape{constants.fields[f].threshold});
    case KernelType::cubic_spline:
      return use(CubicSplineShape{});
    case KernelType::quintic_spline:
      return use(QuinticSplineShape{});
    case KernelType::wendland_c2:
      return use(WendlandC2Shape{});
    case KernelType::wendland_c4:
      return use(WendlandC4Shape{});
    case KernelType::wendland_c6:
      return use(WendlandC6Shape{});
    case KernelType::tabulated:
#if HWY_TARGET <= HWY_AVX2
      if (field.table.is_smooth()) return use(SmoothTableShape(field.table));
#endif
#if HWY_TARGET <= HWY_AVX3
      if (field.table.num_steps() <= 32) return use(ShortTableShape<1>(field.table));
      if (field.table.num_steps() <= 64) return use(ShortTableShape<2>(field.table));
#endif
      return use(TabulatedShape{{}, &field.table});
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace motes
HWY_AFTER_NAMESPACE();

#endif
