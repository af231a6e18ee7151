// FILE or SCENE.json of the command line -> scene, particles and grids.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/error.h"
#include "motes/console.h"
#include "motes/scene_options.h"
#include "particles/particle_set.h"
#include "scene/scene.h"

namespace motes {

/// The scene in `path` if it is a scene file, else a scene of the particles or grids in `path`, all
/// defaults: grids as fields, with balls and sticks if the file has atoms too.
Scene open_scene(const std::filesystem::path& path);

struct Input {
  std::string format;
  ParticleSet particles;
  std::vector<LoadedGrid> grids;
  double read_ms = 0;
};

/// Reads the scene's frame of its particles, if it shows any, and the grids of its fields.
Input read_input(const Scene& scene, Console& console);
/// The particles alone.
Input read_particles(const Scene& scene, Console& console);

/// Throws `message`, a mistake that shows only in the data and knows at most the scene's key, as in
/// "camera.up: what". Names the option that gave the key, or else the file at `path`.
[[noreturn]] void fail_in_place(const std::string& message, const std::filesystem::path& path,
                                const SceneChanges& changes);

/// Does `work` with the scene or the particles of the file at `path`; what it throws gets its place
/// by fail_in_place().
template <class Work>
auto with_place(const std::filesystem::path& path, const SceneChanges& changes, Work&& work) {
  try {
    return work();
  } catch (const Error& error) {
    fail_in_place(error.what(), path, changes);
  }
}

}  // namespace motes
