#include "motes/prepare.h"

#include <utility>

#include "motes/input.h"

namespace motes {

PreparedScene prepare_scene(Scene scene, const ParticleSet& particles,
                            const std::filesystem::path& path, const SceneChanges& changes,
                            Console& console, const std::vector<LoadedGrid>& grids) {
  return with_place(path, changes, [&] {
    PreparedScene prepared =
        prepare_scene(std::move(scene), particles, grids, &console, console.warnings());
    console.finish();
    console.print_warnings();
    return prepared;
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
