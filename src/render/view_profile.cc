#include "render/view_profile.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <span>

#include "core/vec.h"
#include "field/probe.h"
#include "render/clip.h"
#include "render/view_ray.h"

namespace motes {
namespace {

/// The points of the view at which the fields are looked at, and the rays that they lie on.
struct ViewPoints {
  std::vector<Point3d> points;
  RayProfiles rays;  ///< without values
};

/// `rays_an_axis` squared rays over the image, `samples_per_ray` points on each. Both are jittered,
/// or a crystal's planes would beat with them.
ViewPoints spread_points(const Bounds3d& box, const Camera& camera, double aspect, int rays_an_axis,
                         int samples_per_ray) {
  const CameraAxes axes = camera_axes(camera);
  std::mt19937 random(1);
  const auto jitter = [&] { return (random() + 0.5) / 4294967296.0; };
  ViewPoints view;
  view.rays.ray_begin.push_back(0);
  for (int i = 0; i < rays_an_axis * rays_an_axis; ++i) {
    const int column = i % rays_an_axis, row = i / rays_an_axis;
    const double s = (column + jitter()) / rays_an_axis, t = (row + jitter()) / rays_an_axis;
    const ViewRay ray = view_ray(camera, axes, aspect, s, t);
    const DepthRange range = clip(box, ray.origin, ray.direction);
    if (!(range.near < range.far)) continue;
    const double spacing = (range.far - range.near) / samples_per_ray;
    view.rays.spacing.push_back(spacing * length(ray.direction));
    for (int k = 0; k < samples_per_ray; ++k) {
      view.points.push_back(ray.at(range.near + (k + jitter()) * spacing));
    }
    view.rays.ray_begin.push_back(view.points.size());
  }
  return view;
}

/// As many points as a second or so allows: heaps of kernels in one place must not make anyone
/// wait.
ViewPoints choose_points(const KernelSet& kernels, const Bounds3d& box, const Camera& camera,
                         double aspect) {
  constexpr int few = 8, rays_an_axis = 32, samples_per_ray = 96;
  constexpr double max_kernels = 1e8;
  ViewPoints trial = spread_points(box, camera, aspect, few, few);
  if (trial.points.empty()) return trial;
  const double cost =
      mean_kernels_tested(kernels, trial.points) * rays_an_axis * rays_an_axis * samples_per_ray;
  const double scale = std::min(1.0, std::cbrt(max_kernels / std::max(cost, 1.0)));
  return spread_points(box, camera, aspect, std::max(few, static_cast<int>(scale * rays_an_axis)),
                       std::max(few, static_cast<int>(scale * samples_per_ray)));
}

}  // namespace

std::vector<RayProfiles> sample_view(const KernelSet& kernels, const Camera& camera, int width,
                                     int height, Progress* progress, const GridFields& grids) {
  const ViewPoints view = choose_points(kernels, volume_box(kernels, grids), camera,
                                        static_cast<double>(width) / height);
  const std::size_t num_fields = kernels.fields.size(), num_points = view.points.size();
  std::vector<RayProfiles> profiles(num_fields, view.rays);
  for (RayProfiles& profile : profiles) profile.values.reserve(num_points);

  // In batches, so that the user sees it go on.
  const std::size_t batch = num_points / 20 + 1;
  for (std::size_t begin = 0; begin < num_points; begin += batch) {
    const auto points = std::span(view.points).subspan(begin, std::min(batch, num_points - begin));
    const std::vector<FieldSample> samples = probe(kernels, grids, points, 0);
    for (std::size_t i = 0; i < samples.size(); ++i) {
      profiles[i % num_fields].values.push_back(static_cast<float>(samples[i].value));
    }
    if (progress != nullptr) {
      progress->update("fitting colours", static_cast<double>(begin + points.size()) /
                                              static_cast<double>(num_points));
    }
  }
  return profiles;
}

}  // namespace motes
