// The hot path, called as a function: by the instruction set in use, for arrays of points.
#pragma once

#include <vector>

#include "grid/grid_sampler.h"

namespace motes {

/// Index coordinates in, value and gradient per index out; `inside` is what the hull test says.
struct PointSamples {
  std::vector<float> x, y, z;
  std::vector<float> value, dx, dy, dz;
  std::vector<bool> inside;
};

void sample_points(const GridView& grid, bool gradients, PointSamples& points);

}  // namespace motes
