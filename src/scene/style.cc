#include "scene/style.h"

#include <algorithm>

#include "core/error.h"

namespace motes {
namespace {

struct Style {
  std::string_view name;
  enum class Fields { none, own, surface } fields;  ///< own: the scene's
  double ball_scale = 0;                            ///< of van der Waals radii; 0: no balls
  double stick_radius = 0;                          ///< Å; 0: no sticks
};

// Sticks end in balls that are as wide as they are, or wider.
constexpr Style styles[] = {{"volume", Style::Fields::own},
                            {"spheres", Style::Fields::none, 1},
                            {"ball-and-stick", Style::Fields::none, 0.25, 0.15},
                            {"volume+balls", Style::Fields::own, 0.15, 0.08},
                            {"surface", Style::Fields::surface}};

/// The molecular surface of VMD's QuickSurf (docs/isosurface.md).
Field quick_surf() {
  Field field;
  field.name = "surface";
  field.radius = "van_der_waals";
  field.weight = 1.0;
  field.normalise = false;
  field.kernel_shape = KernelShape{};
  field.support_factor = 4;  // where VMD's best quality ends it: a jump of 0.03 %
  field.kernel_scale = 1;
  field.isosurfaces = {{0.5, ColorBy::element, 1}};
  return field;
}

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

bool style_draws_fields(std::string_view name) {
  return find_style(name).fields == Style::Fields::own;
}

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
  const Style::Fields fields = find_style(name).fields;
  if (fields == Style::Fields::surface) {
    scene.fields = {quick_surf()};
  } else if (fields == Style::Fields::none) {
    scene.fields.clear();
  } else if (scene.fields.empty()) {
    scene.fields.emplace_back().name = "all";
  }
}

}  // namespace motes
