// A ray of its own, sampled more coarsely than a picture's, in double precision.
#include "document/pick.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "render/clip.h"
#include "render/grid_fields.h"
#include "surface/trace.h"

namespace motes {
namespace {

/// Samples of a ray at most: a place is found to a thousandth of the way through the volume.
constexpr double max_samples = 1000;
/// Rays that are less opaque show nothing that anybody would mean.
constexpr double least_opacity = 0.02;

double length_squared(const Vector3d& v) { return dot(v, v); }

struct Ray {
  Point3d origin;
  Vector3d direction;  ///< of length 1 along the view
};

Ray ray_through(const Camera& camera, int width, int height, double x, double y) {
  const CameraAxes axes = camera_axes(camera);
  const double half = half_height(camera);
  const double u = (2 * x / width - 1) * half * width / height;
  const double v = (1 - 2 * y / height) * half;
  if (camera.orthographic_height) return {camera.eye + u * axes.x + v * axes.y, axes.forward};
  return {camera.eye, axes.forward + u * axes.x + v * axes.y};
}

/// The part of the ray that the clip planes leave.
DepthRange cut(DepthRange range, const Ray& ray, const std::vector<ClipPlane>& planes) {
  for (const ClipPlane& plane : planes) {
    const double slope = dot(plane.normal, ray.direction);
    const double room = plane.distance * length(plane.normal) -
                        dot(plane.normal, Vector3d(ray.origin));
    if (slope > 0) range.far = std::min(range.far, room / slope);
    if (slope < 0) range.near = std::max(range.near, room / slope);
    if (slope == 0 && room < 0) return {1, 0};
  }
  return range;
}

/// Extinction at a value of the field (docs/field.md, "Transfer functions").
double extinction_at(const TransferFunction& function, double value) {
  if (std::isnan(value)) return 0;
  const auto& points = function.points;
  const auto scaled = [&function](double v) { return function.log_scale ? std::log10(v) : v; };
  if (!(value > points.front().value)) return points.front().extinction;
  if (value >= points.back().value) return points.back().extinction;
  const auto next =
      std::upper_bound(points.begin(), points.end(), value,
                       [](double v, const TransferFunction::Point& p) { return v < p.value; });
  const auto last = next - 1;
  const double t =
      (scaled(value) - scaled(last->value)) / (scaled(next->value) - scaled(last->value));
  return last->extinction + t * (next->extinction - last->extinction);
}

/// Depths along a ray, and all fields there.
struct RaySamples {
  std::vector<double> depths;
  double spacing = 0;
  std::vector<FieldSample> values;  ///< [depth][field]
};

RaySamples sample(const Renderer& renderer, const Ray& ray, const DepthRange& range, double step) {
  RaySamples samples;
  if (!(range.near < range.far)) return samples;
  const double way = range.far - range.near;
  const double count = std::ceil(std::clamp(way / step, 1.0, max_samples));
  samples.spacing = way / count;
  std::vector<Point3d> points;
  for (double k = 0.5; k < count; ++k) {
    samples.depths.push_back(range.near + k * samples.spacing);
    points.push_back(ray.origin + samples.depths.back() * ray.direction);
  }
  constexpr double outside = std::numeric_limits<double>::quiet_NaN();
  samples.values = probe(renderer.kernels(), renderer.grids(), points, outside);
  return samples;
}

/// The first crossing of an isosurface; infinity: none.
double isosurface_depth(const RaySamples& samples, const ResolvedScene& scene, std::size_t fields) {
  for (std::size_t k = 1; k < samples.depths.size(); ++k) {
    for (const ResolvedIsosurface& surface : scene.isosurfaces) {
      const double a = samples.values[(k - 1) * fields + surface.field].value - surface.value;
      const double b = samples.values[k * fields + surface.field].value - surface.value;
      if (a * b < 0) return samples.depths[k] - samples.spacing * b / (b - a);
    }
  }
  return std::numeric_limits<double>::infinity();
}

/// Where half of the opacity is met that the volume has in front of `end`; infinity where that is
/// next to nothing.
double volume_depth(const RaySamples& samples, const ResolvedScene& scene, double ray_length,
                    double end) {
  const std::size_t fields = scene.transfer_functions.size();
  std::vector<double> opacity{0};  // in front of each sample, and behind the last
  for (std::size_t k = 0; k < samples.depths.size() && samples.depths[k] < end; ++k) {
    double extinction = 0;
    for (std::size_t f = 0; f < fields; ++f) {
      extinction +=
          extinction_at(scene.transfer_functions[f], samples.values[k * fields + f].value);
    }
    const double passes = std::exp(-extinction * samples.spacing * ray_length);
    opacity.push_back(1 - (1 - opacity.back()) * passes);
  }
  if (opacity.back() < least_opacity) return std::numeric_limits<double>::infinity();
  const auto half = std::lower_bound(opacity.begin(), opacity.end(), opacity.back() / 2);
  const auto k = static_cast<std::size_t>(std::max<std::ptrdiff_t>(half - opacity.begin() - 1, 0));
  return samples.depths[k];
}

/// What is nearest by some measure.
struct Nearest {
  double measure = std::numeric_limits<double>::infinity();
  std::uint32_t particle = 0;

  void consider(double m, std::uint32_t i) {
    if (m < measure || (m == measure && i < particle)) *this = {m, i};
  }
};

/// The smallest of measure(i) over i in [0, size), with the particle that it gives.
template <class Consider>
Nearest nearest_of(std::size_t size, const Consider& consider) {
  return tbb::parallel_reduce(
      tbb::blocked_range<std::size_t>(0, size, 65536), Nearest{},
      [&consider](const auto& range, Nearest nearest) {
        for (std::size_t i = range.begin(); i < range.end(); ++i) consider(i, nearest);
        return nearest;
      },
      [](Nearest a, const Nearest& b) {
        a.consider(b.measure, b.particle);
        return a;
      });
}

/// The particle nearest to a place, of those that are drawn: the centre of a ball.
Nearest drawn_at(const Document& document, const Point3d& center) {
  const ParticleSet& particles = document.particles();
  const auto& index = document.gathered().geometry.index;
  return nearest_of(index.size(), [&](std::size_t i, Nearest& nearest) {
    nearest.consider(length_squared(particles.position(index[i]) - center), index[i]);
  });
}

/// The particle of a field with the largest kernel at a place.
Nearest largest_kernel_at(const Document& document, const Point3d& place) {
  const ParticleSet& particles = document.particles();
  Nearest largest;
  for (const FieldSource& source : document.gathered().sources) {
    const Nearest of_field = nearest_of(source.index.size(), [&](std::size_t i, Nearest& nearest) {
      const double radius = source.radius_of(i);
      const double q2 = length_squared(particles.position(source.index[i]) - place) /
                        (radius * radius);
      const double support = source.kernel.support();
      if (q2 > support * support) return;
      // Kernels fall with q, so the nearest in radii is the largest, but for its weight.
      nearest.consider(q2 / std::max(std::abs(source.weight_of(i)), 1e-30F), source.index[i]);
    });
    largest.consider(of_field.measure, of_field.particle);
  }
  return largest;
}

}  // namespace

std::optional<Pick> pick(const Document& document, const Camera& camera, int width, int height,
                         double x, double y) {
  const Renderer& renderer = document.renderer();
  const KernelSet& kernels = renderer.kernels();
  const ResolvedScene& scene = document.resolved();
  const Ray ray = ray_through(camera, width, height, x, y);
  const double ray_length = length(ray.direction);
  constexpr double nowhere = std::numeric_limits<double>::infinity();

  SurfaceHit hit;
  if (renderer.surface() != nullptr) {
    const Vector3d from_origin = kernels.length_scale * (ray.origin - kernels.origin);
    hit = trace(*renderer.surface(), Point3d(from_origin), ray.direction);
  }
  const double ball = hit.any() ? hit.depth / kernels.length_scale : nowhere;

  RaySamples samples;
  const std::size_t fields = scene.transfer_functions.size();
  if (fields > 0) {
    DepthRange range = clip(volume_box(kernels, renderer.grids()), ray.origin, ray.direction);
    range = cut(range, ray, scene.render.clip_planes);
    samples = sample(renderer, ray, range, scene.step_size);
  }
  const double surface = std::min(ball, isosurface_depth(samples, scene, fields));
  const double depth = std::min(surface, volume_depth(samples, scene, ray_length, surface));
  if (depth == nowhere) return {};

  Pick pick;
  pick.place = ray.origin + depth * ray.direction;
  pick.distance = depth * ray_length;
  Nearest nearest;
  if (depth == ball) {
    const Point3f center{kernels.x[hit.particle], kernels.y[hit.particle], kernels.z[hit.particle]};
    nearest = drawn_at(document, kernels.origin + Vector3d{center.x, center.y, center.z} /
                                                      kernels.length_scale);
  } else {
    nearest = largest_kernel_at(document, pick.place);
  }
  if (nearest.measure == nowhere) return {};
  pick.particle = nearest.particle;
  const std::vector<Point3d> place{pick.place};
  for (const FieldSample& value :
       probe(kernels, renderer.grids(), place, std::numeric_limits<double>::quiet_NaN())) {
    pick.values.push_back(value.value);
  }
  return pick;
}

}  // namespace motes
