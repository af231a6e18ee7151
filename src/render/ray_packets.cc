#include "render/ray_packets.h"

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
  double u[max_lanes], v[max_lanes];
  for (int x = 0; x < width; ++x) u[x] = column_place(context, px + x);
  for (int y = 0; y < height; ++y) v[y] = row_place(context, py + y);
  for (int l = 0; l < packet.lanes; ++l) {
    packet.origin_x[l] = context.orthographic ? u[l % width] : 0;
    packet.origin_y[l] = context.orthographic ? v[l / width] : 0;
    packet.direction_x[l] = context.orthographic ? 0 : u[l % width];
    packet.direction_y[l] = context.orthographic ? 0 : v[l / width];
  }
  return packet;
}

RayBounds make_ray_bounds(const FrameContext& context, int px, int py, int width, int height) {
  const Range columns{column_place(context, px), column_place(context, px + width - 1)};
  const Range rows{row_place(context, py + height - 1), row_place(context, py)};
  if (context.orthographic) return {columns, rows, {}, {}};
  return {{}, {}, columns, rows};
}

}  // namespace motes
