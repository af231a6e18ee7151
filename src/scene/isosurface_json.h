// What scene files say of isosurfaces.
#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "scene/checked_json.h"
#include "scene/isosurface.h"

namespace motes {

/// In place of a list: levels and colours are left to the field.
inline constexpr const char* fitted_isosurfaces = "fitted";

/// A field's key "isosurfaces", if it is a list. Throws Error as read_scene() does.
std::vector<Isosurface> read_isosurfaces(const CheckedJson& value);

nlohmann::ordered_json to_json(const Isosurface& isosurface);

}  // namespace motes
