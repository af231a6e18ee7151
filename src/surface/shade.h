// Balls and sticks in light: colours and depths of a tile's pixels, with ambient occlusion and
// shadows by further rays.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <vector>

#include "core/aligned.h"
#include "core/color.h"
#include "core/vec.h"
#include "samples/samples.h"
#include "scene/scene.h"
#include "surface/surface.h"
#include "surface/trace.h"

namespace motes {

/// Where a frame's rays are: pixel (px, py), counted from the top left, has n x n of them at even
/// distances; that in its middle would be at u = (2 (px + 1/2) / width - 1) half_width, v = (1 -
/// 2 (py + 1/2) / height) half_height (docs/field.md, "Samples").
struct ImagePlane {
  double half_width = 0, half_height = 0;  ///< tangents, or internal lengths if orthographic
  int width = 0, height = 0;               ///< pixels
  int samples = 1;                         ///< n
};

/// The rays of a tile's pixels and of `margin` more on each side.
RayGrid rays_of(const ImagePlane& plane, const Tile& tile, int margin);

/// The light, and what it reaches (docs/surface.md).
struct SurfaceShading {
  Lighting lighting;
  int occlusion_samples = 0;  ///< rays for each pixel's ambient occlusion; 0: there is none
  /// What is farther away occludes nothing; internal length.
  double occlusion_distance = std::numeric_limits<double>::infinity();
  bool shadows = false;     ///< of lights that have a direction; a headlight casts none
  double light_radius = 0;  ///< how large lights are seen: half their angle, radians; 0: a point
  int shadow_samples = 16;  ///< rays for each pixel's soft shadow, if light_radius > 0
  std::uint32_t seed = 0;   ///< of the directions of all these rays
};

/// Leaves out the directions along which something that is neither ball nor stick is nearer to a
/// place on a surface with that normal than `length`. Called by many threads at once.
using Pruner = std::function<void(const Point3d& place, const Vector3d& normal, double length,
                                  std::vector<Vector3f>& directions)>;

/// Everything that a frame's tiles share; made once a frame, then only read.
struct SurfaceFrame {
  const Surface* surface = nullptr;       ///< may be null where only its light is asked for
  const SurfaceColors* colors = nullptr;  ///< for the surface's particles
  SurfaceView view;
  ImagePlane plane;
  SurfaceShading shading;
  /// Directions of rays about +z, for each of the 8 x 8 pixels of a pattern that covers the image.
  std::vector<Vector3f> sky;
  /// And about the direction of each of the lights, in world axes; none for a headlight.
  std::vector<std::vector<Vector3f>> lamps;
  Pruner prune;  ///< what else hides the light; may be empty
  /// From how far that hides the sky; internal length.
  double prune_distance = std::numeric_limits<double>::infinity();
};

/// In the surface's own colours.
SurfaceFrame make_surface_frame(const Surface& surface, const SurfaceView& view,
                                const ImagePlane& plane, const SurfaceShading& shading);

/// The same without a surface: for the light alone of what else there is.
SurfaceFrame make_light_frame(const SurfaceView& view, const ImagePlane& plane,
                              const SurfaceShading& shading);

/// The n x n samples of a Tile's pixels as a picture of n * width columns and n * height rows.
struct SurfaceSamples {
  UninitializedVector<double> depth;  ///< along the view; infinity where nothing is hit
  UninitializedVector<Color> color;   ///< linear; of no meaning where nothing is hit
};

/// Renders `tile` into `out`. What a pixel is depends on the frame and the pixel alone, not on the
/// tile. Hot: nothing is checked. For one thread; tiles of 64 x 64 pixels do well, and larger ones
/// better where light is evened out, since a margin of 4 pixels is then traced with each.
void render_surface(const SurfaceFrame& frame, const Tile& tile, SurfaceSamples& out);

}  // namespace motes
