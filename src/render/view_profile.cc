#include "render/view_profile.h"

#include <cmath>
#include <numbers>
#include <random>

#include "core/vec.h"
#include "field/probe.h"
#include "render/clip.h"

namespace motes {
namespace {

constexpr int rays_an_axis = 32;
constexpr int samples_per_ray = 96;

/// A ray: its points are origin + z * direction.
struct Ray {
  Point3d origin;
  Vector3d direction;
};

/// The ray through the point (s, t) of the image, both in [0, 1], from the left and from the top.
Ray view_ray(const Camera& camera, const CameraAxes& axes, double aspect, double s, double t) {
  const double half_height = camera.orthographic_height
                                 ? 0.5 * *camera.orthographic_height
                                 : std::tan(0.5 * camera.fov_degrees * std::numbers::pi / 180);
  const Vector3d across =
      (2 * s - 1) * half_height * aspect * axes.x + (1 - 2 * t) * half_height * axes.y;
  if (camera.orthographic_height) return {camera.eye + across, axes.forward};
  return {camera.eye, across + axes.forward};
}

}  // namespace

std::vector<RayProfiles> sample_view(const KernelSet& kernels, const Camera& camera, int width,
                                     int height) {
  const CameraAxes axes = camera_axes(camera);
  const double aspect = static_cast<double>(width) / height;
  const Bounds3d box = kernels.box();
  // Jittered, or a crystal's planes would beat with the grid of rays.
  std::mt19937 random(1);
  const auto jitter = [&] { return (random() + 0.5) / 4294967296.0; };

  std::vector<Point3d> points;
  RayProfiles rays;
  rays.ray_begin.push_back(0);
  for (int i = 0; i < rays_an_axis * rays_an_axis; ++i) {
    const int column = i % rays_an_axis, row = i / rays_an_axis;
    const double s = (column + jitter()) / rays_an_axis, t = (row + jitter()) / rays_an_axis;
    const Ray ray = view_ray(camera, axes, aspect, s, t);
    const DepthRange range = clip(box, ray.origin, ray.direction);
    if (!(range.near < range.far)) continue;
    const double spacing = (range.far - range.near) / samples_per_ray;
    rays.spacing.push_back(spacing * length(ray.direction));
    for (int k = 0; k < samples_per_ray; ++k) {
      points.push_back(ray.origin + (range.near + (k + jitter()) * spacing) * ray.direction);
    }
    rays.ray_begin.push_back(points.size());
  }

  const std::size_t num_fields = kernels.fields.size();
  const std::vector<FieldSample> samples = probe(kernels, points);
  std::vector<RayProfiles> profiles(num_fields, rays);
  for (std::size_t f = 0; f < num_fields; ++f) {
    profiles[f].values.reserve(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
      profiles[f].values.push_back(static_cast<float>(samples[i * num_fields + f].value));
    }
  }
  return profiles;
}

}  // namespace motes
