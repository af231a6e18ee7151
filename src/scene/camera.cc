// The camera's axes, and what makes a camera impossible.
#include "scene/camera.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "core/error.h"

namespace motes {
namespace {

// Below this sine of the angle between up and the view, the picture's roll is rounding error.
constexpr double smallest_sine = 1e-9;

bool finite(double x, double y, double z) {
  return std::isfinite(x) && std::isfinite(y) && std::isfinite(z);
}

}  // namespace

CameraAxes camera_axes(const Camera& camera) {
  const Vector3d view = camera.target - camera.eye;
  if (!finite(view.x, view.y, view.z)) throw Error("camera.eye: must be finite, as the target");
  if (!(length(view) > 0)) {
    throw Error("camera.eye: is the same point as the target; expected two different ones");
  }
  if (!finite(camera.up.x, camera.up.y, camera.up.z) || !(length(camera.up) > 0)) {
    throw Error("camera.up: a direction must not be zero");
  }
  if (camera.orthographic_height) {
    const double height = *camera.orthographic_height;
    if (!std::isfinite(height) || !(height > 0)) {
      throw Error(
          fmt::format("camera.orthographic: the height is {}; expected more than 0", height));
    }
  } else if (!(camera.fov_degrees > 0 && camera.fov_degrees < 180)) {
    throw Error(fmt::format("camera.fov: is {} degrees; expected more than 0 and less than 180",
                            camera.fov_degrees));
  }

  CameraAxes axes;
  axes.forward = normalize(view);
  const Vector3d right = cross(axes.forward, normalize(camera.up));
  if (!(length(right) > smallest_sine)) {
    throw Error(
        "camera.up: is parallel to the view from eye to target; expected another direction");
  }
  axes.x = normalize(right);
  axes.y = cross(axes.x, axes.forward);
  return axes;
}

double half_height(const Camera& camera) {
  if (camera.orthographic_height) return 0.5 * *camera.orthographic_height;
  return std::tan(0.5 * camera.fov_degrees * std::numbers::pi / 180);
}

}  // namespace motes
