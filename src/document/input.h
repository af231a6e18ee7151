// FILE or SCENE.json -> scene, particles and grids.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/report.h"
#include "particles/particle_set.h"
#include "scene/scene.h"

namespace motes {

/// The scene in `path` if it is a scene file, else a scene of the particles or grids in `path`, all
/// defaults: grids as fields, with balls and sticks if the file has atoms too. "-": a scene on
/// standard input, whose paths are relative to the working directory. Throws Error.
Scene open_scene(const std::filesystem::path& path);

/// Completes a scene that leaves its fields to the data: where these are grids, they are the
/// fields. open_scene() does so.
void show_grids(Scene& scene);

/// What a scene is of.
struct Input {
  std::string format;
  ParticleSet particles;
  std::vector<LoadedGrid> grids;
  double read_ms = 0;
};

/// Reads the scene's frame of its particles, if it shows any, and the grids of its fields.
Input read_input(const Scene& scene, Progress* progress, Warnings& warnings);
/// The particles alone. Throws Error where there are none.
Input read_particles(const Scene& scene, Progress* progress, Warnings& warnings);

}  // namespace motes
