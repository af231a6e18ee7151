// Opens scenes and reads their particles.
#include "motes/input.h"

#include <fmt/format.h>

#include <chrono>

#include "core/error.h"
#include "io/reader.h"
#include "scene/field_mistake.h"

namespace motes {

Scene open_scene(const std::filesystem::path& path) {
  if (is_scene_file(path)) return read_scene(path);
  Scene scene;
  scene.data_path = path;
  return scene;
}

Input read_particles(const Scene& scene, Console& console) {
  const auto start = std::chrono::steady_clock::now();
  const ReadOptions options{scene.types, &console, &console.warnings()};
  const auto trajectory = open_trajectory(scene.data_path, options);
  Input input;
  input.format = trajectory->format();
  input.particles = trajectory->read_frame(scene.frame);
  const std::chrono::duration<double, std::milli> elapsed =
      std::chrono::steady_clock::now() - start;
  input.read_ms = elapsed.count();
  console.print_warnings();
  if (input.particles.size() == 0) throw Error(scene.data_path, "has no particles in this frame");
  return input;
}

void check_fields(const Scene& scene, const std::filesystem::path& path,
                  const SceneChanges& changes, const ParticleSet& particles) {
  const auto mistake = find_mistake(scene.fields, particles);
  if (!mistake) return;
  const std::string option = "--" + mistake->key;
  if (changes.contains(option)) throw Error(fmt::format("{}: {}", option, mistake->message));
  throw Error(path,
              fmt::format("fields[{}].{}: {}", mistake->field, mistake->key, mistake->message));
}

void fail_with_camera(const std::string& message, const std::filesystem::path& path,
                      const SceneChanges& changes) {
  for (const std::string key : {"up", "eye", "target"}) {
    const std::string option = "--" + key, place = "camera." + key + ": ";
    if (message.starts_with(place) && changes.contains(option)) {
      throw Error(fmt::format("{}: {}", option, message.substr(place.size())));
    }
  }
  throw Error(path, message);
}

}  // namespace motes
