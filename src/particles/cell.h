// The simulation cell: a parallelepiped that repeats along the axes that are periodic.
#pragma once

#include <array>

#include "core/vec.h"

namespace motes {

struct Cell {
  Point3d origin;                   ///< the corner from which the vectors start, world coordinates
  std::array<Vector3d, 3> vectors;  ///< edges a, b, c; file's length unit
  std::array<bool, 3> periodic{true, true, true};

  bool operator==(const Cell&) const = default;
};

}  // namespace motes
