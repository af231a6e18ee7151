// FILE or SCENE.json of the command line -> scene and particles.
#pragma once

#include <filesystem>
#include <string>

#include "motes/console.h"
#include "motes/scene_options.h"
#include "particles/particle_set.h"
#include "scene/scene.h"

namespace motes {

/// The scene in `path` if it is a scene file, else a scene of the particles in `path`, all
/// defaults.
Scene open_scene(const std::filesystem::path& path);

struct Input {
  std::string format;
  ParticleSet particles;
  double read_ms = 0;
};

/// Reads the scene's frame of its data.
Input read_particles(const Scene& scene, Console& console);

/// Throws Error, with the option or the key of the scene file at `path`, where the fields name what
/// the particles do not have.
void check_fields(const Scene& scene, const std::filesystem::path& path,
                  const SceneChanges& changes, const ParticleSet& particles);

/// Throws what `message` says of a key of the camera: "camera.up: what". Names the option that gave
/// the camera, or the scene file at `path`.
[[noreturn]] void fail_with_camera(const std::string& message, const std::filesystem::path& path,
                                   const SceneChanges& changes);

}  // namespace motes
