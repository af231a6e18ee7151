#include "field/slab_frame.h"

#include <algorithm>

namespace motes {
namespace {

struct Range {
  double low, high;
  double middle() const { return 0.5 * (low + high); }
};

Range range_of(const double* values, int n) {
  const auto [low, high] = std::minmax_element(values, values + n);
  return {*low, *high};
}

}  // namespace

SlabFrame make_slab_frame(const RayPacket& packet, const Slab& slab, const View& view) {
  SlabFrame frame;
  const Range ox = range_of(packet.origin_x, packet.lanes),
              oy = range_of(packet.origin_y, packet.lanes);
  const Range dx = range_of(packet.direction_x, packet.lanes),
              dy = range_of(packet.direction_y, packet.lanes);
  const auto& [axis_x, axis_y, forward] = view.axes;

  // The reference: the packet's middle ray at the slab's middle depth.
  const double depth = 0.5 * (slab.depth(0, view.step) + slab.depth(slab.count - 1, view.step));
  frame.reference_depth = depth;
  frame.reference = view.eye + (ox.middle() + depth * dx.middle()) * axis_x +
                    (oy.middle() + depth * dy.middle()) * axis_y + depth * forward;
  const Vector3d rows[3] = {axis_x, axis_y, forward};
  for (int i = 0; i < 3; ++i) {
    frame.reference_high[i] = static_cast<float>(frame.reference[i]);
    frame.reference_low[i] = static_cast<float>(frame.reference[i] - frame.reference_high[i]);
    for (int j = 0; j < 3; ++j) frame.axes[i][j] = static_cast<float>(rows[i][j]);
  }
  const auto& r = frame.reference;
  frame.slack =
      static_cast<float>(1e-6 * (2 + std::max({std::abs(r.x), std::abs(r.y), std::abs(r.z)})));
  frame.step = static_cast<float>(view.step);
  frame.count = slab.count;
  frame.lanes = packet.lanes;
  frame.first_depth = static_cast<float>(slab.depth(0, view.step) - depth);

  for (int l = 0; l < packet.lanes; ++l) {
    frame.offset_x[l] = static_cast<float>(packet.origin_x[l] - ox.middle() +
                                           depth * (packet.direction_x[l] - dx.middle()));
    frame.offset_y[l] = static_cast<float>(packet.origin_y[l] - oy.middle() +
                                           depth * (packet.direction_y[l] - dy.middle()));
    frame.direction_x[l] = static_cast<float>(packet.direction_x[l]);
    frame.direction_y[l] = static_cast<float>(packet.direction_y[l]);
    const double x = packet.direction_x[l], y = packet.direction_y[l];
    frame.inverse_length_sq[l] = static_cast<float>(1 / (x * x + y * y + 1));
  }

  // Sides through the outermost rays, then the planes of the first and the last sample.
  const auto set_plane = [&](int i, const Vector3d& normal, double offset) {
    FrustumPlane& plane = frame.planes[i];
    plane.x = static_cast<float>(normal.x);
    plane.y = static_cast<float>(normal.y);
    plane.z = static_cast<float>(normal.z);
    plane.offset = static_cast<float>(offset);
    const Vector3d world = normal.x * axis_x + normal.y * axis_y + normal.z * forward;
    for (int j = 0; j < 3; ++j) plane.world[j] = static_cast<float>(world[j]);
    plane.world_offset = static_cast<float>(
        offset + dot(world, Vector3d{frame.reference.x, frame.reference.y, frame.reference.z}));
  };
  const auto set_side = [&](int i, int axis, double sign, double direction, double origin) {
    const double norm = 1 / std::sqrt(1 + direction * direction);
    Vector3d normal{0, 0, -sign * direction * norm};
    normal[axis] = sign * norm;
    set_plane(i, normal, sign * norm * origin);
  };
  set_side(0, 0, -1, dx.low, ox.low - ox.middle() + depth * (dx.low - dx.middle()));
  set_side(1, 0, +1, dx.high, ox.high - ox.middle() + depth * (dx.high - dx.middle()));
  set_side(2, 1, -1, dy.low, oy.low - oy.middle() + depth * (dy.low - dy.middle()));
  set_side(3, 1, +1, dy.high, oy.high - oy.middle() + depth * (dy.high - dy.middle()));
  set_plane(4, {0, 0, -1}, -(slab.depth(0, view.step) - depth));
  set_plane(5, {0, 0, 1}, slab.depth(slab.count - 1, view.step) - depth);

  const double steepest_x = std::max(std::abs(dx.low), std::abs(dx.high));
  const double steepest_y = std::max(std::abs(dy.low), std::abs(dy.high));
  const double flattest_x =
      dx.low * dx.high <= 0 ? 0 : std::min(std::abs(dx.low), std::abs(dx.high));
  const double flattest_y =
      dy.low * dy.high <= 0 ? 0 : std::min(std::abs(dy.low), std::abs(dy.high));
  const double tangent_sq = steepest_x * steepest_x + steepest_y * steepest_y;
  frame.max_sine = static_cast<float>(std::sqrt(tangent_sq / (1 + tangent_sq)));
  frame.max_cosine =
      static_cast<float>(1 / std::sqrt(1 + flattest_x * flattest_x + flattest_y * flattest_y));
  const double cosine = steepest_x * steepest_y /
                        std::sqrt((1 + steepest_x * steepest_x) * (1 + steepest_y * steepest_y));
  frame.corner_factor = static_cast<float>(1 / (1 + cosine));
  return frame;
}

}  // namespace motes
