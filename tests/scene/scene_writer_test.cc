// That scenes are read as they were written.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>

#include "core/error.h"
#include "scene/scene.h"

namespace motes {
namespace {

double random_double(int low, int high) { return *rc::gen::inRange(low, high) / 7.0; }

template <class F>
auto maybe(F&& make) -> std::optional<decltype(make())> {
  if (*rc::gen::arbitrary<bool>()) return make();
  return std::nullopt;
}

std::string random_name() { return *rc::gen::nonEmpty(rc::gen::string<std::string>()); }

/// Text that is UTF-8, as JSON demands.
std::string random_text() {
  std::string text = "é";
  for (const char c : random_name()) text += static_cast<char>(c & 0x7f);
  return text;
}

Vector3d random_vector() {
  return {random_double(-999, 999), random_double(1, 999), random_double(-999, 999)};
}

Color random_color() {
  if (*rc::gen::arbitrary<bool>()) return color_from_srgb(*rc::gen::inRange(0u, 0x1000000u));
  const auto channel = [] { return static_cast<float>(random_double(0, 20)); };
  return {channel(), channel(), channel()};
}

decltype(Field::transfer_function) random_transfer_function() {
  const int kind = *rc::gen::inRange(0, 3);
  if (kind == 0) return {};
  if (kind == 1) {
    NamedTransferFunction named{"plasma", {}, {}, {}};
    named.log_scale = maybe([] { return *rc::gen::arbitrary<bool>(); });
    named.extinction = maybe([] { return random_double(0, 9); });
    named.range = maybe([] {
      const double low = random_double(1, 99);
      return std::pair(low, low + random_double(1, 99));
    });
    return named;
  }
  TransferFunction function;
  function.log_scale = *rc::gen::arbitrary<bool>();
  double value = random_double(1, 9);
  for (int n = *rc::gen::inRange(1, 6); n > 0; --n, value += random_double(1, 9)) {
    function.points.push_back({value, random_color(), random_double(0, 99)});
  }
  return function;
}

Field random_field(int number) {
  Field field;
  if (*rc::gen::arbitrary<bool>()) field.name = fmt::format("{}{}", random_text(), number);
  field.transfer_function = random_transfer_function();
  if (*rc::gen::inRange(0, 4) == 0) {
    field.grid.emplace();
    if (*rc::gen::arbitrary<bool>()) field.grid->path = "/data/runs/b c.nrrd";
    if (*rc::gen::arbitrary<bool>()) field.grid->array = random_text();
    field.grid->interpolation = *rc::gen::element(
        Reconstruction::trilinear, Reconstruction::tricubic, Reconstruction::tricubic_smoothing);
    field.fitted_isosurfaces = *rc::gen::arbitrary<bool>();
    return field;
  }
  if (*rc::gen::arbitrary<bool>()) field.select.species = {random_text(), random_text()};
  field.select.index = maybe([] {
    const auto first = *rc::gen::arbitrary<std::uint32_t>();
    return std::pair(std::uint64_t{first}, std::uint64_t{first} + 5);
  });
  if (*rc::gen::arbitrary<bool>()) field.select.expression = "z > 3 && species == \"Si\"";
  field.radius = maybe([] { return NumberOrProperty(random_double(1, 99)); });
  field.weight = maybe([] { return NumberOrProperty(random_text()); });
  field.normalise = maybe([] { return *rc::gen::arbitrary<bool>(); });
  field.support_factor = maybe([] { return random_double(1, 30); });
  field.kernel_scale = maybe([] { return random_double(-30, 30); });
  field.kernel_shape = maybe([] { return KernelShape{KernelType::quintic_spline, {}}; });
  if (field.kernel_shape) field.support_factor.reset();
  if (*rc::gen::arbitrary<bool>()) {
    field.isosurfaces = {{random_double(-3, 3), {}, 1},
                         {0.5, ColorBy::element, 0.25},
                         {0.75, ColorBy::species, 0},
                         {1, Color{0.25F, 0, 1}, 0.5}};
  }
  return field;
}

RC_GTEST_PROP(SceneToJson, ReadsBackEqual, ()) {
  Scene scene;
  scene.data_path = (std::filesystem::path("/data/runs") / "a b.xyz").lexically_normal();
  scene.frame = *rc::gen::arbitrary<std::uint64_t>();
  if (*rc::gen::arbitrary<bool>()) scene.types = {{1, random_text()}, {20, "O"}};
  scene.eye = maybe([] { return Point3d(random_vector()); });
  scene.target = maybe([] { return Point3d{0, -1, 0}; });
  scene.up = maybe(random_vector);
  if (*rc::gen::arbitrary<bool>()) {
    scene.fov_degrees = maybe([] { return random_double(1, 1259); });
  } else {
    scene.orthographic_height = maybe([] { return random_double(1, 999); });
  }
  for (int n = *rc::gen::inRange(0, 4); n > 0; --n) scene.fields.push_back(random_field(n));
  if (*rc::gen::arbitrary<bool>()) {
    Geometry balls, sticks;
    balls.select.species = {random_text()};
    balls.radius = *rc::gen::element<decltype(Geometry::radius)>(ElementRadius::covalent, 2.5,
                                                                 std::string("size"));
    balls.color = *rc::gen::element<decltype(Geometry::color)>(
        ColorBy::species, ColorBy::field, Color{0.25F, 0, 1},
        ColorByProperty{"v", "magma", {{1, 2}}});
    sticks.type = Geometry::Type::sticks;
    sticks.radius = 0.25;
    sticks.bonds = BondSource::distance;
    scene.geometry = {balls, sticks};
    scene.render.surface = {2, 64, 3.5, false, 0, 7};
  }
  for (int n = *rc::gen::inRange(0, 3); n > 0; --n) {
    scene.render.clip_planes.push_back({{0, -1, 0.25 * n}, random_double(-30, 30)});
  }
  scene.kernel = {random_double(1, 30), random_double(-30, 30)};
  if (*rc::gen::arbitrary<bool>()) {
    scene.kernel = {.kernel_scale = 3, .shape = {KernelType::wendland_c4, {}}};
    for (Field& field : scene.fields) field.support_factor.reset();
  }
  scene.render.width = *rc::gen::inRange(1, 16385);
  scene.render.step_size = maybe([] { return random_double(1, 30); });
  scene.render.termination_opacity = random_double(1, 8);
  std::vector<LightSource>& lights = scene.render.lighting.lights;
  lights.resize(*rc::gen::inRange(0u, 4u));
  for (LightSource& light : lights) {
    light.direction = maybe(random_vector);
    if (*rc::gen::arbitrary<bool>()) light.intensity = random_double(1, 30);
  }
  scene.render.lighting.enabled = *rc::gen::arbitrary<bool>();
  scene.render.background = color_from_srgb(*rc::gen::inRange(0u, 0x1000000u));
  if (*rc::gen::arbitrary<bool>()) scene.render.background.g = 1 / 3.0f;
  scene.render.engine = *rc::gen::element(Engine::sweep, Engine::coherent, Engine::direct);

  const std::string text = scene_to_json(scene, "/data/scenes");
  RC_ASSERT(parse_scene(text, "/data/scenes/s.json") == scene);
}

TEST(SceneToJson, RefusesNamesThatJsonCannotHold) {
  Scene scene;
  scene.data_path = "a";
  scene.fields.resize(1);
  scene.fields[0].name = "\xff";
  EXPECT_THROW(scene_to_json(scene, ""), Error);
}

TEST(EngineNames, AreReadBack) {
  for (const Engine engine : {Engine::sweep, Engine::coherent, Engine::direct}) {
    EXPECT_EQ(engine_from_name(name_of(engine)), engine);
  }
}

TEST(SceneJson, FieldsThatAreNotVisibleSaySo) {
  Scene scene = parse_scene(
      R"({"version": 1, "data": {"path": "a.xyz"}, "fields": [{"visible": false}, {"visible": true}]})",
      "scene.json");
  EXPECT_FALSE(scene.fields[0].visible);
  EXPECT_TRUE(scene.fields[1].visible);
  const std::string text = scene_to_json(scene, "");
  EXPECT_EQ(parse_scene(text, "scene.json"), scene);
  EXPECT_EQ(text.find("visible"), text.rfind("visible"));  // written only where it is false
}

}  // namespace
}  // namespace motes
