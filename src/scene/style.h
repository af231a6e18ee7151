// Styles: names for what a scene draws.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "scene/scene.h"

namespace motes {

/// "volume", "spheres", "ball-and-stick", "volume+balls", "surface".
const std::vector<std::string>& style_names();

/// Makes `scene` draw what the style names (docs/scene.md, "Styles"): the geometry becomes the
/// style's own; fields stay where the style draws any, and there is one of all particles if there
/// was none; those of "surface" are its own. Throws Error for an unknown name.
void apply_style(std::string_view name, Scene& scene);

/// The balls and sticks of a style. Throws Error for an unknown name.
std::vector<Geometry> geometry_of_style(std::string_view name);
/// Whether the style draws the scene's own fields. Throws Error for an unknown name.
bool style_draws_fields(std::string_view name);

}  // namespace motes
