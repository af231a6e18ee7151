#include "render/ray_packets.h"

#include <algorithm>
#include <cmath>

namespace motes {
namespace {

struct DepthRange {
  double near, far;  // near > far: the ray misses the box
};

/// Depths at which origin + z direction lies in the box, faces included.
DepthRange clip(const Bounds3d& box, const Point3d& origin, const Vector3d& direction) {
  DepthRange range{0, std::numeric_limits<double>::max()};
  for (int axis = 0; axis < 3; ++axis) {
    if (direction[axis] == 0) {
      if (origin[axis] < box.min[axis] || origin[axis] > box.max[axis]) return {1, 0};
      continue;
    }
    const double a = (box.min[axis] - origin[axis]) / direction[axis];
    const double b = (box.max[axis] - origin[axis]) / direction[axis];
    range.near = std::max(range.near, std::min(a, b));
    range.far = std::min(range.far, std::max(a, b));
  }
  return range;
}

}  // namespace

RayPacket make_ray_packet(const FrameContext& context, int px, int py, int width, int height) {
  RayPacket packet;
  packet.lanes = width * height;
  const View& view = context.view;
  const auto& [axis_x, axis_y, forward] = view.axes;
  for (int l = 0; l < packet.lanes; ++l) {
    const int x = px + l % width, y = py + l / width;
    const double u = (2 * (x + 0.5) / context.width - 1) * context.half_width;
    const double v = (1 - 2 * (y + 0.5) / context.height) * context.half_height;
    packet.origin_x[l] = context.orthographic ? u : 0;
    packet.origin_y[l] = context.orthographic ? v : 0;
    packet.direction_x[l] = context.orthographic ? 0 : u;
    packet.direction_y[l] = context.orthographic ? 0 : v;
    packet.first[l] = 0;
    packet.last[l] = -1;
    if (x >= context.width || y >= context.height) continue;

    const Point3d origin = view.eye + packet.origin_x[l] * axis_x + packet.origin_y[l] * axis_y;
    const Vector3d direction =
        packet.direction_x[l] * axis_x + packet.direction_y[l] * axis_y + forward;
    const DepthRange range = clip(context.box, origin, direction);
    if (range.near > range.far) continue;
    packet.first[l] = static_cast<SampleIndex>(std::ceil(range.near / view.step - 0.5));
    packet.last[l] = static_cast<SampleIndex>(std::floor(range.far / view.step - 0.5));
  }
  return packet;
}

}  // namespace motes
