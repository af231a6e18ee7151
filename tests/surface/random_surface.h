// Small surfaces drawn at random from everything that one can be, and views of them.
#pragma once

#include <memory>
#include <random>
#include <string>

#include "field/kernel_set.h"
#include "surface/surface.h"
#include "surface/trace.h"

namespace motes {

struct RandomSurface {
  std::unique_ptr<KernelSet> kernels;
  Surface surface;
  double spacing = 1;       ///< mean distance of particles, internal
  std::string description;  ///< what was drawn, for messages
};

/// That of a seed, always the same: up to some hundred particles with balls of one radius, of
/// various ones, with none, or of radii from 1e-4 to 1e4 spacings, with sticks or without.
RandomSurface random_surface(unsigned seed);

/// Some rays of a camera.
struct RandomView {
  SurfaceView view;
  RayGrid grid;
  std::string description;
};

/// From outside, from within, from 1e4 spacings away, or orthographic.
RandomView random_view(const RandomSurface& scene, unsigned seed);

}  // namespace motes
