// What scene files say of balls and sticks.
#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "scene/checked_json.h"
#include "scene/scene.h"

namespace motes {

/// The key "geometry". Throws Error as read_scene() does.
std::vector<Geometry> read_geometry(const CheckedJson& value);
/// "render.surface".
SurfaceSettings read_surface_settings(const CheckedJson& value);
/// A selection of fields and geometry: "select".
Selection read_selection(const CheckedJson& value);

nlohmann::ordered_json to_json(const Geometry& geometry);
nlohmann::ordered_json to_json(const SurfaceSettings& settings);
nlohmann::ordered_json to_json(const Selection& select);
/// "#rrggbb" where that is the colour exactly, else three linear numbers.
nlohmann::ordered_json color_to_json(const Color& color);

}  // namespace motes
