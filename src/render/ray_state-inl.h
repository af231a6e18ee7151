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
    const V first = hn::Ceil(hn::MulSub(range.near, inverse_step, half));
    const V last = hn::Floor(hn::MulSub(range.far, inverse_step, half));
    const auto any = hn::And(hn::And(hn::Le(range.near, range.far), hn::Le(first, last)),
                             hn::Gt(hn::Load(d, in_image + i), hn::Zero(d)));
    const V relative_first = hn::Sub(first, first_plane),
            relative_last = hn::Sub(last, first_plane);
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
