// How much of the light reaches places on surfaces.
#pragma once

#include <span>
#include <vector>

#include "core/vec.h"
#include "surface/shade.h"
#include "surface/spots.h"

namespace motes {

/// Whether light is to be looked for once a spot, and then evened out.
bool has_spots(const SurfaceShading& shading);
bool has_hard_shadows(const SurfaceShading& shading);

/// Sets the light of a pixel's spots, the pixel being of that number of the pattern.
/// `scratch`: for its own use.
void look_for_light(const SurfaceFrame& frame, std::span<Spot> spots, int number,
                    std::vector<Vector3f>& scratch);

/// For each light that has a direction: 1 where it reaches a point, else 0.
void add_hard_shadows(const SurfaceFrame& frame, const SurfacePoint& point, const Vector3d& normal,
                      Light& light, std::vector<Vector3f>& scratch);

}  // namespace motes
