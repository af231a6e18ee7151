// Puts the library's steps in their order.
#include "motes/prepare.h"

#include <utility>

#include "document/gather.h"
#include "motes/input.h"

namespace motes {

PreparedScene prepare_scene(Scene scene, const ParticleSet& particles,
                            const std::filesystem::path& path, const SceneChanges& changes,
                            Console& console, const std::vector<LoadedGrid>& grids) {
  return with_place(path, changes, [&]() -> PreparedScene {
    const GatheredScene gathered =
        gather(scene, particles, grids, &console, console.warnings());
    console.print_warnings();
    console.update("building the tree", 0);
    Renderer renderer(particles, gathered.sources, gathered.geometry);
    ResolvedScene resolved = resolve(scene, gathered, particles, renderer, &console);
    renderer.prepare(resolved.render.engine);
    console.finish();
    Scene filled_in = fill_in(scene, gathered, resolved);
    DataExtent extent{particles.bounds(), particles.length_unit};
    for (const GridField& grid : renderer.grids()) {
      extent.bounds.add(grid.sampler->bounds());
      if (particles.size() == 0) {
        extent.length_unit = gathered.sources[grid.field].grid->length_unit;
      }
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
