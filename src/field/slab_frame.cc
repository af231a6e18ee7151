#include "field/slab_frame.h"

#include <algorithm>
#include <cmath>

namespace motes {
namespace {

/// Bounds of a coordinate over a packet's lanes.
struct Range {
  double low, high;
  double middle() const { return 0.5 * (low + high); }
  double largest() const { return std::max(std::abs(low), std::abs(high)); }
  double smallest() const { return low * high <= 0 ? 0 : std::min(std::abs(low), std::abs(high)); }
};

Range range_of(const double* values, int n) {
  Range range{values[0], values[0]};
  for (int i = 1; i < n; ++i) {
    range.low = std::min(range.low, values[i]);
    range.high = std::max(range.high, values[i]);
  }
  return range;
}

/// The packet's rays: origins and directions, in camera axes.
struct Spread {
  Range origin_x, origin_y, direction_x, direction_y;
};

/// The reference point: on the packet's middle ray at the slab's middle depth.
void place_reference(SlabFrame& frame, const Spread& rays, double depth, const View& view) {
  const Vector3d rows[3] = {view.axes.x, view.axes.y, view.axes.forward};
  frame.reference =
      view.eye + (rays.origin_x.middle() + depth * rays.direction_x.middle()) * rows[0] +
      (rays.origin_y.middle() + depth * rays.direction_y.middle()) * rows[1] + depth * rows[2];
  double largest = 0;
  for (int i = 0; i < 3; ++i) {
    frame.reference_high[i] = static_cast<float>(frame.reference[i]);
    frame.reference_low[i] = static_cast<float>(frame.reference[i] - frame.reference_high[i]);
    for (int j = 0; j < 3; ++j) frame.axes[i][j] = static_cast<float>(rows[i][j]);
    largest = std::max(largest, std::abs(frame.reference[i]));
  }
  frame.slack = static_cast<float>(1e-6 * (2 + largest));
}

void place_lanes(SlabFrame& frame, const RayPacket& packet, const Spread& rays, double depth) {
  frame.lanes = packet.lanes;
  for (int l = 0; l < packet.lanes; ++l) {
    const double x = packet.direction_x[l], y = packet.direction_y[l];
    frame.offset_x[l] = static_cast<float>(packet.origin_x[l] - rays.origin_x.middle() +
                                           depth * (x - rays.direction_x.middle()));
    frame.offset_y[l] = static_cast<float>(packet.origin_y[l] - rays.origin_y.middle() +
                                           depth * (y - rays.direction_y.middle()));
    frame.direction_x[l] = static_cast<float>(x);
    frame.direction_y[l] = static_cast<float>(y);
    frame.inverse_length_sq[l] = static_cast<float>(1 / (x * x + y * y + 1));
  }
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

void place_planes(SlabFrame& frame, const Spread& rays, double depth, const Slab& slab,
                  const View& view) {
  const auto sides = [&](int first, int axis, const Range& origin, const Range& direction) {
    const auto at_depth = [&](double o, double d) {
      return o - origin.middle() + depth * (d - direction.middle());
    };
    frame.planes[first] =
        make_side(frame, view.axes, axis, -1, at_depth(origin.low, direction.low), direction.low);
    frame.planes[first + 1] = make_side(frame, view.axes, axis, +1,
                                        at_depth(origin.high, direction.high), direction.high);
  };
  sides(0, 0, rays.origin_x, rays.direction_x);
  sides(2, 1, rays.origin_y, rays.direction_y);
  frame.planes[4] = make_plane(frame, view.axes, {0, 0, -1}, depth - slab.depth(0, view.step));
  frame.planes[5] =
      make_plane(frame, view.axes, {0, 0, 1}, slab.depth(slab.count - 1, view.step) - depth);
}

void measure_angles(SlabFrame& frame, const Spread& rays) {
  const double steep_x = rays.direction_x.largest(), steep_y = rays.direction_y.largest();
  const double flat_x = rays.direction_x.smallest(), flat_y = rays.direction_y.smallest();
  const double tangent_sq = steep_x * steep_x + steep_y * steep_y;
  frame.max_sine = static_cast<float>(std::sqrt(tangent_sq / (1 + tangent_sq)));
  frame.max_cosine = static_cast<float>(1 / std::sqrt(1 + flat_x * flat_x + flat_y * flat_y));
  const double cosine =
      steep_x * steep_y / std::sqrt((1 + steep_x * steep_x) * (1 + steep_y * steep_y));
  frame.corner_factor = static_cast<float>(1 / (1 + cosine));
}

}  // namespace

SlabFrame make_slab_frame(const RayPacket& packet, const Slab& slab, const View& view) {
  const Spread rays{
      range_of(packet.origin_x, packet.lanes), range_of(packet.origin_y, packet.lanes),
      range_of(packet.direction_x, packet.lanes), range_of(packet.direction_y, packet.lanes)};
  const double first = slab.depth(0, view.step), last = slab.depth(slab.count - 1, view.step);
  const double depth = 0.5 * (first + last);
  SlabFrame frame;
  frame.step = static_cast<float>(view.step);
  frame.first_depth = static_cast<float>(first - depth);
  frame.count = slab.count;
  place_reference(frame, rays, depth, view);
  place_lanes(frame, packet, rays, depth);
  place_planes(frame, rays, depth, slab, view);
  measure_angles(frame, rays);
  return frame;
}

}  // namespace motes
