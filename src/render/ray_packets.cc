#include "render/ray_packets.h"

#include <algorithm>

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
  double* const u = context.orthographic ? packet.origin_x : packet.direction_x;
  double* const v = context.orthographic ? packet.origin_y : packet.direction_y;
  double* const no_u = context.orthographic ? packet.direction_x : packet.origin_x;
  double* const no_v = context.orthographic ? packet.direction_y : packet.origin_y;
  std::fill_n(no_u, packet.lanes, 0.0);
  std::fill_n(no_v, packet.lanes, 0.0);
  for (int y = 0; y < height; ++y) {
    std::fill_n(v + y * width, width, row_place(context, py + y));
  }
  for (int x = 0; x < width; ++x) {
    const double place = column_place(context, px + x);
    for (int y = 0; y < height; ++y) u[y * width + x] = place;
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
