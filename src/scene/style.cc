#include "scene/style.h"

#include <algorithm>

#include "core/error.h"

namespace motes {
namespace {

struct Style {
  std::string_view name;
  bool fields;
  double ball_scale = 0;    ///< of van der Waals radii; 0: no balls
  double stick_radius = 0;  ///< Å; 0: no sticks
};

// Sticks end in balls that are as wide as they are, or wider.
constexpr Style styles[] = {{"volume", true},
                            {"spheres", false, 1},
                            {"ball-and-stick", false, 0.25, 0.15},
                            {"volume+balls", true, 0.15, 0.08}};

const Style& find_style(std::string_view name) {
  const auto* const found = std::find_if(std::begin(styles), std::end(styles),
                                         [&](const Style& style) { return style.name == name; });
  if (found == std::end(styles)) throw unknown_name("style", name, style_names());
  return *found;
}

}  // namespace

const std::vector<std::string>& style_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (const Style& style : styles) all.emplace_back(style.name);
    return all;
  }();
  return names;
}

bool style_draws_fields(std::string_view name) { return find_style(name).fields; }

std::vector<Geometry> geometry_of_style(std::string_view name) {
  const Style& style = find_style(name);
  std::vector<Geometry> geometry;
  if (style.ball_scale > 0) geometry.emplace_back().scale = style.ball_scale;
  if (style.stick_radius > 0) {
    Geometry& sticks = geometry.emplace_back();
    sticks.type = Geometry::Type::sticks;
    sticks.radius = style.stick_radius;
  }
  return geometry;
}

void apply_style(std::string_view name, Scene& scene) {
  scene.geometry = geometry_of_style(name);
  if (!style_draws_fields(name)) {
    scene.fields.clear();
  } else if (scene.fields.empty()) {
    scene.fields.emplace_back().name = "all";
  }
}

}  // namespace motes
