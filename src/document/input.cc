// Opens scenes and reads their particles.
#include "document/input.h"

#include <fmt/format.h>

#include <algorithm>
#include <iostream>
#include <iterator>
#include <memory>
#include <system_error>
#include <utility>

#include "core/error.h"
#include "core/stopwatch.h"
#include "io/grid_reader.h"
#include "io/reader.h"
#include "scene/style.h"

namespace motes {

namespace {

/// Throws Error, as a fault of the scene at `scene_path`, if the file that `key` names is not
/// there.
void check_exists(const std::filesystem::path& file, const std::string& key,
                  const std::filesystem::path& scene_path) {
  std::error_code error;
  if (file.empty() || std::filesystem::exists(file, error) || error) return;
  throw Error(scene_path,
              fmt::format("{}: {}: there is no such file", key, printable(file.string(), 4096)));
}

/// Shows the grids of its data, with their atoms, where a scene leaves to the data what is drawn.
void show_grids(Scene& scene) {
  if (!scene.fields.empty() || !scene.geometry.empty()) return;
  const DataContents data = look_at_data(scene.data_path);
  if (data.grids) apply_style(data.particles ? "volume+balls" : "volume", scene, data);
}

Scene read_scene_from(std::istream& stream, const std::filesystem::path& name) {
  const std::string text{std::istreambuf_iterator<char>(stream), {}};
  return parse_scene(text, name, look_at_data);
}

}  // namespace

DataContents look_at_data(const std::filesystem::path& path) {
  std::error_code error;
  if (path.empty()) return {.particles = false};
  if (!std::filesystem::exists(path, error) || !is_grid_file(path)) return {};
  return {.particles = has_particles(path), .grids = true};
}

bool shows_particles(const Scene& scene) {
  return scene.fields.empty() || !scene.geometry.empty() ||
         std::any_of(scene.fields.begin(), scene.fields.end(),
                     [](const Field& field) { return !field.grid; });
}

std::vector<LoadedGrid> read_grids_of(const Scene& scene, const std::vector<LoadedGrid>& known,
                                      Progress* progress, Warnings& warnings) {
  const ReadOptions options{scene.types, progress, &warnings};
  std::vector<LoadedGrid> loaded;
  for (const Field& field : scene.fields) {
    if (!field.grid) continue;
    const std::filesystem::path& path = field.grid->path;
    const auto is_of_path = [&path](const LoadedGrid& grid) { return grid.path == path; };
    if (std::any_of(loaded.begin(), loaded.end(), is_of_path)) continue;
    if (std::any_of(known.begin(), known.end(), is_of_path)) {
      std::copy_if(known.begin(), known.end(), std::back_inserter(loaded), is_of_path);
      continue;
    }
    for (Grid& grid : read_grids(path.empty() ? scene.data_path : path, options)) {
      loaded.push_back({path, std::make_shared<const Grid>(std::move(grid))});
    }
  }
  return loaded;
}

Scene open_scene(const std::filesystem::path& path) {
  Scene scene;
  const bool is_piped = path == "-";
  if (!is_piped && !is_scene_file(path)) {
    scene.data_path = path;
    show_grids(scene);
    return scene;
  }
  scene = is_piped ? read_scene_from(std::cin, path) : read_scene(path, look_at_data);
  check_exists(scene.data_path, "data.path", path);
  for (std::size_t f = 0; f < scene.fields.size(); ++f) {
    const auto& grid = scene.fields[f].grid;
    if (grid) check_exists(grid->path, fmt::format("fields[{}].grid", f), path);
  }
  if (!scene.data_path.empty()) show_grids(scene);
  return scene;
}

Input read_input(const Scene& scene, Progress* progress, Warnings& warnings) {
  const Stopwatch stopwatch;
  Input input;
  if (shows_particles(scene)) input = read_particles(scene, progress, warnings);
  input.grids = read_grids_of(scene, {}, progress, warnings);
  input.read_ms = stopwatch.milliseconds();
  return input;
}

Input read_particles(const Scene& scene, Progress* progress, Warnings& warnings) {
  const Stopwatch stopwatch;
  const ReadOptions options{scene.types, progress, &warnings};
  const auto trajectory = open_trajectory(scene.data_path, options);
  Input input;
  input.format = trajectory->format();
  input.particles = trajectory->read_frame(scene.frame);
  input.read_ms = stopwatch.milliseconds();
  if (input.particles.size() == 0) throw Error(scene.data_path, "has no particles in this frame");
  return input;
}

}  // namespace motes
