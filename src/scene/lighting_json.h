// What scene files say of lights.
#pragma once

#include <nlohmann/json.hpp>

#include "scene/checked_json.h"
#include "scene/scene.h"

namespace motes {

/// The key "render.lighting". Throws Error as read_scene() does.
Lighting read_lighting(const CheckedJson& value);

nlohmann::ordered_json to_json(const Lighting& lighting);

}  // namespace motes
