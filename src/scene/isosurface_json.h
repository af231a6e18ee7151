// What scene files say of isosurfaces.
#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "scene/checked_json.h"
#include "scene/isosurface.h"

namespace motes {

/// A field's key "isosurfaces". Throws Error as read_scene() does.
std::vector<Isosurface> read_isosurfaces(const CheckedJson& value);

nlohmann::ordered_json to_json(const Isosurface& isosurface);

}  // namespace motes
