// Surfaces as layers in the way of pixels' rays.
#pragma once

#include "image/framebuffer.h"
#include "isosurface/shade_isosurfaces.h"
#include "samples/layers.h"
#include "surface/shade.h"

namespace motes {

/// What there is of surfaces in a frame; either may be null.
struct FrameSurfaces {
  const SurfaceFrame* solids = nullptr;  ///< balls and sticks
  const ShadedIsosurfaces* isosurfaces = nullptr;

  bool any() const { return solids != nullptr || isosurfaces != nullptr; }
};

/// The layers that a tile's rays meet, n x n a pixel; of a pixel's hits those within `thickness`
/// are one. There is one of the surfaces at least.
void find_layers(const FrameSurfaces& surfaces, double thickness, const Tile& tile,
                 TileLayers& out);

/// Puts layers alone into an image: a scene without volumes.
void composite_layers(const TileLayers& layers, const Tile& tile, Framebuffer& image);

}  // namespace motes
