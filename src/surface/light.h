// How much of the light reaches places on surfaces.
#pragma once

#include <vector>

#include "core/vec.h"
#include "surface/shade.h"
#include "surface/spots.h"

namespace motes {

/// Whether light is to be looked for once a spot, and then evened out.
bool has_spots(const SurfaceShading& shading);
bool has_hard_shadows(const SurfaceShading& shading);

/// The light of a spot in a pixel of that number of the pattern. `scratch`: for its own use.
Light light_of(const SurfaceFrame& frame, const Spot& spot, int number,
               std::vector<Vector3f>& scratch);

/// For each light that has a direction: 1 where it reaches a point, else 0.
void add_hard_shadows(const SurfaceFrame& frame, const SurfacePoint& point, const Vector3d& normal,
                      Light& light, std::vector<Vector3f>& scratch);

}  // namespace motes
