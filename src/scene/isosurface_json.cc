#include "scene/isosurface_json.h"

#include <fmt/format.h>

#include "scene/geometry_json.h"
#include "scene/transfer_function.h"

namespace motes {
namespace {

using json = nlohmann::ordered_json;
using Value = CheckedJson;

constexpr std::size_t max_isosurfaces = 16;

std::variant<Color, ColorBy> read_color(const Value& value) {
  if (value.raw() == "element") return ColorBy::element;
  if (value.raw() == "species") return ColorBy::species;
  if (value.raw().is_string() && !color_from_text(value.raw().get<std::string>())) {
    value.expected("\"element\", \"species\" or a colour such as \"#ff8000\"");
  }
  return value.color();
}

Isosurface read_isosurface(const Value& value) {
  value.check_keys({"value", "color", "opacity"});
  Isosurface isosurface;
  isosurface.value = value.at("value").number();
  value.with("color", [&](const Value& v) { isosurface.color = read_color(v); });
  value.with("opacity", [&](const Value& v) {
    if (!v.raw().is_number() || !(v.number() >= 0 && v.number() <= 1)) {
      v.expected("a number from 0 to 1");
    }
    isosurface.opacity = v.number();
  });
  return isosurface;
}

}  // namespace

std::vector<Isosurface> read_isosurfaces(const Value& value) {
  const auto items = value.array("an array of isosurfaces such as [{\"value\": 0.5}]");
  if (items.size() > max_isosurfaces) {
    value.expected(fmt::format("an array of at most {} isosurfaces", max_isosurfaces));
  }
  std::vector<Isosurface> isosurfaces;
  isosurfaces.reserve(items.size());
  for (const Value& item : items) isosurfaces.push_back(read_isosurface(item));
  return isosurfaces;
}

json to_json(const Isosurface& isosurface) {
  json out{{"value", isosurface.value}};
  if (isosurface.color) {
    const auto* by = std::get_if<ColorBy>(&*isosurface.color);
    if (by == nullptr) {
      out["color"] = color_to_json(std::get<Color>(*isosurface.color));
    } else {
      out["color"] = *by == ColorBy::element ? "element" : "species";
    }
  }
  out["opacity"] = isosurface.opacity;
  return out;
}

}  // namespace motes
