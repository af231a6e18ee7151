// The rays of a block of pixels, and which samples of them lie in the volume (docs/field.md,
// "Samples").
#pragma once

#include "render/render_tile.h"
#include "samples/samples.h"

namespace motes {

/// A packet of width x height rays whose top left pixel is (px, py), lanes row by row.
RayPacket make_ray_packet(const FrameContext& context, int px, int py, int width, int height);

/// The rays of that packet before their first sample. Lanes outside the image have no samples.
RayState make_ray_state(const FrameContext& context, int px, int py, int width, int height);

/// What the rays of width x height pixels are within.
RayBounds make_ray_bounds(const FrameContext& context, int px, int py, int width, int height);

}  // namespace motes
