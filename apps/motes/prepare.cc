// Puts the library's steps in their order.
#include "motes/prepare.h"

#include <utility>

#include "motes/input.h"
#include "render/resolve.h"
#include "scene/fill_in.h"

namespace motes {

PreparedScene prepare_scene(Scene scene, const ParticleSet& particles,
                            const std::filesystem::path& path, const SceneChanges& changes,
                            Console& console) {
  return with_place(path, changes, [&]() -> PreparedScene {
    color_by_species(scene, particles);
    const auto fields = expand_fields(scene, particles);
    const auto sources =
        make_field_sources(particles, fields, scene.kernel, console.warnings(), &console);
    const auto geometry = make_geometry_source(particles, scene.geometry, console.warnings());
    console.print_warnings();
    console.update("building the tree", 0);
    Renderer renderer(particles, sources, geometry);
    ResolvedScene resolved =
        resolve(scene, particles, fields, sources, geometry, renderer.kernels(), &console);
    renderer.prepare(resolved.render.engine);
    console.finish();
    Scene filled_in = fill_in(scene, fields, sources, resolved);
    return {std::move(renderer),
            std::move(resolved),
            std::move(filled_in),
            {particles.bounds(), particles.length_unit}};
  });
}

PreparedScene read_and_prepare_scene(const Scene& scene, const std::filesystem::path& path,
                                     const SceneChanges& changes, Console& console) {
  const Input input = read_particles(scene, console);
  PreparedScene prepared = prepare_scene(scene, input.particles, path, changes, console);
  prepared.read_ms = input.read_ms;
  return prepared;
}

}  // namespace motes
