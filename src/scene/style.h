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
/// style's own; fields stay where the style draws them, and if there is none it is the grids of the
/// scene's data, or else all particles. Throws Error for an unknown name.
void apply_style(std::string_view name, Scene& scene, const DataContents& data = {});

/// Throws Error if a scene cannot have both the style and these fields, or for an unknown name.
void check_fields_of_style(std::string_view name, const std::vector<Field>& fields);

}  // namespace motes
