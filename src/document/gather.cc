// The library's steps from a scene to what is rendered, in their order.
#include "document/gather.h"

#include <algorithm>
#include <iterator>

#include "render/resolve.h"
#include "scene/fill_in.h"

namespace motes {

GatheredScene gather(Scene& scene, const ParticleSet& particles,
                     const std::vector<LoadedGrid>& grids, Progress* progress, Warnings& warnings) {
  GatheredScene gathered;
  color_by_species(scene, particles);
  gathered.all_fields = expand_fields(scene, particles, grids);
  std::copy_if(gathered.all_fields.begin(), gathered.all_fields.end(),
               std::back_inserter(gathered.fields), [](const Field& f) { return f.visible; });
  gathered.sources = make_field_sources(particles, gathered.fields, scene.kernel, warnings,
                                        progress, grids);
  gathered.geometry = make_geometry_source(particles, scene.geometry, warnings);
  return gathered;
}

ResolvedScene resolve(const Scene& scene, const GatheredScene& gathered,
                      const ParticleSet& particles, const Renderer& renderer, Progress* progress) {
  return resolve(scene, particles, gathered.fields, gathered.sources, gathered.geometry,
                 renderer.kernels(), progress, renderer.grids());
}

Scene fill_in(const Scene& scene, const GatheredScene& gathered, const ResolvedScene& resolved) {
  Scene filled = fill_in(scene, gathered.fields, gathered.sources, resolved);
  auto visible = filled.fields.begin();
  std::vector<Field> all;
  for (const Field& field : gathered.all_fields) {
    all.push_back(field.visible ? std::move(*visible++) : field);
  }
  filled.fields = std::move(all);
  return filled;
}

}  // namespace motes
