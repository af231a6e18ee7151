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
HWY_INLINE Lanes opacity(LaneTag d, Lanes x) {
  // Minimax polynomial of (1 - exp(-x)) / x on [0, 1].
  Lanes p = hn::Set(d, 1.283807181e-04f);
  p = hn::MulAdd(p, x, hn::Set(d, -1.298663742e-03f));
  p = hn::MulAdd(p, x, hn::Set(d, 8.273095536e-03f));
  p = hn::MulAdd(p, x, hn::Set(d, -4.164557738e-02f));
  p = hn::MulAdd(p, x, hn::Set(d, 1.666630980e-01f));
  p = hn::MulAdd(p, x, hn::Set(d, -4.999997703e-01f));
  p = hn::MulAdd(p, x, hn::Set(d, 9.999999975e-01f));
  const Lanes thin = hn::Mul(p, x);
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

/// table[segment] of each lane.
HWY_INLINE Lanes look_up(LaneTag d, const AlignedVector<float>& table, int size,
                         hn::Vec<hn::RebindToSigned<LaneTag>> segment) {
  if (size == 1) return hn::Set(d, table[0]);
  if (static_cast<std::size_t>(size) <= hn::Lanes(d)) {
    return hn::TableLookupLanes(hn::Load(d, table.data()), hn::IndicesFromVec(d, segment));
  }
  return hn::GatherIndex(d, table.data(), segment);
}

HWY_INLINE TablePlace find_segment(LaneTag d, const Classifier& c, Lanes argument) {
  const hn::RebindToSigned<LaneTag> di;
  auto segment = hn::Zero(di);
  if (c.num_segments <= 2 * max_lanes) {
    for (int s = 1; s < c.num_segments; ++s) {
      const auto behind = hn::Ge(argument, hn::Set(d, c.begin[static_cast<std::size_t>(s)]));
      segment = hn::Sub(segment, hn::VecFromMask(di, hn::RebindMask(di, behind)));
    }
  } else {
    // Bisection: the last segment whose begin is not above the argument.
    int span = 1;
    while (span < c.num_segments) span *= 2;
    for (span /= 2; span > 0; span /= 2) {
      const auto candidate =
          hn::Min(hn::Add(segment, hn::Set(di, span)), hn::Set(di, c.num_segments - 1));
      const auto behind = hn::Ge(argument, hn::GatherIndex(d, c.begin.data(), candidate));
      segment = hn::IfThenElse(hn::RebindMask(di, behind), candidate, segment);
    }
  }
  const Lanes begin = look_up(d, c.begin, c.num_segments, segment);
  const Lanes inverse_width = look_up(d, c.inverse_width, c.num_segments, segment);
  const Lanes fraction = hn::Mul(hn::Sub(argument, begin), inverse_width);
  return {segment, hn::Min(hn::Max(fraction, hn::Zero(d)), hn::Set(d, 1.0f))};
}

/// Red, green, blue (0 to 2) or extinction times step (3) at a place of the table.
HWY_INLINE Lanes table_value(LaneTag d, const Classifier& c, int i, const TablePlace& place) {
  return hn::MulAdd(place.fraction, look_up(d, c.rise[i], c.num_segments, place.segment),
                    look_up(d, c.base[i], c.num_segments, place.segment));
}

/// The classifier's argument for the buffer's values. Finite also where there is no logarithm, so
/// that it lies above a transparent_below of -infinity and a flat segment makes no NaN of it.
HWY_INLINE Lanes argument_of(LaneTag d, const Classifier& c, Lanes value) {
  if (!c.log_scale) return value;
  const Lanes tiny = hn::Set(d, std::numeric_limits<float>::min());
  const Lanes logarithm = hn::Add(hn::Log10(d, hn::Max(value, tiny)), hn::Set(d, c.log_shift));
  return hn::IfThenElse(hn::Ge(value, tiny), logarithm,
                        hn::Set(d, std::numeric_limits<float>::lowest()));
}

/// x^power for x in [0, 1], power > 0.
HWY_INLINE Lanes power_of(LaneTag d, Lanes x, float power) {
  const Lanes tiny = hn::Set(d, std::numeric_limits<float>::min());
  const Lanes exponent = hn::Mul(hn::Set(d, power), hn::Log(d, hn::Max(x, tiny)));
  return hn::IfThenZeroElse(hn::Lt(x, tiny), hn::Exp(d, hn::Max(exponent, hn::Set(d, -86.0f))));
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
  const Lanes norm = hn::Sqrt(norm_sq);
  // Where kernels cancel there is no normal.
  const Lanes absolute = hn::Abs(hn::Load(
      d, channels +
             (layout.absolute ? static_cast<std::size_t>(layout.absolute_channel()) * lanes : 0)));
  const LaneMask has_normal =
      hn::And(hn::Ge(hn::Mul(norm, hn::Set(d, min_radius)), hn::Mul(hn::Set(d, 1e-6f), absolute)),
              hn::Gt(norm, hn::Zero(d)));
  const Lanes inverse_norm = hn::IfThenElseZero(has_normal, hn::Div(hn::Set(d, 1.0f), norm));

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
    const Lanes h_norm =
        hn::Sqrt(hn::MulAdd(h[0], h[0], hn::MulAdd(h[1], h[1], hn::Mul(h[2], h[2]))));
    const Lanes h_scale =
        hn::IfThenElseZero(hn::Gt(h_norm, hn::Zero(d)), hn::Div(hn::Set(d, 1.0f), h_norm));
    for (Lanes& component : h) component = hn::Mul(component, h_scale);
    n_l = along(l);
    n_h = along(h);
  }
  return {hn::MulAdd(hn::Set(d, shading.diffuse), n_l, hn::Set(d, shading.ambient)),
          hn::Mul(hn::Set(d, shading.specular), power_of(d, n_h, shading.shininess))};
}

/// The part of a packet's rays that lies in a slab, relative to it.
struct LivePart {
  Lanes first, last;  ///< of each lane; first > last: none
  int begin, end;     ///< of all lanes, both included; begin > end: none
};

HWY_INLINE LivePart live_part(LaneTag d, const RayState& rays, const Slab& slab) {
  const Lanes slab_first = hn::Set(d, static_cast<float>(slab.first));
  const Lanes slab_last = hn::Set(d, static_cast<float>(slab.count - 1));
  LivePart live;
  live.first = hn::Max(hn::Sub(hn::Load(d, rays.first), slab_first), hn::Zero(d));
  live.last = hn::Min(hn::Sub(hn::Load(d, rays.last), slab_first), slab_last);
  const LaneMask any = hn::Le(live.first, live.last);
  const Lanes none = hn::Set(d, -1.0f);
  live.begin = static_cast<int>(
      hn::GetLane(hn::MinOfLanes(d, hn::IfThenElse(any, live.first, hn::Add(slab_last, slab_last)))));
  live.end = static_cast<int>(hn::GetLane(hn::MaxOfLanes(d, hn::IfThenElse(any, live.last, none))));
  return live;
}

/// Composites the samples of `slab` in block `block` of the buffer into the rays' colours. A ray that
/// reaches the termination opacity ends. Hot: nothing is checked.
inline HWY_NOINLINE void integrate(const std::vector<Classifier>& classifiers,
                                   const ShadingConstants& shading, const Slab& slab,
                                   SampleBuffer& buffer, int block, RayState& rays) {
  const LaneTag d;
  const SampleLayout& layout = buffer.layout();
  const LivePart part = live_part(d, rays, slab);
  Lanes last = part.last;
  const Lanes direction_x = hn::Load(d, rays.direction_x);
  const Lanes direction_y = hn::Load(d, rays.direction_y);
  const Lanes length = hn::Sqrt(hn::MulAdd(
      direction_x, direction_x, hn::MulAdd(direction_y, direction_y, hn::Set(d, 1.0f))));
  const Lanes toward = hn::Div(hn::Set(d, -1.0f), length);
  const Lanes to_eye[3] = {hn::Mul(direction_x, toward), hn::Mul(direction_y, toward), toward};

  const bool skip_untouched =
      std::all_of(classifiers.begin(), classifiers.end(),
                  [](const Classifier& c) { return c.zero_is_transparent; });
  const Lanes one = hn::Set(d, 1.0f), zero = hn::Zero(d);
  Lanes color[3] = {hn::Load(d, rays.r), hn::Load(d, rays.g), hn::Load(d, rays.b)};
  Lanes alpha = hn::Load(d, rays.a);
  for (int k = part.begin; k <= part.end; ++k) {
    const int cell = buffer.cell(k, block);
    if (skip_untouched && !buffer.touched(cell)) continue;
    const Lanes index = hn::Set(d, static_cast<float>(k));
    const LaneMask live = hn::And(hn::Le(part.first, index), hn::Le(index, last));
    bool anything = false;
    for (std::size_t f = 0; f < classifiers.size(); ++f) {
      const Classifier& c = classifiers[f];
      const float* const channels = buffer.at(cell, static_cast<int>(f));
      const Lanes argument = argument_of(d, c, hn::Load(d, channels));
      LaneMask visible = hn::And(live, hn::Gt(argument, hn::Set(d, c.transparent_below)));
      if (hn::AllFalse(d, visible)) continue;
      const TablePlace place = find_segment(d, c, argument);
      const Lanes depth = hn::Mul(table_value(d, c, 3, place), length);
      visible = hn::And(visible, hn::Gt(depth, zero));
      if (hn::AllFalse(d, visible)) continue;

      anything = true;
      Light light{one, zero};
      if (layout.gradients) {
        light = light_field(d, shading, layout, shading.min_radius[f], channels, to_eye);
      }
      const Lanes weight =
          hn::Mul(hn::Sub(one, alpha), hn::IfThenElseZero(visible, opacity(d, depth)));
      for (int i = 0; i < 3; ++i) {
        const Lanes lit = hn::MulAdd(table_value(d, c, i, place), light.factor, light.highlight);
        color[i] = hn::MulAdd(weight, lit, color[i]);
      }
      alpha = hn::Add(alpha, weight);
    }
    if (!anything) continue;
    // After all fields of a sample: rays that are opaque enough end here.
    const LaneMask ended = hn::And(live, hn::Gt(alpha, hn::Set(d, shading.termination_opacity)));
    if (HWY_UNLIKELY(!hn::AllFalse(d, ended))) {
      last = hn::IfThenElse(ended, index, last);
      const Lanes frame_index = hn::Set(d, static_cast<float>(slab.first + k));
      hn::Store(hn::IfThenElse(ended, frame_index, hn::Load(d, rays.last)), d, rays.last);
      if (hn::AllFalse(d, hn::Gt(last, index))) break;
    }
  }
  hn::Store(color[0], d, rays.r);
  hn::Store(color[1], d, rays.g);
  hn::Store(color[2], d, rays.b);
  hn::Store(alpha, d, rays.a);
}

}  // namespace HWY_NAMESPACE
}  // namespace motes
HWY_AFTER_NAMESPACE();

#endif
