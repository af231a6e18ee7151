// FILE or SCENE.json of the command line -> scene and particles.
#pragma once

#include <filesystem>
#include <string>

#include "motes/console.h"
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

/// The fields of the scene, ready to be sampled.
std::vector<FieldSource> make_field_sources(const std::vector<Field>& fields, const Kernel& kernel,
                                            const ParticleSet& particles, Console& console);

}  // namespace motes
