// Balls and sticks as layers in the way of rays.
#pragma once

#include "image/framebuffer.h"
#include "samples/layers.h"
#include "surface/shade.h"

namespace motes {

/// The layers that the frame's n x n rays of each pixel of `tile` meet: each ray is a share of its
/// pixel. Those of a pixel within `thickness` (internal length) are made one.
void find_layers(const SurfaceFrame& frame, double thickness, const Tile& tile, TileLayers& out);

/// Composites layers with nothing between them into `image`.
void composite_layers(const TileLayers& layers, const Tile& tile, Framebuffer& image);

}  // namespace motes
