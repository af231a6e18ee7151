// What is seen at a pixel.
#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "document/document.h"
#include "render/clip.h"
#include "render/view_ray.h"
#include "surface/cut.h"
#include "surface/trace.h"

namespace motes {
namespace {

constexpr double least_opacity = 0.01;
constexpr double max_samples = 1024;  // of a ray
constexpr std::size_t no_field = std::numeric_limits<std::size_t>::max();

/// Leaves of `range` what no plane cuts away.
DepthRange cut_range(DepthRange range, const ViewRay& ray, std::span<const ClipPlane> planes) {
  for (const ClipPlane& plane : planes) {
    const Vector3d normal = normalize(plane.normal);
    const double inside = plane.distance - dot(normal, ray.origin - Point3d{});
    const double slope = dot(normal, ray.direction);
    if (slope > 0) range.far = std::min(range.far, inside / slope);
    if (slope < 0) range.near = std::max(range.near, inside / slope);
    if (slope == 0 && inside < 0) return {1, 0};
  }
  return range;
}

/// The first ball or stick on the ray; as trace() has it.
SurfaceHit find_solid(const Surface& surface, const ViewRay& ray,
                      std::span<const ClipPlane> planes) {
  const KernelSet& kernels = *surface.kernels;
  const double scale = kernels.length_scale;
  const Point3d origin = Point3d{} + scale * (ray.origin - kernels.origin);
  if (planes.empty()) return trace(surface, origin, scale * ray.direction);
  std::vector<ClipPlane> internal;
  for (const ClipPlane& plane : planes) {
    const Vector3d normal = normalize(plane.normal);
    const double distance = plane.distance - dot(normal, kernels.origin - Point3d{});
    internal.push_back({normal, scale * distance});
  }
  return trace(cut(surface, internal), origin, scale * ray.direction);
}

/// A place on the ray at which its opacity grows.
struct OpacityStep {
  double depth = 0;
  double opacity = 0;            ///< of the ray, up to and with this
  std::size_t field = no_field;  ///< whose isosurface it is; no_field: of the volume
};

/// Walks a ray through the fields.
class FieldWalk {
 public:
  FieldWalk(const Renderer& renderer, const ResolvedScene& scene, const ViewRay& ray)
      : renderer_(renderer), scene_(scene), ray_(ray) {}

  /// The layers between `range`'s ends, from the front.
  std::vector<OpacityStep> layers(const DepthRange& range) const {
    std::vector<OpacityStep> found;
    const std::size_t num_fields = scene_.transfer_functions.size();
    if (num_fields == 0 || !(range.near < range.far)) return found;
    const double depth = range.far - range.near;
    const double step = std::max(scene_.step_size, depth / max_samples);
    std::vector<Point3d> points;
    for (double z = range.near + step / 2; z < range.far; z += step) points.push_back(ray_.at(z));
    const std::vector<FieldSample> samples = values_at(points);
    double transparency = 1;
    for (std::size_t k = 0; k < points.size(); ++k) {
      const double z = range.near + (static_cast<double>(k) + 0.5) * step;
      const std::span now = std::span(samples).subspan(k * num_fields, num_fields);
      if (k > 0) {
        const std::span before = std::span(samples).subspan((k - 1) * num_fields, num_fields);
        for (const ResolvedIsosurface& surface : scene_.isosurfaces) {
          const std::size_t f = surface.field;
          if ((before[f].value < surface.value) == (now[f].value < surface.value)) continue;
          transparency *= 1 - double{surface.opacity};
          found.push_back({find_crossing(surface, z - step, z), 1 - transparency, f});
        }
      }
      double extinction = 0;
      for (std::size_t f = 0; f < num_fields; ++f) extinction += extinction_of(f, now[f].value);
      if (extinction == 0) continue;
      transparency *= std::exp(-extinction * step * length(ray_.direction));
      found.push_back({z, 1 - transparency, no_field});
    }
    return found;
  }

  /// Outside of its grid a field has no value.
  std::vector<FieldSample> values_at(std::span<const Point3d> points) const {
    return probe(renderer_.kernels(), renderer_.grids(), points,
                 std::numeric_limits<double>::quiet_NaN());
  }
  double extinction_of(std::size_t field, double value) const {
    return std::isnan(value) ? 0 : point_at(scene_.transfer_functions[field], value).extinction;
  }

 private:
  /// By bisection between two depths on different sides of the level.
  double find_crossing(const ResolvedIsosurface& surface, double near, double far) const {
    const auto below = [&](double z) {
      const Point3d point = ray_.at(z);
      return values_at({&point, 1})[surface.field].value < surface.value;
    };
    const bool at_near = below(near);
    for (int i = 0; i < 20; ++i) {
      const double middle = 0.5 * (near + far);
      (below(middle) == at_near ? near : far) = middle;
    }
    return 0.5 * (near + far);
  }

  const Renderer& renderer_;
  const ResolvedScene& scene_;
  const ViewRay& ray_;
};

/// The particle of a field with the largest kernel at a place.
struct Largest {
  double kernel = 0, sum = 0;  ///< magnitudes: the largest, and of all kernels
  std::uint32_t particle = no_particle;
};

/// Every particle is looked at: a scan takes milliseconds a million, and no memory.
Largest find_largest(const ParticleSet& particles, const FieldSource& source,
                     const Point3d& place) {
  Largest largest;
  const double support = source.kernel.support();
  for (std::size_t i = 0; i < source.index.size(); ++i) {
    const double radius = source.radius_of(i);
    const Vector3d d = place - particles.position(source.index[i]);
    if (dot(d, d) > support * support * radius * radius) continue;
    const double norm = source.normalise ? 1 / (radius * radius * radius) : 1;
    const double kernel =
        std::abs(source.weight_of(i) * norm * evaluate(source.kernel, length(d) / radius).value);
    largest.sum += kernel;
    if (kernel > largest.kernel) {
      largest.kernel = kernel;
      largest.particle = source.index[i];
    }
  }
  return largest;
}

/// Of the particles that are drawn the one at `place`, which is right to single precision.
std::uint32_t nearest_drawn(const ParticleSet& particles, const GeometrySource& geometry,
                            const Point3d& place) {
  std::uint32_t nearest = no_particle;
  double least = std::numeric_limits<double>::infinity();
  for (const std::uint32_t i : geometry.index) {
    const Vector3d d = particles.position(i) - place;
    if (!(dot(d, d) < least)) continue;
    least = dot(d, d);
    nearest = i;
  }
  return nearest;
}

Pick describe(const ParticleSet& particles, std::uint32_t index) {
  Pick pick;
  pick.index = index;
  pick.position = particles.position(index);
  if (!particles.ids.empty()) pick.id = particles.ids[index];
  if (!particles.species.empty()) pick.species = particles.species_names[particles.species[index]];
  for (const Property& property : particles.properties) {
    pick.properties.emplace_back(property.name, property.values[index]);
  }
  return pick;
}

}  // namespace

std::optional<Pick> Document::pick(const Camera& camera, int width, int height, double x,
                                   double y) const {
  const KernelSet& kernels = renderer_->kernels();
  const std::vector<ClipPlane>& planes = resolved_.render.clip_planes;
  const ViewRay ray = view_ray(camera, camera_axes(camera), static_cast<double>(width) / height,
                               x / width, y / height);
  SurfaceHit solid;
  if (renderer_->surface() != nullptr) solid = find_solid(*renderer_->surface(), ray, planes);
  const FieldWalk walk(*renderer_, resolved_, ray);
  std::vector<OpacityStep> layers;
  if (!sources_.empty()) {
    DepthRange range = clip(volume_box(kernels, renderer_->grids()), ray.origin, ray.direction);
    range.far = std::min(range.far, solid.depth);
    layers = walk.layers(cut_range(range, ray, planes));
  }
  if (solid.any()) layers.push_back({solid.depth, 1, no_field});
  if (layers.empty() || layers.back().opacity < least_opacity) return std::nullopt;
  const auto at = std::find_if(layers.begin(), layers.end(), [&](const OpacityStep& layer) {
    return layer.opacity >= layers.back().opacity / 2;
  });
  const Point3d place = ray.at(at->depth);
  const std::vector<FieldSample> values = walk.values_at({&place, 1});

  std::uint32_t particle = no_particle;
  if (solid.any() && at + 1 == layers.end()) {
    const std::uint32_t i = solid.particle;
    const Vector3d from_origin{kernels.x[i], kernels.y[i], kernels.z[i]};
    particle =
        nearest_drawn(particles_, geometry_, kernels.origin + from_origin / kernels.length_scale);
  } else {
    double best = 0;
    for (std::size_t f = 0; f < sources_.size(); ++f) {
      if (sources_[f].grid || (at->field != no_field && at->field != f)) continue;
      const double extinction = at->field == f ? 1 : walk.extinction_of(f, values[f].value);
      if (extinction == 0) continue;
      const Largest largest = find_largest(particles_, sources_[f], place);
      if (largest.kernel == 0 || !(extinction * largest.kernel / largest.sum > best)) continue;
      best = extinction * largest.kernel / largest.sum;
      particle = largest.particle;
    }
  }
  if (particle == no_particle) return std::nullopt;
  Pick pick = describe(particles_, particle);
  pick.place = place;
  pick.distance = length(place - ray.origin);
  for (std::size_t f = 0; f < sources_.size(); ++f) {
    pick.values.emplace_back(sources_[f].name, values[f].value);
  }
  return pick;
}

}  // namespace motes
