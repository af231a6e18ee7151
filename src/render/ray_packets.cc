#include "render/ray_packets.h"

#include <cmath>

#include "render/clip.h"

namespace motes {
namespace {

/// Place of a column's and a row's pixel centres in the image: tangents, or internal lengths.
double column_place(const FrameContext& context, int x) {
  return (2 * (x + 0.5) / context.width - 1) * context.half_width;
}
double row_place(const FrameContext& context, int y) {
  return (1 - 2 * (y + 0.5) / context.height) * context.half_height;
}

}  // namespace

RayPacket make_ray_packet(const FrameContext& context, int px, int py, int width, int height) {
  RayPacket packet;
  packet.lanes = width * height;
  for (int l = 0; l < packet.lanes; ++l) {
    const double u = column_place(context, px + l % width);
    const double v = row_place(context, py + l / width);
    packet.origin_x[l] = context.orthographic ? u : 0;
    packet.origin_y[l] = context.orthographic ? v : 0;
    packet.direction_x[l] = context.orthographic ? 0 : u;
    packet.direction_y[l] = context.orthographic ? 0 : v;
  }
  return packet;
}

RayState make_ray_state(const FrameContext& context, int px, int py, int width, int height) {
  const RayPacket packet = make_ray_packet(context, px, py, width, height);
  const View& view = context.view;
  const auto& [axis_x, axis_y, forward] = view.axes;
  RayState rays{};
  for (int l = 0; l < packet.lanes; ++l) {
    rays.direction_x[l] = static_cast<float>(packet.direction_x[l]);
    rays.direction_y[l] = static_cast<float>(packet.direction_y[l]);
    rays.last[l] = -1;
    if (px + l % width >= context.width || py + l / width >= context.height) continue;

    const Point3d origin = view.eye + packet.origin_x[l] * axis_x + packet.origin_y[l] * axis_y;
    const Vector3d direction =
        packet.direction_x[l] * axis_x + packet.direction_y[l] * axis_y + forward;
    const DepthRange range = clip(context.box, origin, direction);
    if (range.near > range.far) continue;
    const auto first_plane = static_cast<double>(view.planes.first);
    const double first = std::ceil(range.near / view.planes.step - 0.5) - first_plane;
    const double last = std::floor(range.far / view.planes.step - 0.5) - first_plane;
    if (first > last) continue;
    rays.first[l] = static_cast<float>(first);
    rays.last[l] = static_cast<float>(last);
  }
  return rays;
}

RayBounds make_ray_bounds(const FrameContext& context, int px, int py, int width, int height) {
  const Range columns{column_place(context, px), column_place(context, px + width - 1)};
  const Range rows{row_place(context, py + height - 1), row_place(context, py)};
  if (context.orthographic) return {columns, rows, {}, {}};
  return {{}, {}, columns, rows};
}

}  // namespace motes
