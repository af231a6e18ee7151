#include "field/slab_frame.h"

#include <algorithm>
#include <cmath>

namespace motes {
namespace {

double largest(const Range& range) { return std::max(std::abs(range.low), std::abs(range.high)); }

double smallest(const Range& range) {
  return range.low * range.high <= 0 ? 0 : std::min(std::abs(range.low), std::abs(range.high));
}

Range range_of(const double* values, int n) {
  const auto [low, high] = std::minmax_element(values, values + n);
  return {*low, *high};
}

/// The plane through the frame's points p with normal . p = offset.
FrustumPlane make_plane(const SlabFrame& frame, const CameraAxes& axes, const Vector3d& normal,
                        double offset) {
  FrustumPlane plane;
  plane.x = static_cast<float>(normal.x);
  plane.y = static_cast<float>(normal.y);
  plane.z = static_cast<float>(normal.z);
  plane.offset = static_cast<float>(offset);
  const Vector3d world = normal.x * axes.x + normal.y * axes.y + normal.z * axes.forward;
  for (int j = 0; j < 3; ++j) plane.world[j] = static_cast<float>(world[j]);
  plane.world_offset = static_cast<float>(offset + dot(world, frame.reference - Point3d{}));
  return plane;
}

/// The side through the rays with that slope along camera axis `axis` (0: x, 1: y), which pass the
/// reference's depth at coordinate `at`. `sign` tells which way is outwards.
FrustumPlane make_side(const SlabFrame& frame, const CameraAxes& axes, int axis, double sign,
                       double at, double direction) {
  const double norm = 1 / std::sqrt(1 + direction * direction);
  Vector3d normal{0, 0, -sign * direction * norm};
  normal[axis] = sign * norm;
  return make_plane(frame, axes, normal, sign * norm * at);
}

}  // namespace

RayBounds bounds_of(const RayPacket& packet) {
  return {range_of(packet.origin_x, packet.lanes), range_of(packet.origin_y, packet.lanes),
          range_of(packet.direction_x, packet.lanes), range_of(packet.direction_y, packet.lanes)};
}

SlabFrame make_slab_frame(const RayBounds& rays, const Slab& slab, const View& view) {
  const double first = view.planes.depth(slab.first);
  const double depth = 0.5 * (first + view.planes.depth(slab.first + slab.count - 1));
  SlabFrame frame;
  frame.step = static_cast<float>(view.planes.step);
  frame.first_depth = static_cast<float>(first - depth);
  frame.count = slab.count;
  frame.reference_x = rays.origin_x.middle() + depth * rays.direction_x.middle();
  frame.reference_y = rays.origin_y.middle() + depth * rays.direction_y.middle();
  frame.reference_depth = depth;

  const Vector3d rows[3] = {view.axes.x, view.axes.y, view.axes.forward};
  frame.reference =
      view.eye + frame.reference_x * rows[0] + frame.reference_y * rows[1] + depth * rows[2];
  double farthest = 0;
  for (int i = 0; i < 3; ++i) {
    frame.reference_high[i] = static_cast<float>(frame.reference[i]);
    frame.reference_low[i] = static_cast<float>(frame.reference[i] - frame.reference_high[i]);
    for (int j = 0; j < 3; ++j) frame.axes[i][j] = static_cast<float>(rows[i][j]);
    farthest = std::max(farthest, std::abs(frame.reference[i]));
  }
  frame.slack = static_cast<float>(1e-6 * (2 + farthest));
  return frame;
}

Frustum make_frustum(const RayBounds& rays, const SlabFrame& frame, const View& view) {
  Frustum frustum;
  const auto sides = [&](int first, int axis, const Range& origin, const Range& direction,
                         double reference) {
    const auto at = [&](double o, double d) { return o + frame.reference_depth * d - reference; };
    frustum.planes[first] =
        make_side(frame, view.axes, axis, -1, at(origin.low, direction.low), direction.low);
    frustum.planes[first + 1] =
        make_side(frame, view.axes, axis, +1, at(origin.high, direction.high), direction.high);
  };
  sides(0, 0, rays.origin_x, rays.direction_x, frame.reference_x);
  sides(2, 1, rays.origin_y, rays.direction_y, frame.reference_y);
  const double last_depth = frame.first_depth + (frame.count - 1) * view.planes.step;
  frustum.planes[4] = make_plane(frame, view.axes, {0, 0, -1}, -frame.first_depth);
  frustum.planes[5] = make_plane(frame, view.axes, {0, 0, 1}, last_depth);

  const double steep_x = largest(rays.direction_x), steep_y = largest(rays.direction_y);
  const double flat_x = smallest(rays.direction_x), flat_y = smallest(rays.direction_y);
  const double tangent_sq = steep_x * steep_x + steep_y * steep_y;
  frustum.max_sine = static_cast<float>(std::sqrt(tangent_sq / (1 + tangent_sq)));
  frustum.max_cosine = static_cast<float>(1 / std::sqrt(1 + flat_x * flat_x + flat_y * flat_y));
  const double cosine =
      steep_x * steep_y / std::sqrt((1 + steep_x * steep_x) * (1 + steep_y * steep_y));
  frustum.corner_factor = static_cast<float>(1 / (1 + cosine));
  return frustum;
}

PacketFrame make_packet_frame(const RayPacket& packet, const Slab& slab, const View& view) {
  const RayBounds rays = bounds_of(packet);
  PacketFrame frame;
  frame.slab = make_slab_frame(rays, slab, view);
  frame.frustum = make_frustum(rays, frame.slab, view);
  frame.lanes = packet.lanes;
  const double depth = frame.slab.reference_depth;
  for (int l = 0; l < packet.lanes; ++l) {
    const double x = packet.direction_x[l], y = packet.direction_y[l];
    frame.offset_x[l] = static_cast<float>(packet.origin_x[l] + depth * x - frame.slab.reference_x);
    frame.offset_y[l] = static_cast<float>(packet.origin_y[l] + depth * y - frame.slab.reference_y);
    frame.direction_x[l] = static_cast<float>(x);
    frame.direction_y[l] = static_cast<float>(y);
    frame.inverse_length_sq[l] = static_cast<float>(1 / (x * x + y * y + 1));
  }
  return frame;
}

}  // namespace motes
