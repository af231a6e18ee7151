// Small scenes drawn at random from everything that a scene can be, to hold the engines against the
// reference.
#pragma once

#include <cstdint>
#include <string>

#include "particles/particle_set.h"
#include "scene/scene.h"

namespace motes {

struct RandomScene {
  ParticleSet particles;
  ResolvedScene scene;
  std::string description;  ///< what was drawn, for messages
};

/// The scene of a seed, always the same: at most some hundred particles in 1 to 8 fields, at any
/// length and weight scale, near or far from the origin, seen by any camera in a small odd-sized
/// picture.
RandomScene random_scene(std::uint32_t seed);

/// The same with one to three fields that are grids, of any shape, partly in the scene's box, among
/// the fields of particles or, in every other scene, in their place.
RandomScene random_grid_scene(std::uint32_t seed);

}  // namespace motes
