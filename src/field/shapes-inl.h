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

/// Where in a table some distances are: the numbers of their segments and the places within them.
template <class D, class V = hn::Vec<D>>
struct TablePlaces {
  hn::Vec<hn::RebindToSigned<D>> segment;
  V t;
  V steepness;         ///< that of a cubic whose slope within the segment is -1
  hn::Mask<D> inside;  ///< of the support
};

template <bool kOfSquares, class D, class V = hn::Vec<D>>
HWY_INLINE TablePlaces<D> find_places(D d, const RadialTable& table, V q_sq) {
  V q = q_sq, steepness = hn::Set(d, 2 * table.segments_per_unit);
  if constexpr (!kOfSquares) {
    const V inverse = inverse_sqrt(d, q_sq);
    q = hn::Mul(q_sq, inverse);
    steepness = hn::Mul(hn::Set(d, table.segments_per_unit), inverse);
  }
  const V place = hn::Mul(q, hn::Set(d, table.segments_per_unit));
  const V number = hn::Min(hn::Floor(place), hn::Set(d, table.last_segment));
  return {hn::ConvertTo(hn::RebindToSigned<D>(), number), hn::Sub(place, number), steepness,
          hn::Le(q_sq, hn::Set(d, table.support_sq))};
}

/// The cubics with coefficients c at their places.
template <bool kSteepness, class D, class V = hn::Vec<D>>
HWY_INLINE RadialLanes<V> cubic_at(D d, const TablePlaces<D>& places,
                                   const std::array<V, RadialTable::record_size>& c) {
  const V t = places.t;
  const V value = hn::MulAdd(t, hn::MulAdd(t, hn::MulAdd(t, c[3], c[2]), c[1]), c[0]);
  RadialLanes<V> phi{hn::IfThenElseZero(places.inside, value), t};
  if constexpr (kSteepness) {
    const V twice_c2 = hn::Add(c[2], c[2]), thrice_c3 = hn::Mul(hn::Set(d, -3.0f), c[3]);
    const V downwards = hn::MulSub(t, hn::MulSub(t, thrice_c3, twice_c2), c[1]);
    phi.steepness = hn::IfThenElseZero(places.inside, hn::Mul(downwards, places.steepness));
  }
  return phi;
}

struct TabulatedShape : SumShape {
  const RadialTable* table;

  template <bool kSteepness, class D, class V = hn::Vec<D>>
  HWY_INLINE RadialLanes<V> at(D d, V q_sq) const {
    const TablePlaces<D> places = table->of_squares ? find_places<true>(d, *table, q_sq)
                                                    : find_places<false>(d, *table, q_sq);
    const hn::RebindToSigned<D> di;
    alignas(64) std::int32_t offset[max_lanes];
    hn::Store(hn::ShiftLeft<2>(places.segment), di, offset);
    std::array<V, RadialTable::record_size> c;
    load_fours(d, table->coefficients.data(), offset, c);
    return cubic_at<kSteepness>(d, places, c);
  }
};

#if HWY_TARGET <= HWY_AVX3
/// A table of few segments: permutations of two registers find a coefficient.
template <bool kOfSquares>
struct SmallTableShape : SumShape {
  static constexpr int pairs = kOfSquares ? 2 : 1;
  static_assert(RadialTable::few == 32 && RadialTable::few_of_squares == 64);
  const RadialTable* table;
  /// By coefficient, 16 segments each.
  __m512 coefficients[RadialTable::record_size][2 * pairs];

  explicit SmallTableShape(const RadialTable& from) : table(&from) {
    alignas(64) float c[RadialTable::record_size][32 * pairs] = {};
    for (std::size_t i = 0; i < from.coefficients.size(); ++i) {
      c[i % RadialTable::record_size][i / RadialTable::record_size] = from.coefficients[i];
    }
    for (std::size_t k = 0; k < RadialTable::record_size; ++k) {
      for (std::size_t i = 0; i < 2 * pairs; ++i) {
        coefficients[k][i] = _mm512_load_ps(c[k] + 16 * i);
      }
    }
  }

  template <bool kSteepness, class D, class V = hn::Vec<D>>
  HWY_INLINE RadialLanes<V> at(D d, V q_sq) const {
    const TablePlaces<D> places = find_places<kOfSquares>(d, *table, q_sq);
    const __m512i number = widened(places.segment.raw);
    const __mmask16 upper = _mm512_cmpge_epi32_mask(number, _mm512_set1_epi32(32));
    const auto look_up = [&](int k) MOTES_INLINE HWY_ATTR {
      const __m512* const c = coefficients[k];
      __m512 found = _mm512_permutex2var_ps(c[0], number, c[1]);
      if constexpr (kOfSquares) {
        found = _mm512_mask_mov_ps(found, upper, _mm512_permutex2var_ps(c[2], number, c[3]));
      }
      if constexpr (hn::MaxLanes(D()) == 16) {
        return V{found};
      } else {
        return V{_mm512_castps512_ps256(found)};
      }
    };
    return cubic_at<kSteepness>(d, places, {look_up(0), look_up(1), look_up(2), look_up(3)});
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
#if HWY_TARGET <= HWY_AVX3
      if (field.table.has_few()) {
        return field.table.of_squares ? use(SmallTableShape<true>(field.table))
                                      : use(SmallTableShape<false>(field.table));
      }
#endif
      return use(TabulatedShape{{}, &field.table});
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace motes
HWY_AFTER_NAMESPACE();

#endif
