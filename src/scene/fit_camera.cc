// A camera that shows all of the data from a pleasing side.
#include <algorithm>
#include <array>

#include "scene/fit.h"

namespace motes {
namespace {

constexpr double margin = 0.94;       // of the image, that the data may fill
constexpr double default_fov = 45;    // degrees
constexpr double nearly_cubic = 0.8;  // thinnest by largest side
constexpr double flat = 1e-3;         // likewise: seen straight, as obliquely it would be a line
constexpr double nearly_parallel = 0.99;  // cosine

Vector3d unit(int axis) {
  Vector3d v;
  v[axis] = 1;
  return v;
}

/// Axis along which the box is thinnest, z where none is much thinner.
int viewing_axis(const Vector3d& sides) {
  int thinnest = 2;
  for (int axis = 0; axis < 2; ++axis) {
    if (sides[axis] < sides[thinnest]) thinnest = axis;
  }
  const double largest = std::max({sides.x, sides.y, sides.z});
  return sides[thinnest] < nearly_cubic * largest ? thinnest : 2;
}

/// From the target towards the eye, not of unit length.
Vector3d direction_to_eye(const Vector3d& sides, const Vector3d* up) {
  const double largest = std::max({sides.x, sides.y, sides.z});
  int axis = viewing_axis(sides);
  if (up != nullptr && std::abs(normalize(*up)[axis]) > nearly_parallel) axis = axis == 2 ? 1 : 2;
  // From the front, a little from the right and from above.
  const Vector3d above = up != nullptr ? normalize(*up) : unit(axis == 2 ? 1 : 2);
  Vector3d front = axis == 1 ? -unit(axis) : unit(axis);
  const Vector3d right = cross(above, front);
  if (sides[axis] < flat * largest) return front;
  return front + 0.4 * right + 0.3 * above;
}

/// The direction that is up where the scene does not say: the axis among y and z (in this order)
/// that is far enough from the view.
Vector3d default_up(const Vector3d& view, int axis) {
  const Vector3d first = unit(axis == 2 ? 1 : 2), second = unit(axis == 2 ? 2 : 1);
  return std::abs(dot(normalize(view), first)) < nearly_parallel ? first : second;
}

std::array<Point3d, 8> corners_of(const Bounds3d& box) {
  std::array<Point3d, 8> corners;
  for (int k = 0; k < 8; ++k) {
    corners[static_cast<std::size_t>(k)] = {k & 1 ? box.max.x : box.min.x,
                                            k & 2 ? box.max.y : box.min.y,
                                            k & 4 ? box.max.z : box.min.z};
  }
  return corners;
}

}  // namespace

Camera fit_camera(const Scene& scene, const Bounds3d& box, double aspect) {
  const Vector3d sides = box.diagonal();
  const double diagonal = length(sides) > 0 ? length(sides) : 1;
  Camera camera;
  camera.fov_degrees = scene.fov_degrees.value_or(default_fov);
  camera.orthographic_height = scene.orthographic_height;
  camera.target = scene.target.value_or(box.center());
  camera.eye =
      scene.eye.value_or(camera.target + direction_to_eye(sides, scene.up ? &*scene.up : nullptr));
  if (scene.eye && !scene.target && camera.eye == camera.target) {
    camera.target = camera.eye - direction_to_eye(sides, nullptr);
  }
  camera.up = scene.up.value_or(default_up(camera.target - camera.eye, viewing_axis(sides)));
  const CameraAxes axes = camera_axes(camera);
  if (scene.eye) return camera;

  // Far enough away that no corner is outside the image.
  const double tan_y = margin * std::tan(camera.fov_degrees * M_PI / 360), tan_x = tan_y * aspect;
  double distance = 0;
  for (const Point3d& corner : corners_of(box)) {
    const Vector3d v = corner - camera.target;
    const double across =
        std::max(std::abs(dot(v, axes.x)) / tan_x, std::abs(dot(v, axes.y)) / tan_y);
    const double depth = dot(v, axes.forward);
    distance =
        std::max(distance, camera.orthographic_height ? -depth + 0.01 * diagonal : across - depth);
  }
  camera.eye = camera.target - std::max(distance, 1e-3 * diagonal) * axes.forward;
  return camera;
}

}  // namespace motes
