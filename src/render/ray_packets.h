// The rays of a block of pixels (docs/field.md, "Samples").
#pragma once

#include "render/render_tile.h"
#include "samples/samples.h"

namespace motes {

/// A packet of width x height rays whose top left pixel is (px, py), lanes row by row.
RayPacket make_ray_packet(const FrameContext& context, int px, int py, int width, int height);

/// What the rays of width x height pixels are within.
RayBounds make_ray_bounds(const FrameContext& context, int px, int py, int width, int height);

}  // namespace motes
