#include "scene/geometry_json.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "core/error.h"
#include "particles/selection.h"

namespace motes {
namespace {

using json = nlohmann::ordered_json;
using Value = CheckedJson;

constexpr double default_stick_radius = 0.15;  // angstrom
constexpr std::size_t max_items = 64;

decltype(Geometry::radius) read_radius(const Value& value, Geometry::Type type) {
  const bool sticks = type == Geometry::Type::sticks;
  const char* what = sticks ? "a number greater than 0"
                            : "\"van_der_waals\", \"covalent\", a number greater than 0 or the "
                              "name of a property";
  if (value.raw().is_string() && !sticks) {
    std::string name = value.text(what);
    if (const auto table = element_radius_from_name(name)) return *table;
    return name;
  }
  if (!value.raw().is_number()) value.expected(what);
  const double number = value.number();
  const auto single = static_cast<float>(number);
  if (!std::isfinite(single) || !(single > 0)) value.expected(what);
  return number;
}

ColorByProperty read_color_by_property(const Value& value) {
  value.check_keys({"property", "map", "range"});
  ColorByProperty color;
  color.property = value.at("property").text("the name of a property");
  value.with("map", [&](const Value& v) {
    color.map = v.text("the name of a colour map");
    const auto& names = color_map_names();
    if (std::find(names.begin(), names.end(), color.map) == names.end()) {
      v.fail(unknown_name("colour map", color.map, names).what());
    }
  });
  value.with("range", [&](const Value& v) {
    const auto ends = v.array_of(2, "an array of two numbers, low and high");
    color.range = {ends[0].number(), ends[1].number()};
    if (!(color.range->first < color.range->second)) v.fail("expected low < high");
  });
  return color;
}

decltype(Geometry::color) read_color(const Value& value) {
  if (value.raw().is_object()) return read_color_by_property(value);
  if (value.raw() == "element") return ColorBy::element;
  if (value.raw() == "species") return ColorBy::species;
  if (value.raw() == "field") return ColorBy::field;
  if (value.raw().is_string() && !color_from_text(value.raw().get<std::string>())) {
    value.expected(
        "\"element\", \"species\", \"field\", a colour such as \"#ff8000\", or "
        "{\"property\": NAME}");
  }
  return value.color();
}

BondSource read_bonds(const Value& value) {
  const std::string what = "\"automatic\", \"file\" or \"distance\"";
  const std::string text = value.text(what);
  if (text == "automatic") return BondSource::automatic;
  if (text == "file") return BondSource::file;
  if (text == "distance") return BondSource::distance;
  value.expected(what);
}

Geometry read_item(const Value& value) {
  value.check_keys({"type", "select", "radius", "scale", "color", "bonds"});
  Geometry item;
  const std::string type = value.at("type").text("\"spheres\" or \"sticks\"");
  if (type == "sticks") {
    item.type = Geometry::Type::sticks;
    item.radius = default_stick_radius;
    if (value.has("scale")) value.at("scale").fail("sticks have none; expected a radius");
  } else if (type != "spheres") {
    value.at("type").expected("\"spheres\" or \"sticks\"");
  } else if (value.has("bonds")) {
    value.at("bonds").fail("spheres have none; expected \"type\": \"sticks\"");
  }
  value.with("select", [&](const Value& v) { item.select = read_selection(v); });
  value.with("radius", [&](const Value& v) { item.radius = read_radius(v, item.type); });
  value.with("scale", [&](const Value& v) { item.scale = v.number_above(0); });
  value.with("color", [&](const Value& v) { item.color = read_color(v); });
  value.with("bonds", [&](const Value& v) { item.bonds = read_bonds(v); });
  return item;
}

}  // namespace

Selection read_selection(const Value& value) {
  value.check_keys({"species", "index", "expression"});
  Selection select;
  value.with("species", [&](const Value& v) {
    if (v.raw().is_string()) {
      select.species = {v.text("the name of a species")};
      return;
    }
    const auto items = v.array("an array of names");
    if (items.empty()) v.expected("an array of at least one name");
    for (const Value& item : items) select.species.push_back(item.text("the name of a species"));
  });
  value.with("index", [&](const Value& v) {
    const auto ends = v.array_of(2, "an array of two whole numbers, first and last");
    constexpr auto most = std::numeric_limits<std::uint64_t>::max();
    select.index = {ends[0].integer(0, most), ends[1].integer(0, most)};
    if (select.index->first > select.index->second) v.fail("expected first <= last");
  });
  value.with("expression", [&](const Value& v) {
    select.expression = v.text("an expression over properties");
    try {
      check_expression(select.expression);
    } catch (const Error& error) {
      v.fail(error.what());
    }
  });
  return select;
}

std::vector<Geometry> read_geometry(const Value& value) {
  const auto items = value.array("an array of spheres and sticks");
  if (items.size() > max_items) {
    value.expected(fmt::format("an array of at most {} items", max_items));
  }
  std::vector<Geometry> geometry;
  bool any_sticks = false;
  for (const Value& item : items) {
    geometry.push_back(read_item(item));
    if (geometry.back().type != Geometry::Type::sticks) continue;
    if (any_sticks) item.fail("expected sticks only once");
    any_sticks = true;
  }
  return geometry;
}

SurfaceSettings read_surface_settings(const Value& value) {
  value.check_keys({"antialiasing", "ambient_occlusion", "occlusion_distance", "shadows",
                    "light_angle", "seed"});
  SurfaceSettings settings;
  value.with("antialiasing",
             [&](const Value& v) { settings.antialiasing = static_cast<int>(v.integer(1, 8)); });
  value.with("ambient_occlusion", [&](const Value& v) {
    settings.occlusion_samples = static_cast<int>(v.integer(0, 4096));
  });
  value.with("occlusion_distance",
             [&](const Value& v) { settings.occlusion_distance = v.number_above(0); });
  value.with("shadows", [&](const Value& v) { settings.shadows = v.boolean(); });
  value.with("light_angle", [&](const Value& v) {
    settings.light_angle = v.number_from_zero();
    if (settings.light_angle > 90) v.expected("an angle of 0 to 90 degrees");
  });
  value.with("seed", [&](const Value& v) {
    settings.seed =
        static_cast<std::uint32_t>(v.integer(0, std::numeric_limits<std::uint32_t>::max()));
  });
  return settings;
}

json color_to_json(const Color& color) {
  const std::uint32_t srgb = color_to_srgb(color);
  if (color_from_srgb(srgb) == color) return fmt::format("#{:06x}", srgb);
  return json::array({color.r, color.g, color.b});
}

json to_json(const Selection& select) {
  json out = json::object();
  if (!select.species.empty()) out["species"] = select.species;
  if (select.index) out["index"] = {select.index->first, select.index->second};
  if (!select.expression.empty()) out["expression"] = select.expression;
  return out;
}

json to_json(const Geometry& geometry) {
  const bool sticks = geometry.type == Geometry::Type::sticks;
  json out{{"type", sticks ? "sticks" : "spheres"}};
  if (geometry.select != Selection{}) out["select"] = to_json(geometry.select);
  if (const auto* table = std::get_if<ElementRadius>(&geometry.radius)) {
    out["radius"] = *table == ElementRadius::covalent ? "covalent" : "van_der_waals";
  } else if (const auto* number = std::get_if<double>(&geometry.radius)) {
    out["radius"] = *number;
  } else {
    out["radius"] = std::get<std::string>(geometry.radius);
  }
  if (!sticks) out["scale"] = geometry.scale;
  if (const auto* by = std::get_if<ColorBy>(&geometry.color)) {
    out["color"] = *by == ColorBy::element   ? "element"
                   : *by == ColorBy::species ? "species"
                                             : "field";
  } else if (const auto* color = std::get_if<Color>(&geometry.color)) {
    out["color"] = color_to_json(*color);
  } else {
    const auto& property = std::get<ColorByProperty>(geometry.color);
    out["color"] = {{"property", property.property}, {"map", property.map}};
    if (property.range) out["color"]["range"] = {property.range->first, property.range->second};
  }
  if (sticks) {
    constexpr const char* names[] = {"automatic", "file", "distance"};
    out["bonds"] = names[static_cast<int>(geometry.bonds)];
  }
  return out;
}

json to_json(const SurfaceSettings& settings) {
  json out{{"antialiasing", settings.antialiasing},
           {"ambient_occlusion", settings.occlusion_samples},
           {"shadows", settings.shadows},
           {"light_angle", settings.light_angle},
           {"seed", settings.seed}};
  if (settings.occlusion_distance) out["occlusion_distance"] = *settings.occlusion_distance;
  return out;
}

}  // namespace motes
