// What is seen at a pixel.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/vec.h"
#include "document/document.h"

namespace motes {

struct Pick {
  std::uint32_t particle = 0;  ///< index into the ParticleSet
  Point3d place;               ///< what is seen there; file's lengths
  double distance = 0;         ///< of `place` from the eye
  std::vector<double> values;  ///< of the visible fields, there; NaN outside of a grid
};

/// The particle under the pixel at (x, y), counted from the left top, in a picture of that size. The
/// place is where the ray meets a ball or a stick, crosses an isosurface, or has met half of the
/// opacity that it meets in the volume, whichever is first; the particle is the ball's or, of those
/// of the visible fields, the one whose kernel is largest there. nullopt where the picture shows
/// next to nothing, or no particle is near.
std::optional<Pick> pick(const Document& document, const Camera& camera, int width, int height,
                         double x, double y);

}  // namespace motes
