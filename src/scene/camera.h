// Where the picture is taken from. The conventions are those of docs/field.md, "Samples".
#pragma once

#include <optional>

#include "core/vec.h"

namespace motes {

struct Camera {
  Point3d eye{0, 0, 0};
  Point3d target{0, 0, -1};
  Vector3d up{0, 1, 0};
  double fov_degrees = 45;  ///< vertical, in (0, 180)
  /// Set: parallel rays, this height of the image in length units.
  std::optional<double> orthographic_height;

  bool operator==(const Camera&) const = default;
};

/// Orthonormal right-handed axes of the camera in the world: F = normalize(target - eye),
/// X = normalize(F x up), Y = X x F.
struct CameraAxes {
  Vector3d x, y, forward;
};

/// Throws Error if eye and target coincide, up is parallel to the view, or fov is out of range.
CameraAxes camera_axes(const Camera& camera);

/// Half of the image's height at depth 1: a tangent; of an orthographic camera half of its height,
/// a length.
double half_height(const Camera& camera);

}  // namespace motes
