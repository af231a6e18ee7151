// FILE or SCENE.json of the command line -> scene, particles and grids, with the console.
#pragma once

#include <filesystem>
#include <string>

#include "core/error.h"
#include "document/input.h"
#include "motes/console.h"
#include "motes/scene_options.h"

namespace motes {

/// read_input() and read_particles() that print their warnings.
Input read_input(const Scene& scene, Console& console);
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
