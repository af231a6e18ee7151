// Finds out why a picture is empty.
#include "motes/picture_warnings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/error.h"
#include "field/probe.h"

namespace motes {
namespace {

constexpr float least_visible = 1.0f / 255;

/// How far a particle's kernel, ball and sticks reach from its centre; internal length.
double reach_of(const Renderer& renderer, std::size_t i) {
  const KernelSet& kernels = renderer.kernels();
  const std::size_t field = kernels.field_of(i);
  double reach = 0;
  if (field < kernels.fields.size()) {
    reach = kernels.fields[field].kernel.support() * kernels.radius[i];
  }
  const Surface* surface = renderer.surface();
  if (surface == nullptr) return reach;
  reach = std::max(reach, double{surface->radius[i]});
  const Sticks& sticks = surface->sticks;
  if (sticks.size() == 0) return reach;
  for (std::size_t s = sticks.begin[i]; s < sticks.begin[i + 1]; ++s) {
    const double half = length(Vector3d{sticks.x[s], sticks.y[s], sticks.z[s]});
    reach = std::max(reach, half + sticks.radius_of(s));
  }
  return reach;
}

/// Whether a sphere about each particle's centre, as large as what it has, reaches into the view,
/// or one about a grid.
bool any_in_view(const Renderer& renderer, const Camera& camera, double aspect) {
  const KernelSet& kernels = renderer.kernels();
  const CameraAxes axes = camera_axes(camera);
  const bool parallel = camera.orthographic_height.has_value();
  const double tan_y = half_height(camera);
  // Whether the sphere reaches over the edge of the image that is `tangent` from its middle.
  const auto inside = [&](double across, double depth, double radius, double tangent) {
    if (parallel) return std::abs(across) - radius <= tangent;
    return std::abs(across) - radius * std::sqrt(1 + tangent * tangent) <= tangent * depth;
  };
  const auto reaches_view = [&](const Point3d& center, double radius) {
    const Vector3d v = center - camera.eye;
    const double depth = dot(v, axes.forward);
    return depth + radius > 0 && inside(dot(v, axes.x), depth, radius, tan_y * aspect) &&
           inside(dot(v, axes.y), depth, radius, tan_y);
  };
  for (const GridField& grid : renderer.grids()) {
    const Bounds3d box = grid.sampler->bounds();
    if (reaches_view(box.center(), 0.5 * length(box.diagonal()))) return true;
  }
  for (std::size_t i = 0; i < kernels.size(); ++i) {
    const Vector3d from_origin{kernels.x[i], kernels.y[i], kernels.z[i]};
    if (reaches_view(kernels.origin + from_origin / kernels.length_scale,
                     reach_of(renderer, i) / kernels.length_scale)) {
      return true;
    }
  }
  return false;
}

/// About how many pixels high all that there is to see is in the image.
double height_in_pixels(const DataExtent& data, const Camera& camera, int image_height) {
  const double distance =
      camera.orthographic_height ? 1 : length(data.bounds.center() - camera.eye);
  return length(data.bounds.diagonal()) / (2 * half_height(camera) * distance) * image_height;
}

struct ValueRange {
  double min = 0, max = 0;
  /// Whether there is something beyond the level, farther from 0: that is what it encloses.
  bool goes_beyond(double level) const {
    return level > 0 ? max > level : min < level || level == 0;
  }
};

/// Of a field of particles: 0, and what it is at its particles, or many of them.
ValueRange range_at_particles(const KernelSet& kernels, std::size_t field) {
  constexpr std::size_t particles_looked_at = 1 << 16;
  const std::size_t stride = 1 + kernels.size() / particles_looked_at;
  std::vector<Point3d> points;
  for (std::size_t i = 0; i < kernels.size(); i += stride) {
    if (kernels.field_of(i) != field) continue;
    const Vector3d from_origin{kernels.x[i], kernels.y[i], kernels.z[i]};
    points.push_back(kernels.origin + from_origin / kernels.length_scale);
  }
  const std::vector<FieldSample> samples = probe(kernels, points);
  ValueRange range;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const double value = samples[k * kernels.fields.size() + field].value;
    range.min = std::min(range.min, value);
    range.max = std::max(range.max, value);
  }
  return range;
}

ValueRange range_of(const GridField& grid) {
  ValueRange range{std::numeric_limits<double>::infinity(),
                   -std::numeric_limits<double>::infinity()};
  for (const MacroCells::Range& cell : grid.cells->ranges()) {
    range.min = std::min(range.min, double{cell.min});
    range.max = std::max(range.max, double{cell.max});
  }
  // (cells' bounds are a little wider than the values, which shows where one of these is 0)
  const double least = 1e-5 * std::max(std::abs(range.min), std::abs(range.max));
  for (double* end : {&range.min, &range.max}) *end = std::abs(*end) < least ? 0 : *end;
  return range;
}

/// Names the isosurfaces at values that their fields do not take, those of particles only if they
/// are `of_particles`. Whether there are any.
bool warn_of_levels_not_reached(const Renderer& renderer, const ResolvedScene& scene,
                                bool of_particles, Warnings& warnings) {
  const KernelSet& kernels = renderer.kernels();
  const GridFields& grids = renderer.grids();
  bool any = false;
  for (const ResolvedIsosurface& isosurface : scene.isosurfaces) {
    const auto grid = std::find_if(grids.begin(), grids.end(), [&](const GridField& candidate) {
      return candidate.field == isosurface.field;
    });
    const bool is_grid = grid != grids.end();
    if (!is_grid && !of_particles) continue;
    const ValueRange range =
        is_grid ? range_of(*grid) : range_at_particles(kernels, isosurface.field);
    if (range.goes_beyond(isosurface.value)) continue;
    any = true;
    warnings.add(
        fmt::format("the field '{}' does not reach its isosurface at {:.4g}; {} from {:.4g} "
                    "to {:.4g}",
                    printable(kernels.fields[isosurface.field].name), isosurface.value,
                    is_grid ? "its values go" : "it goes", range.min, range.max));
  }
  return any;
}

}  // namespace

bool warn_of_large_steps(const Renderer& renderer, double step_size, Warnings& warnings) {
  const KernelSet& kernels = renderer.kernels();
  if (kernels.fields.size() == renderer.grids().size()) return false;
  double radius = 0, support_radius = 0;
  for (const FieldKernels& field : kernels.fields) {
    radius = std::max(radius, field.max_radius);
    support_radius = std::max(support_radius, field.kernel.support() * field.max_radius);
  }
  if (step_size <= 2 * support_radius) return false;
  warnings.add(
      fmt::format("step_size {:.4g} is larger than the kernels (support diameter {:.4g}): most of "
                  "them fall between samples; expected {:.4g} or less, or larger radii",
                  step_size, 2 * support_radius, std::min(radius, support_radius)));
  return true;
}

void warn_of_empty_picture(const Framebuffer& image, const Renderer& renderer,
                           const ResolvedScene& scene, const DataExtent& data, bool between_samples,
                           Warnings& warnings) {
  float largest = 0;
  for (std::size_t i = 3; i < image.rgba.size(); i += 4) {
    largest = std::max(largest, image.rgba[i]);
  }
  const bool empty = largest < least_visible;
  const bool level_not_reached = warn_of_levels_not_reached(renderer, scene, empty, warnings);
  if (!empty) return;
  if (any_in_view(renderer, scene.camera, static_cast<double>(image.width) / image.height)) {
    if (between_samples || level_not_reached) return;
    if (height_in_pixels(data, scene.camera, image.height) < 3) {
      warnings.add(
          fmt::format("what is in view is no larger than a pixel; expected {}",
                      scene.camera.orthographic_height
                          ? "a smaller orthographic height"
                          : fmt::format("a nearer eye, or a smaller fov than {:.6g} degrees",
                                        scene.camera.fov_degrees)));
      return;
    }
    if (renderer.kernels().fields.empty()) {
      warnings.add(
          "none of the balls and sticks in view is seen; expected larger radii, or clip planes "
          "that leave some of them");
      return;
    }
    warnings.add(
        fmt::format("the {} in view are too transparent to be seen (largest opacity "
                    "{:.2g}); expected a larger extinction in the transfer function, or a range "
                    "with the field's values in it{}{}",
                    renderer.grids().empty() ? "particles" : "fields", largest,
                    scene.isosurfaces.empty() ? "" : ", or isosurfaces of a larger opacity",
                    scene.render.clip_planes.empty() ? "" : ", or clip planes that leave some"));
    return;
  }
  warnings.add(fmt::format(
      "nothing is in view; the data span x {:.4g} to {:.4g}, y {:.4g} to {:.4g}, z {:.4g} to "
      "{:.4g}{}",
      data.bounds.min.x, data.bounds.max.x, data.bounds.min.y, data.bounds.max.y, data.bounds.min.z,
      data.bounds.max.z, data.length_unit == "unknown" ? "" : " " + data.length_unit));
}

}  // namespace motes
