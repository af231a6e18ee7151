#include "render/ray_packets.h"

#include <cmath>

#include "render/clip.h"

namespace motes {
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
