// A camera that shows all of the data from a pleasing side.
#include <algorithm>
#include <array>
#include <limits>
#include <numbers>

#include "scene/fit.h"

namespace motes {
namespace {

constexpr double margin = 0.97;       // of the image, that the data may fill
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

  // As near as all corners allow. With the camera moved by (x, y) across the view, a corner at (u,
  // v, w) in camera axes about the target is in the image where |u - x| <= tan_x (distance + w),
  // and so in y.
  const double tan_y =
      margin *
      (camera.orthographic_height ? 1 : std::tan(camera.fov_degrees * std::numbers::pi / 360));
  const double tan_x = tan_y * aspect;
  constexpr double none = std::numeric_limits<double>::lowest();
  double right = none, left = none, top = none, bottom = none, nearest = none;
  for (const Point3d& corner : corners_of(box)) {
    const Vector3d v = corner - camera.target;
    const double w = camera.orthographic_height ? 0 : dot(v, axes.forward);
    right = std::max(right, dot(v, axes.x) / tan_x - w);
    left = std::max(left, -dot(v, axes.x) / tan_x - w);
    top = std::max(top, dot(v, axes.y) / tan_y - w);
    bottom = std::max(bottom, -dot(v, axes.y) / tan_y - w);
    nearest = std::max(nearest, -dot(v, axes.forward));
  }
  double distance = std::max({right, left, top, bottom});
  if (!scene.target) {
    camera.target =
        camera.target + tan_x * (right - left) / 2 * axes.x + tan_y * (top - bottom) / 2 * axes.y;
    distance = std::max(right + left, top + bottom) / 2;
  }
  if (camera.orthographic_height) distance = nearest + 0.01 * diagonal;
  camera.eye = camera.target - std::max(distance, 1e-3 * diagonal) * axes.forward;
  return camera;
}

}  // namespace motes
