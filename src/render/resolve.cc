#include "render/resolve.h"

#include "render/view_profile.h"
#include "scene/fit.h"

namespace motes {

ResolvedScene resolve(const Scene& scene, const ParticleSet& particles,
                      const std::vector<Field>& fields, const std::vector<FieldSource>& sources,
                      const KernelSet& kernels) {
  ResolvedScene resolved;
  resolved.render = scene.render;
  const double aspect = static_cast<double>(scene.render.width) / scene.render.height;
  resolved.camera = fit_camera(scene, visible_spheres(particles, sources), aspect);
  resolved.step_size = scene.render.step_size.value_or(default_step_size(sources, kernels.box()));
  const auto profiles =
      sample_view(kernels, resolved.camera, scene.render.width, scene.render.height);
  const double opacity = fit_opacity(profiles);
  for (std::size_t f = 0; f < fields.size(); ++f) {
    resolved.transfer_functions.push_back(fit_transfer_function(
        fields[f].transfer_function, sources[f].species_color, profiles[f], opacity));
  }
  return resolved;
}

}  // namespace motes
