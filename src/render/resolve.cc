#include "render/resolve.h"

#include <algorithm>
#include <span>
#include <variant>

#include "field/probe.h"
#include "render/view_profile.h"
#include "scene/fit.h"

namespace motes {
namespace {

/// Whether a field's transfer function leaves anything to the data.
bool is_open(const Field& field) {
  if (!field.draws_volume()) return false;
  if (std::holds_alternative<TransferFunction>(field.transfer_function)) return false;
  const auto* named = std::get_if<NamedTransferFunction>(&field.transfer_function);
  return named == nullptr || !named->range || !named->extinction;
}

/// Of an isosurface of which neither the scene nor a transfer function says it.
Color default_color(const Field& field, double value, const FieldColors& colors) {
  const auto is_negative = [](const Isosurface& isosurface) { return isosurface.value < 0; };
  const auto number =
      std::count_if(field.isosurfaces.begin(), field.isosurfaces.end(), is_negative);
  const bool both_signs = number > 0 && number < std::ssize(field.isosurfaces);
  if (!field.grid || !both_signs) return colors.own;
  return value < 0 ? colors.negative : colors.positive;
}

std::vector<Color> colors_of(const Isosurface& isosurface, const ParticleSet& particles,
                             const Color& otherwise) {
  if (!isosurface.color) return {otherwise};
  if (const Color* color = std::get_if<Color>(&*isosurface.color)) return {*color};
  if (particles.species.empty()) return {color_from_srgb(0xcccccc)};
  std::vector<Color> colors;
  for (const std::uint32_t srgb :
       colors_of_species(particles, std::get<ColorBy>(*isosurface.color))) {
    colors.push_back(color_from_srgb(srgb));
  }
  return colors;
}

}  // namespace

std::vector<VisibleSphere> spheres_of_view(const ParticleSet& particles,
                                           const std::vector<FieldSource>& sources,
                                           const GeometrySource& geometry,
                                           const std::vector<Field>& fields,
                                           const KernelSet& kernels,
                                           const std::vector<ClipPlane>& clip_planes) {
  const auto values_at = [&kernels](std::size_t field, std::span<const Point3d> points) {
    const std::vector<FieldSample> samples = probe(kernels, points);
    std::vector<double> values(points.size());
    for (std::size_t i = 0; i < values.size(); ++i) {
      values[i] = samples[i * kernels.fields.size() + field].value;
    }
    return values;
  };
  std::vector<VisibleSphere> spheres =
      visible_spheres(particles, sources, geometry, fields, values_at, clip_planes);
  if (!spheres.empty()) return spheres;
  Bounds3d box = particles.bounds();
  if (box.empty()) box = {{-1, -1, -1}, {1, 1, 1}};
  return {{box.min, 0}, {box.max, 0}};
}

ResolvedScene resolve(const Scene& scene, const ParticleSet& particles,
                      const std::vector<Field>& fields, const std::vector<FieldSource>& sources,
                      const GeometrySource& geometry, const KernelSet& kernels, Progress* progress,
                      const GridFields& grids) {
  ResolvedScene resolved;
  resolved.render = scene.render;
  const double aspect = static_cast<double>(scene.render.width) / scene.render.height;
  std::vector<VisibleSphere> spheres;
  if (!(scene.eye && scene.target && scene.up)) {
    spheres =
        spheres_of_view(particles, sources, geometry, fields, kernels, scene.render.clip_planes);
  }
  resolved.camera = fit_camera(scene, spheres, aspect);
  // Without fields nothing is sampled.
  resolved.step_size = 1;
  if (scene.render.step_size) {
    resolved.step_size = *scene.render.step_size;
  } else if (!fields.empty()) {
    resolved.step_size = default_step_size(sources, volume_box(kernels, grids));
  }
  // Without rays where nothing is left to fit: it would be work for nothing.
  std::vector<RayProfiles> profiles(fields.size(), RayProfiles{{}, {0}, {}});
  if (std::any_of(fields.begin(), fields.end(), is_open)) {
    profiles = sample_view(kernels, resolved.camera, scene.render.width, scene.render.height,
                           progress, grids);
  }
  const double opacity = fit_opacity(profiles, scene.render.background, !geometry.empty());
  for (std::size_t f = 0; f < fields.size(); ++f) {
    const Field& field = fields[f];
    const FieldColors& colors = sources[f].colors;
    const TransferFunction invisible{{{0, colors.own, 0}}};
    resolved.transfer_functions.push_back(
        field.draws_volume()
            ? fit_transfer_function(field.transfer_function, colors, profiles[f], opacity)
            : invisible);
    for (const Isosurface& isosurface : field.isosurfaces) {
      const double value = isosurface.value;
      const Color otherwise = field.draws_volume()
                                  ? color_at(resolved.transfer_functions.back(), value)
                                  : default_color(field, value, colors);
      resolved.isosurfaces.push_back({f, value, static_cast<float>(isosurface.opacity),
                                      colors_of(isosurface, particles, otherwise)});
    }
  }
  return resolved;
}

}  // namespace motes
