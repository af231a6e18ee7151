#include "render/isosurface_frame.h"

#include <algorithm>
#include <cmath>

#include "surface/make_sticks.h"

namespace motes {
namespace {

/// A plane of samples behind all of the volume.
SampleIndex plane_behind(const View& view, const Bounds3d& box) {
  double farthest = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const Point3d p{(corner & 1 ? box.max : box.min).x, (corner & 2 ? box.max : box.min).y,
                    (corner & 4 ? box.max : box.min).z};
    farthest = std::max(farthest, dot(p - view.eye, view.axes.forward));
  }
  const double planes = farthest / view.planes.step - static_cast<double>(view.planes.first);
  return static_cast<SampleIndex>(std::ceil(planes)) + 1;
}

/// `levels` are those of the grid's field.
IsosurfaceGrid make_grid(const GridField& field, const std::vector<IsosurfaceLevel>& levels,
                         const KernelSet& kernels) {
  IsosurfaceGrid grid;
  const GridSampler& sampler = *field.sampler;
  grid.view = sampler.view();
  grid.origin = sampler.to_index(kernels.origin);
  for (int i = 0; i < 3; ++i) {
    Vector3d one;
    one[i] = 1;
    grid.axes[i] = sampler.to_world_gradient(one) / kernels.length_scale;
  }
  grid.value_scale = kernels.fields[field.field].value_scale;
  const auto& dims = grid.dims = field.cells->dims();
  for (int k = 0; k < dims[2]; ++k) {
    for (int j = 0; j < dims[1]; ++j) {
      for (int i = 0; i < dims[0]; ++i) {
        const bool on_face =
            i == 0 || j == 0 || k == 0 || i == dims[0] - 1 || j == dims[1] - 1 || k == dims[2] - 1;
        MacroCells::Range range = field.cells->at(i, j, k);
        // Beyond the face of what a level encloses there is nothing.
        if (on_face) range = {std::min(range.min, 0.0F), std::max(range.max, 0.0F)};
        const bool any = std::any_of(levels.begin(), levels.end(), [&](const auto& level) {
          const double value = level.value / grid.value_scale;
          return range.min <= value && value <= range.max;
        });
        grid.crosses.push_back(any ? 1 : 0);
      }
    }
  }
  return grid;
}

}  // namespace

std::vector<std::uint16_t> species_of_kernels(const ParticleSet& particles,
                                              const std::vector<FieldSource>& sources,
                                              const KernelOrder& order) {
  const bool asked = std::any_of(sources.begin(), sources.end(),
                                 [](const FieldSource& s) { return s.colored_by_species; });
  std::vector<std::uint16_t> species;
  if (!asked || particles.species.empty()) return species;
  for (const std::uint32_t i : particles_in_order(sources, order)) {
    species.push_back(particles.species[i]);
  }
  return species;
}

ShadedIsosurfaces make_isosurfaces(const ResolvedScene& scene, const FrameContext& context,
                                   const GridFields& grids, const ImagePlane& plane,
                                   const SurfaceShading& shading,
                                   const std::vector<std::uint16_t>& species) {
  ShadedIsosurfaces isosurfaces;
  IsosurfaceFrame& frame = isosurfaces.frame;
  frame.kernels = context.kernels;
  frame.species = species.empty() ? nullptr : species.data();
  frame.view = {context.view.axes, context.view.eye, context.orthographic};
  frame.planes = context.view.planes;
  // About five small radii: as far as crevices hide the light of their walls.
  constexpr double default_reach = 10;  // steps
  frame.box = context.box;
  isosurfaces.light = make_light_frame(frame.view, plane, shading);
  if (!std::isfinite(shading.occlusion_distance)) {
    isosurfaces.light.prune_distance = default_reach * frame.planes.step;
  }
  frame.last_plane = plane_behind(context.view, context.box);
  frame.clip_planes = context.clip_planes;
  for (std::size_t i = 0; i < scene.isosurfaces.size(); ++i) {
    const ResolvedIsosurface& isosurface = scene.isosurfaces[i];
    auto at = std::find_if(frame.fields.begin(), frame.fields.end(),
                           [&](const auto& field) { return field.field == isosurface.field; });
    if (at == frame.fields.end()) at = frame.fields.insert(at, {isosurface.field, {}, {}});
    const double scale = context.kernels->fields[isosurface.field].value_scale;
    at->levels.push_back({static_cast<std::uint32_t>(i),
                          static_cast<float>(isosurface.value * scale), isosurface.opacity,
                          isosurface.colors});
  }
  for (FieldIsosurfaces& field : frame.fields) {
    const auto grid = std::find_if(grids.begin(), grids.end(), [&](const GridField& candidate) {
      return candidate.field == field.field;
    });
    if (grid != grids.end()) field.grid = make_grid(*grid, field.levels, *context.kernels);
  }
  return isosurfaces;
}

}  // namespace motes
