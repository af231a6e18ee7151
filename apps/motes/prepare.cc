// Puts the library's steps in their order.
#include "motes/prepare.h"

#include <utility>

#include "motes/input.h"
#include "render/resolve.h"
#include "scene/fill_in.h"

namespace motes {

PreparedScene prepare_scene(Scene scene, const ParticleSet& particles,
                            const std::filesystem::path& path, const SceneChanges& changes,
                            Console& console, const std::vector<LoadedGrid>& grids) {
  return with_place(path, changes, [&]() -> PreparedScene {
    color_by_species(scene, particles);
    const auto fields = expand_fields(scene, particles, grids);
    const auto sources =
        make_field_sources(particles, fields, scene.kernel, console.warnings(), &console, grids);
    const auto geometry = make_geometry_source(particles, scene.geometry, console.warnings());
    console.print_warnings();
    console.update("building the tree", 0);
    Renderer renderer(particles, sources, geometry);
    ResolvedScene resolved = resolve(scene, particles, fields, sources, geometry,
                                     renderer.kernels(), &console, renderer.grids());
    renderer.prepare(resolved.render.engine);
    console.finish();
    Scene filled_in = fill_in(scene, fields, sources, resolved);
    DataExtent extent{particles.bounds(), particles.length_unit};
    for (const GridField& grid : renderer.grids()) {
      extent.bounds.add(grid.sampler->bounds());
      if (particles.size() == 0) extent.length_unit = sources[grid.field].grid->length_unit;
    }
    return {std::move(renderer), std::move(resolved), std::move(filled_in), std::move(extent)};
  });
}

PreparedScene read_and_prepare_scene(const Scene& scene, const std::filesystem::path& path,
                                     const SceneChanges& changes, Console& console) {
  const Input input = read_input(scene, console);
  PreparedScene prepared =
      prepare_scene(scene, input.particles, path, changes, console, input.grids);
  prepared.read_ms = input.read_ms;
  return prepared;
}

}  // namespace motes
