// Which samples of the rays of a block of pixels lie in the volume (docs/field.md, "Samples").
// Included once per instruction set.
#if defined(MOTES_RENDER_RAY_STATE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MOTES_RENDER_RAY_STATE_INL_H_
#undef MOTES_RENDER_RAY_STATE_INL_H_
#else
#define MOTES_RENDER_RAY_STATE_INL_H_
#endif

#include <hwy/highway.h>

#include <cstddef>
#include <limits>

#include "render/frame_grids.h"
#include "render/ray_packets.h"
#include "samples/lanes-inl.h"
#include "samples/samples.h"

HWY_BEFORE_NAMESPACE();
namespace motes {
namespace HWY_NAMESPACE {

/// Depths at which rays run through something, both included; near > far where they miss it.
template <class V>
struct DepthRanges {
  V near, far;
};

/// Some rays: x(z) = origin + z direction, in camera axes.
template <class V>
struct SomeRays {
  V origin_x, origin_y, direction_x, direction_y;

  template <class D>
  HWY_INLINE V direction_along(D d, double x, double y, double forward) const {
    return hn::MulAdd(direction_x, hn::Set(d, x),
                      hn::MulAdd(direction_y, hn::Set(d, y), hn::Set(d, forward)));
  }
  template <class D>
  HWY_INLINE V origin_along(D d, double x, double y, double eye) const {
    return hn::MulAdd(origin_x, hn::Set(d, x),
                      hn::MulAdd(origin_y, hn::Set(d, y), hn::Set(d, eye)));
  }
};

/// Leaves of depths those at which `origin` + depth `direction` lies from `low` to `high`.
template <class D, class V = hn::Vec<D>>
HWY_INLINE void clip_between(D d, double low, double high, V origin, V direction,
                             DepthRanges<V>& range) {
  // A ray along a face: depths become huge, and 0 on the face itself.
  direction = hn::IfThenElse(hn::Eq(direction, hn::Zero(d)), hn::Set(d, 1e-290), direction);
  const V inverse = hn::Div(hn::Set(d, 1.0), direction);
  const V a = hn::Mul(hn::Sub(hn::Set(d, low), origin), inverse);
  const V b = hn::Mul(hn::Sub(hn::Set(d, high), origin), inverse);
  range.near = hn::Max(range.near, hn::Min(a, b));
  range.far = hn::Min(range.far, hn::Max(a, b));
}

/// Within the volume's box: see clip(), of whose work this does a vector of rays.
template <class D, class V = hn::Vec<D>>
HWY_INLINE DepthRanges<V> clip_rays(D d, const FrameContext& context, const SomeRays<V>& rays) {
  const CameraAxes& axes = context.view.axes;
  DepthRanges<V> range{hn::Zero(d), hn::Set(d, std::numeric_limits<double>::max())};
  for (int i = 0; i < 3; ++i) {
    clip_between(d, context.box.min[i], context.box.max[i],
                 rays.origin_along(d, axes.x[i], axes.y[i], context.view.eye[i]),
                 rays.direction_along(d, axes.x[i], axes.y[i], axes.forward[i]), range);
  }
  return range;
}

/// Within a grid's hull.
template <class D, class V = hn::Vec<D>>
HWY_INLINE DepthRanges<V> clip_to_hull(D d, const FrameGrid& grid, const SomeRays<V>& rays) {
  DepthRanges<V> range{hn::Zero(d), hn::Set(d, std::numeric_limits<double>::max())};
  for (std::size_t i = 0; i < 3; ++i) {
    const double* const axes = grid.axes[i];
    clip_between(d, 0, grid.view.num_cells[i], rays.origin_along(d, axes[0], axes[1], grid.eye[i]),
                 rays.direction_along(d, axes[0], axes[1], axes[2]), range);
  }
  return range;
}

/// Depths between which clip planes leave rays; near > far where they leave nothing.
template <class D, class V = hn::Vec<D>>
HWY_INLINE DepthRanges<V> find_kept(D d, const FrameContext& context, const SomeRays<V>& rays) {
  const CameraAxes& axes = context.view.axes;
  const Vector3d eye = context.view.eye - Point3d{};
  DepthRanges<V> range{hn::Zero(d), hn::Set(d, std::numeric_limits<double>::max())};
  for (const ClipPlane& plane : context.clip_planes) {
    const double x = dot(plane.normal, axes.x), y = dot(plane.normal, axes.y);
    // Along a ray, depth times `slope` stays below `room`.
    const V room = rays.origin_along(d, -x, -y, plane.distance - dot(plane.normal, eye));
    const V slope = rays.direction_along(d, x, y, dot(plane.normal, axes.forward));
    const V depth = hn::Div(room, slope);
    const auto leaves = hn::Gt(slope, hn::Zero(d)), enters = hn::Lt(slope, hn::Zero(d));
    range.far = hn::IfThenElse(leaves, hn::Min(range.far, depth), range.far);
    range.near = hn::IfThenElse(enters, hn::Max(range.near, depth), range.near);
    const auto beyond = hn::AndNot(hn::Or(leaves, enters), hn::Lt(room, hn::Zero(d)));
    range.far = hn::IfThenElse(beyond, hn::Set(d, -1.0), range.far);
  }
  return range;
}

/// First and last samples of rays, and what is left of their steps: see RayState.
template <class V>
struct SampleRanges {
  V first, last, enters, leaves;
};

/// Stands for the first sample of rays that have none, and, negative, for the last.
inline constexpr double no_sample = 1e300;

/// Samples that lie between those depths, in steps.
template <class D, class V = hn::Vec<D>>
HWY_INLINE SampleRanges<V> whole_samples(D d, const DepthRanges<V>& range) {
  const V half = hn::Set(d, 0.5);
  const auto any = hn::Le(range.near, range.far);
  return {hn::IfThenElse(any, hn::Ceil(hn::Sub(range.near, half)), hn::Set(d, no_sample)),
          hn::IfThenElse(any, hn::Floor(hn::Sub(range.far, half)), hn::Set(d, -no_sample)),
          hn::Zero(d), hn::Set(d, 1.0)};
}

/// Samples whose steps reach between those depths.
template <class D, class V = hn::Vec<D>>
HWY_INLINE SampleRanges<V> cut_samples(D d, const DepthRanges<V>& range) {
  const V first = hn::Floor(range.near), last = hn::Sub(hn::Ceil(range.far), hn::Set(d, 1.0));
  const auto any = hn::Lt(range.near, range.far);
  return {hn::IfThenElse(any, first, hn::Set(d, no_sample)),
          hn::IfThenElse(any, last, hn::Set(d, -no_sample)), hn::Sub(range.near, first),
          hn::Sub(range.far, last)};
}

/// Leaves no more of rays than `kept`.
template <class D, class V = hn::Vec<D>>
HWY_INLINE void leave(D d, const SampleRanges<V>& kept, SampleRanges<V>& samples) {
  samples.first = hn::Max(samples.first, kept.first);
  samples.last = hn::Min(samples.last, kept.last);
  samples.enters = hn::IfThenElseZero(hn::Eq(samples.first, kept.first), kept.enters);
  samples.leaves = hn::IfThenElse(hn::Eq(samples.last, kept.last), kept.leaves, hn::Set(d, 1.0));
}

/// Puts a vector of ranges to lanes `lane`, ... of `out`, samples counted from plane `first`.
template <class D, class V = hn::Vec<D>>
HWY_INLINE void store_range(D d, const SampleRanges<V>& range, V first, std::size_t lane,
                            FieldRange& out) {
  const hn::Rebind<float, D> df;
  // (within what a float holds; no frame has so many planes)
  const auto sample = [&](V v, float* to) HWY_ATTR {
    const V most = hn::Set(d, 1e9);
    v = hn::Max(hn::Min(hn::Sub(v, first), most), hn::Neg(most));
    hn::StoreU(hn::DemoteTo(df, v), df, to + lane);
  };
  sample(range.first, out.first);
  sample(range.last, out.last);
  hn::StoreU(hn::DemoteTo(df, range.enters), df, out.enters + lane);
  hn::StoreU(hn::DemoteTo(df, range.leaves), df, out.leaves + lane);
}

/// Sets where the fields are along a vector of rays, from `lane` on, that have `samples` in the
/// box: those of particles at all of these, grids within their hulls, whose samples join the
/// others.
template <class D, class V = hn::Vec<D>>
HWY_INLINE void start_fields(D d, const FrameContext& context, const SomeRays<V>& rays,
                             std::size_t lane, SampleRanges<V>& samples, FieldRange* fields) {
  const V inverse_step = hn::Set(d, 1 / context.view.planes.step);
  const V first_plane = hn::Set(d, static_cast<double>(context.view.planes.first));
  for (std::size_t f = 0; f < context.classifiers.size(); ++f) {
    store_range(d, samples, first_plane, lane, fields[f]);
  }
  for (const FrameGrid& grid : context.grids) {
    const DepthRanges<V> hull = clip_to_hull(d, grid, rays);
    const SampleRanges<V> range =
        cut_samples(d, {hn::Mul(hull.near, inverse_step), hn::Mul(hull.far, inverse_step)});
    store_range(d, range, first_plane, lane, fields[grid.field]);
    samples.first = hn::Min(samples.first, range.first);
    samples.last = hn::Max(samples.last, range.last);
  }
}

/// Sets `rays` to those of width x height pixels, whose top left one is (px, py), before their
/// first sample: lanes row by row. Lanes outside the image have no samples. `fields` has one a
/// field and is set, and kept by `rays`, where there are grids.
inline void start_rays(const FrameContext& context, int px, int py, int width, int height,
                       FieldRange* fields, RayState& rays) {
  const RayPacket packet = make_ray_packet(context, px, py, width, height);
  const hn::CappedTag<double, max_lanes / 2> d;
  const hn::Rebind<float, decltype(d)> df;
  using V = hn::Vec<decltype(d)>;
  const V inverse_step = hn::Set(d, 1 / context.view.planes.step);
  const V first_plane = hn::Set(d, static_cast<double>(context.view.planes.first));
  const auto store = [&](V v, float* out) HWY_ATTR { hn::StoreU(hn::DemoteTo(df, v), df, out); };
  V begin = hn::Set(d, 1e9), end = hn::Set(d, -1.0);
  alignas(64) double in_image[max_lanes];
  for (int l = 0; l < packet.lanes; ++l) in_image[l] = 1;
  if (px + width > context.width || py + height > context.height) {
    for (int l = 0; l < packet.lanes; ++l) {
      in_image[l] = px + l % width < context.width && py + l / width < context.height ? 1 : 0;
    }
  }
  rays.fields = context.grids.empty() ? nullptr : fields;
  const auto in_steps = [&](const DepthRanges<V>& range) HWY_ATTR {
    return DepthRanges<V>{hn::Mul(range.near, inverse_step), hn::Mul(range.far, inverse_step)};
  };
  for (std::size_t i = 0; i < static_cast<std::size_t>(packet.lanes); i += hn::Lanes(d)) {
    const SomeRays<V> some{hn::Load(d, packet.origin_x + i), hn::Load(d, packet.origin_y + i),
                           hn::Load(d, packet.direction_x + i),
                           hn::Load(d, packet.direction_y + i)};
    SampleRanges<V> samples = whole_samples(d, in_steps(clip_rays(d, context, some)));
    if (rays.fields != nullptr) start_fields(d, context, some, i, samples, fields);
    if (!context.clip_planes.empty()) {
      leave(d, cut_samples(d, in_steps(find_kept(d, context, some))), samples);
      store(samples.enters, rays.enters + i);
      store(samples.leaves, rays.leaves + i);
    }
    const auto any = hn::And(hn::Le(samples.first, samples.last),
                             hn::Gt(hn::Load(d, in_image + i), hn::Zero(d)));
    const V relative_first = hn::Sub(samples.first, first_plane),
            relative_last = hn::Sub(samples.last, first_plane);
    begin = hn::Min(begin, hn::IfThenElse(any, relative_first, begin));
    end = hn::Max(end, hn::IfThenElse(any, relative_last, end));
    store(hn::IfThenElseZero(any, relative_first), rays.first + i);
    store(hn::IfThenElse(any, relative_last, hn::Set(d, -1.0)), rays.last + i);
    const V length =
        hn::Sqrt(hn::MulAdd(some.direction_x, some.direction_x,
                            hn::MulAdd(some.direction_y, some.direction_y, hn::Set(d, 1.0))));
    const V half_to_eye = hn::Div(hn::Set(d, -0.5), length);
    store(length, rays.length + i);
    store(hn::Mul(some.direction_x, half_to_eye), rays.half_to_eye[0] + i);
    store(hn::Mul(some.direction_y, half_to_eye), rays.half_to_eye[1] + i);
    store(half_to_eye, rays.half_to_eye[2] + i);
    for (float* channel : {rays.r, rays.g, rays.b, rays.a}) store(hn::Zero(d), channel + i);
  }
  rays.begin = static_cast<SampleIndex>(hn::GetLane(hn::MinOfLanes(d, begin)));
  rays.end = static_cast<SampleIndex>(hn::GetLane(hn::MaxOfLanes(d, end)));
}

}  // namespace HWY_NAMESPACE
}  // namespace motes
HWY_AFTER_NAMESPACE();

#endif
