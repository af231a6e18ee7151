// Every path of a client goes through resolve() before anything is opened.
#include "server/files.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <system_error>

#include "core/error.h"
#include "document/input.h"
#include "scene/checked_json.h"

namespace motes::server {

namespace fs = std::filesystem;
using nlohmann::json;

namespace {

/// The value of `key`, if `value` is an object that has one.
json* find(json& value, const char* key) {
  if (!value.is_object()) return nullptr;
  const auto found = value.find(key);
  return found == value.end() ? nullptr : &*found;
}

/// All places of a scene that may hold a path; what is not of the right type is left to
/// parse_scene().
std::vector<json*> paths_of(json& scene) {
  std::vector<json*> paths;
  const auto add = [&paths](json* value) {
    if (value != nullptr && value->is_string()) paths.push_back(value);
  };
  const auto add_in = [&add](json& value, const char* object) {
    if (json* inner = find(value, object)) add(find(*inner, "path"));
  };
  add_in(scene, "data");
  add_in(scene, "kernel");
  json* fields = find(scene, "fields");
  if (fields == nullptr || !fields->is_array()) return paths;
  for (json& field : *fields) {
    add(find(field, "grid"));
    add_in(field, "grid");
    add_in(field, "kernel");
  }
  return paths;
}

}  // namespace

std::vector<fs::path> files_of(const Scene& scene) {
  std::vector<fs::path> paths;
  const auto add = [&paths](const fs::path& path) {
    if (!path.empty()) paths.push_back(path);
  };
  add(scene.data_path);
  add(scene.kernel.shape.profile.path);
  for (const Field& field : scene.fields) {
    if (field.grid) add(field.grid->path);
    if (field.kernel_shape) add(field.kernel_shape->profile.path);
  }
  return paths;
}

void Files::allow(const Scene& scene) {
  const std::lock_guard lock(mutex_);
  for (const fs::path& path : files_of(scene)) {
    std::error_code error;
    const fs::path found = fs::canonical(path, error);
    if (!error) allowed_.insert(found);
  }
}

fs::path Files::resolve(std::string_view path) const {
  if (path.starts_with('/') && path.find('\0') == path.npos) {
    std::error_code error;
    fs::path found = fs::canonical(fs::path(std::string(path)), error);
    const std::lock_guard lock(mutex_);
    if (!error && (allowed_.contains(found) || uploads_.contains(found))) return found;
  }
  return folder_.resolve(path);
}

fs::path Files::resolve_in_scene(const fs::path& directory, const std::string& path) const {
  if (path.starts_with('/')) return resolve(path);
  try {
    return resolve((directory / path).string());
  } catch (const Error&) {
    const std::lock_guard lock(mutex_);
    if (const auto sent = uploads_.find(path)) return *sent;
  }
  throw Error(
      fmt::format("{}: there is no such file in {}, where the scene's paths lead from, and "
                  "none of that name was dropped before",
                  printable(path, 400), directory.string()));
}

Scene Files::parse_scene(std::string_view text, const fs::path& directory) const {
  json scene = parse_json(text, "scene");
  for (json* path : paths_of(scene)) {
    *path = resolve_in_scene(directory, path->get<std::string>()).string();
  }
  return motes::parse_scene(scene.dump(), "scene", look_at_data);
}

Scene Files::open_scene(const fs::path& path) const {
  if (!is_scene_file(path)) return motes::open_scene(path);
  return parse_scene(read_text(path), path.parent_path());
}

}  // namespace motes::server
