// Options of the command line that override what the scene says.
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "scene/scene.h"

namespace CLI {
class App;
}

namespace motes {

/// What the options on the command line change in a scene, in the order in which they were given.
class SceneChanges {
 public:
  using Change = std::function<void(Scene&)>;

  void add(const std::string& option, Change change) {
    changes_.emplace_back(option, std::move(change));
  }
  void apply(Scene& scene) const {
    for (const auto& [option, change] : changes_) change(scene);
  }
  /// Whether `option` was given, as "--radius".
  bool contains(const std::string& option) const;

 private:
  std::vector<std::pair<std::string, Change>> changes_;
};

/// --frame, --types: which particles. `changes` must outlive the parsing.
void add_data_options(CLI::App& command, SceneChanges& changes);
/// --radius, --weight, --support-factor, --kernel-scale: what the fields are.
void add_field_options(CLI::App& command, SceneChanges& changes);
/// --size: one of add_picture_options(), for commands that take no other of them.
void add_size_option(CLI::App& command, SceneChanges& changes);
/// Camera, transfer function, lighting and so on: what the picture shows of them.
void add_picture_options(CLI::App& command, SceneChanges& changes);

}  // namespace motes
