#include "scene/lighting_json.h"

#include <fmt/format.h>

namespace motes {
namespace {

using json = nlohmann::ordered_json;
using Value = CheckedJson;

/// Where a light is, if the file says so.
void read_direction(const Value& value, LightSource& light) {
  value.with("direction", [&](const Value& v) {
    light.direction = v.vector();
    if (!(length(*light.direction) > 0)) v.fail("a direction must not be zero");
  });
}

LightSource read_light(const Value& value) {
  if (!value.raw().is_object()) {
    value.expected(R"(an object such as {"direction": [1, 2, 1.5]} or, at the camera, {})");
  }
  value.check_keys({"direction", "intensity"});
  LightSource light;
  read_direction(value, light);
  value.with("intensity", [&](const Value& v) {
    light.intensity = v.number_from_zero();
    if (light.intensity > max_intensity) v.expected("a number from 0 to a million");
  });
  return light;
}

json to_json(const LightSource& light) {
  json out = json::object();
  if (const auto& d = light.direction) out["direction"] = json::array({d->x, d->y, d->z});
  if (light.intensity != 1) out["intensity"] = light.intensity;
  return out;
}

}  // namespace

Lighting read_lighting(const Value& value) {
  if (value.raw().is_boolean()) {
    value.expected(fmt::format("an object such as {{\"enabled\": {}}}", value.boolean()));
  }
  Lighting lighting;
  value.check_keys(
      {"enabled", "ambient", "diffuse", "specular", "shininess", "direction", "lights"});
  value.with("enabled", [&](const Value& v) { lighting.enabled = v.boolean(); });
  value.with("ambient", [&](const Value& v) { lighting.ambient = v.number_from_zero(); });
  value.with("diffuse", [&](const Value& v) { lighting.diffuse = v.number_from_zero(); });
  value.with("specular", [&](const Value& v) { lighting.specular = v.number_from_zero(); });
  value.with("shininess", [&](const Value& v) { lighting.shininess = v.number_from_zero(); });
  read_direction(value, lighting.lights[0]);
  value.with("lights", [&](const Value& v) {
    if (lighting.lights[0].direction) value.fail("expected either direction or lights, found both");
    lighting.lights = v.few<LightSource>("lights", max_lights, read_light);
  });
  return lighting;
}

json to_json(const Lighting& lighting) {
  json out{{"enabled", lighting.enabled},
           {"ambient", lighting.ambient},
           {"diffuse", lighting.diffuse},
           {"specular", lighting.specular},
           {"shininess", lighting.shininess}};
  const auto& lights = lighting.lights;
  if (lights.size() == 1 && lights[0].intensity == 1) {
    out.update(to_json(lights[0]));
    return out;
  }
  out["lights"] = json::array();
  for (const LightSource& light : lights) out["lights"].push_back(to_json(light));
  return out;
}

}  // namespace motes
