// Finds out why a picture is empty.
#include "motes/picture_warnings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

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

void warn_of_empty_picture(const Framebuffer& image, const Renderer& renderer, const Camera& camera,
                           const DataExtent& data, bool between_samples, Warnings& warnings) {
  float largest = 0;
  for (std::size_t i = 3; i < image.rgba.size(); i += 4) {
    largest = std::max(largest, image.rgba[i]);
  }
  if (largest >= least_visible) return;
  if (any_in_view(renderer, camera, static_cast<double>(image.width) / image.height)) {
    if (between_samples) return;
    if (renderer.kernels().fields.empty()) {
      warnings.add(
          "none of the balls and sticks in view is seen; expected larger radii, or clip planes "
          "that "
          "leave some of them");
      return;
    }
    warnings.add(
        fmt::format("the {} in view are too transparent to be seen (largest opacity "
                    "{:.2g}); expected a larger extinction in the transfer function, or a range "
                    "with the field's values in it",
                    renderer.grids().empty() ? "particles" : "fields", largest));
    return;
  }
  warnings.add(fmt::format(
      "nothing is in view; the data span x {:.4g} to {:.4g}, y {:.4g} to {:.4g}, z {:.4g} to "
      "{:.4g}{}",
      data.bounds.min.x, data.bounds.max.x, data.bounds.min.y, data.bounds.max.y, data.bounds.min.z,
      data.bounds.max.z, data.length_unit == "unknown" ? "" : " " + data.length_unit));
}

}  // namespace motes
