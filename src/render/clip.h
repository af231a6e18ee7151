// Where a ray runs through a box.
#pragma once

#include <algorithm>
#include <limits>

#include "core/vec.h"

namespace motes {

/// Depths along a ray; near > far where it misses.
struct DepthRange {
  double near, far;
};

/// Depths z >= 0 at which origin + z direction lies in the box, faces included.
inline DepthRange clip(const Bounds3d& box, const Point3d& origin, const Vector3d& direction) {
  DepthRange range{0, std::numeric_limits<double>::max()};
  for (int axis = 0; axis < 3; ++axis) {
    if (direction[axis] == 0) {
      if (origin[axis] < box.min[axis] || origin[axis] > box.max[axis]) return {1, 0};
      continue;
    }
    const double a = (box.min[axis] - origin[axis]) / direction[axis];
    const double b = (box.max[axis] - origin[axis]) / direction[axis];
    range.near = std::max(range.near, std::min(a, b));
    range.far = std::min(range.far, std::max(a, b));
  }
  return range;
}

}  // namespace motes
