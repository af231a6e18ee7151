#include "scene/style.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/error.h"

namespace motes {
namespace {

struct Style {
  std::string_view name;
  /// own: the scene's; surfaces: of its grids, or else of the particles.
  enum class Fields { none, own, surfaces } fields;
  double ball_scale = 0;    ///< of van der Waals radii; 0: no balls
  double stick_radius = 0;  ///< Å; 0: no sticks
};

// Sticks end in balls that are as wide as they are, or wider.
constexpr Style styles[] = {{"volume", Style::Fields::own},
                            {"spheres", Style::Fields::none, 1},
                            {"ball-and-stick", Style::Fields::none, 0.25, 0.15},
                            {"volume+balls", Style::Fields::own, 0.15, 0.08},
                            {"surface", Style::Fields::surfaces}};

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

/// What other programs call styles, or people at first.
constexpr struct {
  std::string_view name, meant;
} other_names[] = {{"balls", "'spheres' or 'ball-and-stick'"},
                   {"vdw", "'spheres'"},
                   {"sticks", "'ball-and-stick'"},
                   {"licorice", "'ball-and-stick'"},
                   {"cpk", "'ball-and-stick'"},
                   {"isosurface", "'surface'"}};

Error unknown_style(std::string_view name) {
  for (const auto& other : other_names) {
    if (name != other.name) continue;
    return Error(fmt::format("unknown style '{}'; did you mean {}?", name, other.meant));
  }
  return unknown_name("style", name, style_names());
}

const Style& find_style(std::string_view name) {
  const auto* const found = std::find_if(std::begin(styles), std::end(styles),
                                         [&](const Style& style) { return style.name == name; });
  if (found == std::end(styles)) throw unknown_style(name);
  return *found;
}

std::vector<Geometry> geometry_of(const Style& style) {
  std::vector<Geometry> geometry;
  if (style.ball_scale > 0) geometry.emplace_back().scale = style.ball_scale;
  if (style.stick_radius > 0) {
    Geometry& sticks = geometry.emplace_back();
    sticks.type = Geometry::Type::sticks;
    sticks.radius = style.stick_radius;
  }
  return geometry;
}

/// Isosurfaces of the scene's grids, with the data's particles as balls and sticks; without grids
/// the molecular surface.
void draw_surfaces(const DataContents& data, Scene& scene) {
  std::erase_if(scene.fields, [](const Field& field) { return !field.grid; });
  if (scene.fields.empty()) {
    scene.fields = {quick_surf()};
    return;
  }
  for (Field& field : scene.fields) {
    field.transfer_function = {};
    field.isosurfaces.clear();
    field.fitted_isosurfaces = true;
    // Of a grid of which the scene says nothing: on surfaces trilinear cells are seen.
    if (field.grid == FieldGrid{}) field.grid->interpolation = Reconstruction::tricubic;
  }
  if (data.particles) scene.geometry = geometry_of(find_style("ball-and-stick"));
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

void check_fields_of_style(std::string_view name, const std::vector<Field>& fields) {
  const Style::Fields drawn = find_style(name).fields;
  const bool draws_grids = drawn == Style::Fields::surfaces;
  const auto is_drawn = [&](const Field& field) {
    return drawn == Style::Fields::own || (draws_grids && field.grid);
  };
  if (std::all_of(fields.begin(), fields.end(), is_drawn)) return;
  throw Error(fmt::format("expected no fields{} with the style '{}', which draws none of them",
                          draws_grids ? " of particles" : "", name));
}

void apply_style(std::string_view name, Scene& scene, const DataContents& data) {
  const Style& style = find_style(name);
  scene.geometry = geometry_of(style);
  if (style.fields == Style::Fields::none) {
    scene.fields.clear();
    return;
  }
  if (scene.fields.empty() && data.grids) scene.fields.emplace_back().grid.emplace();
  if (style.fields == Style::Fields::surfaces) {
    draw_surfaces(data, scene);
  } else if (scene.fields.empty()) {
    scene.fields.emplace_back().name = "all";
  }
}

}  // namespace motes
