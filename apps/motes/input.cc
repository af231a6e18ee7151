// Opens scenes and reads their particles.
#include "motes/input.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/error.h"
#include "core/stopwatch.h"
#include "io/reader.h"

namespace motes {

Scene open_scene(const std::filesystem::path& path) {
  Scene scene;
  if (is_scene_file(path)) {
    scene = read_scene(path);
    std::error_code error;
    if (!std::filesystem::exists(scene.data_path, error) && !error) {
      throw Error(path, fmt::format("data.path: {}: there is no such file",
                                    printable(scene.data_path.string(), 4096)));
    }
    return scene;
  }
  scene.data_path = path;
  return scene;
}

Input read_particles(const Scene& scene, Console& console) {
  const Stopwatch stopwatch;
  const ReadOptions options{scene.types, &console, &console.warnings()};
  const auto trajectory = open_trajectory(scene.data_path, options);
  Input input;
  input.format = trajectory->format();
  input.particles = trajectory->read_frame(scene.frame);
  input.read_ms = stopwatch.milliseconds();
  console.print_warnings();
  if (input.particles.size() == 0) throw Error(scene.data_path, "has no particles in this frame");
  return input;
}

void fail_in_place(const std::string& message, const std::filesystem::path& path,
                   const SceneChanges& changes) {
  // The option of "fields[0].radius" is --radius, that of "render.step_size" --step-size.
  const auto end = message.find_first_not_of("abcdefghijklmnopqrstuvwxyz_.[]0123456789");
  if (end != message.npos && message.compare(end, 2, ": ") == 0) {
    const std::string key = message.substr(0, end);
    std::string option = "--" + key.substr(key.rfind('.') + 1);
    std::replace(option.begin(), option.end(), '_', '-');
    if (changes.contains(option)) {
      throw Error(fmt::format("{}: {}", option, message.substr(end + 2)));
    }
  }
  throw Error(path, message);
}

}  // namespace motes
