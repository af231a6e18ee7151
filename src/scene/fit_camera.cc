// A camera that shows all of the data from a pleasing side.
#include <algorithm>
#include <numbers>
#include <random>

#include "scene/fit.h"

namespace motes {
namespace {

constexpr double margin = 0.96;       // of the image, that the data may fill
constexpr double default_fov = 45;    // degrees
constexpr double nearly_cubic = 0.8;  // thinnest by largest side
constexpr double flat = 1e-3;         // likewise: seen straight, as obliquely it would be a line
constexpr double nearly_parallel = 0.99;  // cosine
constexpr double easily_seen = 1.75;      // standard deviations: there a Gaussian is at a fifth
constexpr double large = 2.5;             // times the middle radius
constexpr std::size_t particles_looked_at = 1 << 18;  // of one field

// Strays: one particle in so many at most, farther out than this times the extent of the others.
constexpr std::size_t stray_share = 1000;
constexpr double stray_distance = 0.5;

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

/// The largest of `values`, without those of strays; reorders them. Precondition: not empty.
double largest_but_strays(std::vector<double>& values) {
  const std::size_t strays = values.size() / stray_share;
  const double largest = *std::max_element(values.begin(), values.end());
  const auto at = [&values](std::size_t rank) {
    const auto it = values.begin() + static_cast<std::ptrdiff_t>(rank);
    std::nth_element(values.begin(), it, values.end());
    return *it;
  };
  const double high = at(values.size() - 1 - strays), low = at(strays);
  return largest - high > stray_distance * (high - low) ? high : largest;
}

/// The largest of measure(sphere), without strays'.
template <class F>
double largest_of(const std::vector<VisibleSphere>& spheres, F&& measure) {
  std::vector<double> values(spheres.size());
  std::transform(spheres.begin(), spheres.end(), values.begin(), measure);
  return largest_but_strays(values);
}

Bounds3d box_of(const std::vector<VisibleSphere>& spheres) {
  Point3d corner[2];
  for (int axis = 0; axis < 3; ++axis) {
    corner[0][axis] =
        -largest_of(spheres, [axis](const VisibleSphere& s) { return s.radius - s.center[axis]; });
    corner[1][axis] =
        largest_of(spheres, [axis](const VisibleSphere& s) { return s.radius + s.center[axis]; });
  }
  return {corner[0], corner[1]};
}

/// Adds the corners of all grids, so often that they are no strays.
void add_corners(const std::vector<FieldSource>& fields, std::vector<VisibleSphere>& spheres) {
  const std::size_t times = 1 + spheres.size() / stray_share;
  for (const FieldSource& field : fields) {
    if (!field.grid) continue;
    const std::array<Point3d, 8> corners = corners_of(*field.grid);
    for (std::size_t n = 0; n < times; ++n) {
      for (const Point3d& corner : corners) spheres.push_back({corner, 0});
    }
  }
}

}  // namespace

std::vector<VisibleSphere> visible_spheres(const ParticleSet& particles,
                                           const std::vector<FieldSource>& fields,
                                           const GeometrySource& geometry) {
  std::vector<VisibleSphere> spheres;
  std::mt19937 random(1);  // evenly many would beat with a lattice
  for (const FieldSource& field : fields) {
    const double widths = field.kernel.support() / field.kernel.standard_deviation();
    const double extent = std::min(widths, easily_seen);
    const std::size_t stride = 1 + field.index.size() / particles_looked_at;
    for (std::size_t begin = 0; begin < field.index.size(); begin += stride) {
      const std::size_t i = std::min(begin + random() % stride, field.index.size() - 1);
      spheres.push_back({particles.position(field.index[i]), extent * field.width_of(i)});
    }
  }
  const std::size_t stride = 1 + geometry.index.size() / particles_looked_at;
  for (std::size_t begin = 0; begin < geometry.index.size(); begin += stride) {
    const std::size_t i = std::min(begin + random() % stride, geometry.index.size() - 1);
    spheres.push_back({particles.position(geometry.index[i]), geometry.radius[i]});
  }
  if (spheres.empty()) {
    add_corners(fields, spheres);
    // Nothing is drawn: the place where something could be.
    if (const Bounds3d box = particles.bounds(); spheres.empty() && !box.empty()) {
      spheres = {{box.min, 0}, {box.max, 0}};
    }
    return spheres;
  }
  std::vector<double> radii(spheres.size());
  std::transform(spheres.begin(), spheres.end(), radii.begin(),
                 [](const VisibleSphere& sphere) { return sphere.radius; });
  const auto middle = radii.begin() + static_cast<std::ptrdiff_t>(radii.size() / 2);
  std::nth_element(radii.begin(), middle, radii.end());
  for (VisibleSphere& sphere : spheres) sphere.radius = std::min(sphere.radius, large * *middle);
  add_corners(fields, spheres);
  return spheres;
}

Camera fit_camera(const Scene& scene, const std::vector<VisibleSphere>& spheres, double aspect) {
  if (scene.eye && scene.target && scene.up) {
    const Camera given{*scene.eye, *scene.target, *scene.up,
                       scene.fov_degrees.value_or(default_fov), scene.orthographic_height};
    camera_axes(given);
    return given;
  }
  const Bounds3d box = box_of(spheres);
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

  // As near as all spheres allow. With the camera moved by (x, y) across the view, a sphere of
  // radius r at (u, v, w) in camera axes about the target is in the image where
  // |u - x| + r sqrt(1 + tan_x^2) <= tan_x (distance + w), and so in y.
  const double tan_y =
      margin *
      (camera.orthographic_height ? 1 : std::tan(camera.fov_degrees * std::numbers::pi / 360));
  const double tan_x = tan_y * aspect;
  // Smallest distance that shows all spheres on one side, towards `across`.
  const auto distance_for = [&](const Vector3d& across, double tangent) {
    const double around = std::sqrt(1 + tangent * tangent);
    return largest_of(spheres, [&](const VisibleSphere& sphere) {
      const Vector3d v = sphere.center - camera.target;
      const double w = camera.orthographic_height ? 0 : dot(v, axes.forward);
      return (dot(v, across) + sphere.radius * around) / tangent - w;
    });
  };
  const double right = distance_for(axes.x, tan_x), left = distance_for(-axes.x, tan_x);
  const double top = distance_for(axes.y, tan_y), bottom = distance_for(-axes.y, tan_y);
  double distance = std::max({right, left, top, bottom});
  if (!scene.target) {
    camera.target =
        camera.target + tan_x * (right - left) / 2 * axes.x + tan_y * (top - bottom) / 2 * axes.y;
    distance = std::max(right + left, top + bottom) / 2;
  }
  if (camera.orthographic_height) {
    // In front of all, strays too.
    double nearest = 0;
    for (const VisibleSphere& sphere : spheres) {
      const double depth = dot(sphere.center - camera.target, axes.forward);
      nearest = std::max(nearest, sphere.radius - depth);
    }
    distance = nearest + 0.01 * diagonal;
  }
  // Wide views come so near that a point could be in the eye itself.
  const double nearest = largest_of(spheres, [&](const VisibleSphere& sphere) {
    return -dot(sphere.center - camera.target, axes.forward);
  });
  distance = std::max({distance, 1e-3 * diagonal, nearest + 1e-9 * diagonal});
  camera.eye = camera.target - distance * axes.forward;
  return camera;
}

}  // namespace motes
