// Isosurfaces in light: what the rays of a tile's pixels meet.
#pragma once

#include <vector>

#include "isosurface/isosurface.h"
#include "samples/samples.h"
#include "scene/scene.h"
#include "surface/shade.h"

namespace motes {

struct ShadedIsosurfaces {
  IsosurfaceFrame frame;
  SurfaceFrame light;  ///< with the balls and sticks that hide light, if there are any
};

/// The hits of a tile's n x n rays a pixel, in light: ray by ray, from the front, the rays row by
/// row. For one thread.
void shade_isosurfaces(const ShadedIsosurfaces& isosurfaces, const Tile& tile,
                       std::vector<IsosurfaceHit>& out);

}  // namespace motes
