// Where lines meet balls and sticks, a lane each. Included once per instruction set.
#if defined(MOTES_SURFACE_SHAPES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MOTES_SURFACE_SHAPES_INL_H_
#undef MOTES_SURFACE_SHAPES_INL_H_
#else
#define MOTES_SURFACE_SHAPES_INL_H_
#endif

#include <hwy/highway.h>

#include "samples/lanes-inl.h"
#include "surface/surface.h"

HWY_BEFORE_NAMESPACE();
namespace motes {
namespace HWY_NAMESPACE {

template <class V>
struct Vector3v {
  V x, y, z;
};

template <class D, class V = hn::Vec<D>>
HWY_INLINE V dot(D, const Vector3v<V>& a, const Vector3v<V>& b) {
  return hn::MulAdd(a.x, b.x, hn::MulAdd(a.y, b.y, hn::Mul(a.z, b.z)));
}

/// a + s b
template <class D, class V = hn::Vec<D>>
HWY_INLINE Vector3v<V> add_scaled(D, const Vector3v<V>& a, V s, const Vector3v<V>& b) {
  return {hn::MulAdd(s, b.x, a.x), hn::MulAdd(s, b.y, a.y), hn::MulAdd(s, b.z, a.z)};
}

/// The part of a line within a solid: origin + w direction, first <= w <= last, where there is any.
template <class D>
struct Chord {
  hn::Vec<D> first, last;
  hn::Mask<D> any;
};

/// Of balls around 0. inverse_square: of the direction.
template <class D, class V = hn::Vec<D>>
HWY_INLINE Chord<D> meet_ball(D d, const Vector3v<V>& origin, const Vector3v<V>& direction,
                              V inverse_square, V radius) {
  const V b = hn::Mul(dot(d, origin, direction), inverse_square);
  const V c = hn::Mul(hn::NegMulAdd(radius, radius, dot(d, origin, origin)), inverse_square);
  const V discriminant = hn::MulSub(b, b, c);
  const V root = hn::Sqrt(hn::Max(discriminant, hn::Zero(d)));
  return {hn::Neg(hn::Add(b, root)), hn::Sub(root, b), hn::Ge(discriminant, hn::Zero(d))};
}

/// Sticks are longer by this than to the bond's middle, so that nothing shows between two halves.
inline constexpr double stick_overlap = 1e-5;

/// Where lines enter and leave the cylinder without ends, too.
template <class D>
struct StickChord : Chord<D> {
  hn::Vec<D> first_side, last_side;
};

/// Of sticks from 0 on: axis is a unit vector, `length` without the overlap.
template <class D, class V = hn::Vec<D>>
HWY_INLINE StickChord<D> meet_stick(D d, const Vector3v<V>& origin, const Vector3v<V>& direction,
                                    const Vector3v<V>& axis, V length, V radius) {
  using T = hn::TFromD<D>;
  const V origin_along = dot(d, origin, axis);
  V along = dot(d, direction, axis);
  // Across the axis: a w^2 + 2 b w + c = 0. Where the line runs along it, a is nothing but
  // rounding.
  const Vector3v<V> from = add_scaled(d, origin, hn::Neg(origin_along), axis);
  const Vector3v<V> across = add_scaled(d, direction, hn::Neg(along), axis);
  const V least = hn::Mul(dot(d, direction, direction), hn::Set(d, T(1e-12)));
  const V a = hn::Max(dot(d, across, across), least);
  const V b = dot(d, from, across);
  const V c = hn::NegMulAdd(radius, radius, dot(d, from, from));
  const V discriminant = hn::MulSub(b, b, hn::Mul(a, c));
  const V root = hn::Sqrt(hn::Max(discriminant, hn::Zero(d)));
  const V inverse = hn::Div(hn::Set(d, T(1)), a);
  // Between the planes of the ends.
  along = hn::IfThenElse(hn::Lt(hn::Abs(along), hn::Set(d, T(1e-25))), hn::Set(d, T(1e-25)), along);
  const V per_along = hn::Div(hn::Set(d, T(1)), along);
  const V begin = hn::Mul(hn::Neg(origin_along), per_along);
  const V end =
      hn::Mul(hn::MulSub(length, hn::Set(d, T(1 + stick_overlap)), origin_along), per_along);
  StickChord<D> chord;
  chord.first_side = hn::Mul(hn::Neg(hn::Add(b, root)), inverse);
  chord.last_side = hn::Mul(hn::Sub(root, b), inverse);
  chord.first = hn::Max(chord.first_side, hn::Min(begin, end));
  chord.last = hn::Min(chord.last_side, hn::Max(begin, end));
  chord.any = hn::And(hn::Ge(discriminant, hn::Zero(d)), hn::Le(chord.first, chord.last));
  return chord;
}

/// Sticks, a lane each.
template <class V>
struct StickLanes {
  Vector3v<V> axis;  ///< unit, world axes
  V length, radius;
};

/// Sticks `at` and following; lanes beyond the last stick are of no meaning.
template <class D, class V = hn::Vec<D>>
HWY_INLINE StickLanes<V> load_sticks(D d, const Sticks& sticks, std::size_t at) {
  const Vector3v<V> half{hn::LoadU(d, sticks.x.data() + at), hn::LoadU(d, sticks.y.data() + at),
                         hn::LoadU(d, sticks.z.data() + at)};
  const V length = hn::Sqrt(dot(d, half, half));
  const V per_length = hn::Div(hn::Set(d, 1.0f), length);
  const bool shared = sticks.radius.size() == 1;
  return {{hn::Mul(half.x, per_length), hn::Mul(half.y, per_length), hn::Mul(half.z, per_length)},
          length,
          shared ? hn::Set(d, sticks.radius[0]) : hn::LoadU(d, sticks.radius.data() + at)};
}

}  // namespace HWY_NAMESPACE
}  // namespace motes
HWY_AFTER_NAMESPACE();

#endif
