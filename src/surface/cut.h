// Clip planes for balls and sticks.
#pragma once

#include <span>

#include "scene/clip_plane.h"
#include "surface/surface.h"

namespace motes {

/// What is left of `surface`: the balls and sticks of particles whose centre no plane cuts away;
/// without colours.
/// `planes` are in internal lengths from the kernels' origin, their normals of unit length.
Surface cut(const Surface& surface, std::span<const ClipPlane> planes);

}  // namespace motes
