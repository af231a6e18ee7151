// A ray through a place in the picture.
#pragma once

#include "core/vec.h"
#include "scene/camera.h"

namespace motes {

/// Its points are origin + z * direction, at depth z.
struct ViewRay {
  Point3d origin;
  Vector3d direction;

  Point3d at(double z) const { return origin + z * direction; }
};

/// The ray through the point (s, t) of the image, both in [0, 1], from the left and from the top.
inline ViewRay view_ray(const Camera& camera, const CameraAxes& axes, double aspect, double s,
                        double t) {
  const double half = half_height(camera);
  const Vector3d across = (2 * s - 1) * half * aspect * axes.x + (1 - 2 * t) * half * axes.y;
  if (camera.orthographic_height) return {camera.eye + across, axes.forward};
  return {camera.eye, across + axes.forward};
}

}  // namespace motes
