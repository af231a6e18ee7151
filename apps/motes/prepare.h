// From particles and a scene with open ends to what is rendered: what render and bench share.
#pragma once

#include <filesystem>

#include "motes/console.h"
#include "motes/picture_warnings.h"
#include "motes/scene_options.h"
#include "particles/particle_set.h"
#include "render/renderer.h"
#include "scene/scene.h"

namespace motes {

struct PreparedScene {
  Renderer renderer;
  ResolvedScene resolved;
  Scene filled_in;  ///< the scene with all that was fitted to the data
  DataExtent extent;
  double read_ms = 0;  ///< 0 where the particles were there already
};

/// Gathers the scene's fields of `particles`, builds the tree and fits what the scene leaves open;
/// `particles` and `grids` are not needed afterwards. `path` is the file that messages name
/// (with_place()).
PreparedScene prepare_scene(Scene scene, const ParticleSet& particles,
                            const std::filesystem::path& path, const SceneChanges& changes,
                            Console& console, const std::vector<LoadedGrid>& grids = {});
/// The same with the particles and grids of the scene's files; they are gone when this returns.
PreparedScene read_and_prepare_scene(const Scene& scene, const std::filesystem::path& path,
                                     const SceneChanges& changes, Console& console);

}  // namespace motes
