// prepare_scene() with the console and the places of mistakes: what render and bench share.
#pragma once

#include <filesystem>
#include <vector>

#include "document/prepare.h"
#include "motes/console.h"
#include "motes/scene_options.h"

namespace motes {

/// `path` is the file that messages name (with_place()).
PreparedScene prepare_scene(Scene scene, const ParticleSet& particles,
                            const std::filesystem::path& path, const SceneChanges& changes,
                            Console& console, const std::vector<LoadedGrid>& grids = {});
/// The same with the particles and grids of the scene's files; they are gone when this returns.
PreparedScene read_and_prepare_scene(const Scene& scene, const std::filesystem::path& path,
                                     const SceneChanges& changes, Console& console);

}  // namespace motes
