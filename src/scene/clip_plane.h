// Planes that cut away a part of what is drawn.
#pragma once

#include "core/vec.h"

namespace motes {

/// Cuts away the points x with normal . x > distance |normal|: what lies on the side to which the
/// normal points. Not zero.
struct ClipPlane {
  Vector3d normal{1, 0, 0};
  double distance = 0;  ///< of the plane from the origin, along the normal
  bool operator==(const ClipPlane&) const = default;
};

}  // namespace motes
