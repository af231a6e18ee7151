// A file or a scene -> scene, particles and grids.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/report.h"
#include "particles/particle_set.h"
#include "scene/scene.h"

namespace motes {

/// The scene in `path` if it is a scene file, else a scene of the particles or grids in `path`, all
/// defaults: grids as fields, with balls and sticks if the file has atoms too. "-" is a scene on
/// standard input, whose relative paths are relative to the working directory. Throws Error.
Scene open_scene(const std::filesystem::path& path);

/// What the file has, by its head, for parse_scene(); a path that is empty nothing, and one where
/// there is no file particles, which will be missed when they are read. Throws Error.
DataContents look_at_data(const std::filesystem::path& path);

struct Input {
  std::string format;
  ParticleSet particles;
  std::vector<LoadedGrid> grids;
  double read_ms = 0;
};

/// Whether any field or geometry of `scene` is one of particles.
bool shows_particles(const Scene& scene);

/// Reads the scene's frame of its particles, if it shows any, and the grids of its fields. Throws
/// Error, and what `progress` throws.
Input read_input(const Scene& scene, Progress* progress, Warnings& warnings);
/// The particles alone.
Input read_particles(const Scene& scene, Progress* progress, Warnings& warnings);
/// The grids of the scene's fields, each file once: those of `known` where they are there.
std::vector<LoadedGrid> read_grids_of(const Scene& scene, const std::vector<LoadedGrid>& known,
                                      Progress* progress, Warnings& warnings);

}  // namespace motes
