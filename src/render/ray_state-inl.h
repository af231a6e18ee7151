// Which samples of the rays of a block of pixels lie in the volume (docs/field.md, "Samples").
// Included once per instruction set.
#if defined(MOTES_RENDER_RAY_STATE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MOTES_RENDER_RAY_STATE_INL_H_
#undef MOTES_RENDER_RAY_STATE_INL_H_
#else
#define MOTES_RENDER_RAY_STATE_INL_H_
#endif

#include <hwy/highway.h>

#include <limits>

#include "render/ray_packets.h"
#include "samples/lanes-inl.h"
#include "samples/samples.h"

HWY_BEFORE_NAMESPACE();
namespace motes {
namespace HWY_NAMESPACE {

/// Depths at which rays run through the volume's box, faces included; near > far where they miss
/// it.
template <class V>
struct DepthRanges {
  V near, far;
};

/// See clip(), of whose work this does a vector of rays.
template <class D, class V = hn::Vec<D>>
HWY_INLINE DepthRanges<V> clip_rays(D d, const FrameContext& context, V origin_x, V origin_y,
                                    V direction_x, V direction_y) {
  const CameraAxes& axes = context.view.axes;
  DepthRanges<V> range{hn::Zero(d), hn::Set(d, std::numeric_limits<double>::max())};
  for (int i = 0; i < 3; ++i) {
    const V x = hn::Set(d, axes.x[i]), y = hn::Set(d, axes.y[i]);
    const V origin =
        hn::MulAdd(origin_x, x, hn::MulAdd(origin_y, y, hn::Set(d, context.view.eye[i])));
    V direction =
        hn::MulAdd(direction_x, x, hn::MulAdd(direction_y, y, hn::Set(d, axes.forward[i])));
    // A ray along a face: depths become huge, and 0 on the face itself.
    direction = hn::IfThenElse(hn::Eq(direction, hn::Zero(d)), hn::Set(d, 1e-290), direction);
    const V inverse = hn::Div(hn::Set(d, 1.0), direction);
    const V a = hn::Mul(hn::Sub(hn::Set(d, context.box.min[i]), origin), inverse);
    const V b = hn::Mul(hn::Sub(hn::Set(d, context.box.max[i]), origin), inverse);
    range.near = hn::Max(range.near, hn::Min(a, b));
    range.far = hn::Min(range.far, hn::Max(a, b));
  }
  return range;
}

/// Depths between which clip planes leave rays; near > far where they leave nothing.
template <class D, class V = hn::Vec<D>>
HWY_INLINE DepthRanges<V> find_kept(D d, const FrameContext& context, V origin_x, V origin_y,
                                    V direction_x, V direction_y) {
  const CameraAxes& axes = context.view.axes;
  const Vector3d eye = context.view.eye - Point3d{};
  DepthRanges<V> range{hn::Zero(d), hn::Set(d, std::numeric_limits<double>::max())};
  for (const ClipPlane& plane : context.clip_planes) {
    const V x = hn::Set(d, dot(plane.normal, axes.x)), y = hn::Set(d, dot(plane.normal, axes.y));
    const V forward = hn::Set(d, dot(plane.normal, axes.forward));
    const V before = hn::Set(d, plane.distance - dot(plane.normal, eye));
    // Along a ray, depth times `slope` stays below `room`.
    const V room = hn::NegMulAdd(origin_x, x, hn::NegMulAdd(origin_y, y, before));
    const V slope = hn::MulAdd(direction_x, x, hn::MulAdd(direction_y, y, forward));
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

/// Leaves no more of rays than lies between those depths, in steps.
template <class D, class V = hn::Vec<D>>
HWY_INLINE void cut_samples(D d, const DepthRanges<V>& kept, SampleRanges<V>& samples) {
  const V first = hn::Floor(kept.near), last = hn::Sub(hn::Ceil(kept.far), hn::Set(d, 1.0));
  samples.first = hn::Max(samples.first, first);
  samples.last = hn::Min(samples.last, last);
  samples.enters = hn::IfThenElseZero(hn::Eq(samples.first, first), hn::Sub(kept.near, first));
  samples.leaves =
      hn::IfThenElse(hn::Eq(samples.last, last), hn::Sub(kept.far, last), hn::Set(d, 1.0));
}

/// Sets `rays` to those of width x height pixels, whose top left one is (px, py), before their
/// first sample: lanes row by row. Lanes outside the image have no samples.
inline void start_rays(const FrameContext& context, int px, int py, int width, int height,
                       RayState& rays) {
  const RayPacket packet = make_ray_packet(context, px, py, width, height);
  const hn::CappedTag<double, max_lanes / 2> d;
  const hn::Rebind<float, decltype(d)> df;
  using V = hn::Vec<decltype(d)>;
  const V inverse_step = hn::Set(d, 1 / context.view.planes.step), half = hn::Set(d, 0.5);
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
  for (std::size_t i = 0; i < static_cast<std::size_t>(packet.lanes); i += hn::Lanes(d)) {
    const V direction_x = hn::Load(d, packet.direction_x + i);
    const V direction_y = hn::Load(d, packet.direction_y + i);
    const DepthRanges<V> range =
        clip_rays(d, context, hn::Load(d, packet.origin_x + i), hn::Load(d, packet.origin_y + i),
                  direction_x, direction_y);
    SampleRanges<V> samples{hn::Ceil(hn::MulSub(range.near, inverse_step, half)),
                            hn::Floor(hn::MulSub(range.far, inverse_step, half)), hn::Zero(d),
                            hn::Zero(d)};
    auto any = hn::Le(range.near, range.far);
    if (!context.clip_planes.empty()) {
      const DepthRanges<V> kept =
          find_kept(d, context, hn::Load(d, packet.origin_x + i), hn::Load(d, packet.origin_y + i),
                    direction_x, direction_y);
      any = hn::And(any, hn::Lt(kept.near, kept.far));
      cut_samples(d, {hn::Mul(kept.near, inverse_step), hn::Mul(kept.far, inverse_step)}, samples);
      store(samples.enters, rays.enters + i);
      store(samples.leaves, rays.leaves + i);
    }
    any = hn::And(hn::And(any, hn::Le(samples.first, samples.last)),
                  hn::Gt(hn::Load(d, in_image + i), hn::Zero(d)));
    const V relative_first = hn::Sub(samples.first, first_plane),
            relative_last = hn::Sub(samples.last, first_plane);
    begin = hn::Min(begin, hn::IfThenElse(any, relative_first, begin));
    end = hn::Max(end, hn::IfThenElse(any, relative_last, end));
    store(hn::IfThenElseZero(any, relative_first), rays.first + i);
    store(hn::IfThenElse(any, relative_last, hn::Set(d, -1.0)), rays.last + i);
    const V length = hn::Sqrt(hn::MulAdd(direction_x, direction_x,
                                         hn::MulAdd(direction_y, direction_y, hn::Set(d, 1.0))));
    const V half_to_eye = hn::Div(hn::Set(d, -0.5), length);
    store(length, rays.length + i);
    store(hn::Mul(direction_x, half_to_eye), rays.half_to_eye[0] + i);
    store(hn::Mul(direction_y, half_to_eye), rays.half_to_eye[1] + i);
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
