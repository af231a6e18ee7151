// Scene files: what the documentation's example means, and every refusal.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>

#include "core/error.h"
#include "scene/scene.h"

namespace motes {
namespace {

using testing::HasSubstr;

Scene parse(const std::string& text) { return parse_scene(text, "dir/s.json"); }

std::string message_of(const std::string& text) {
  try {
    parse(text);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

/// A scene with `body` beside what every scene must have.
std::string with_body(const std::string& body) {
  return R"({"version": 1, "data": {"path": "a.xyz"}, )" + body + "}";
}

TEST(ParseScene, KnowsColoursByName) {
  const auto background = [](const std::string& name) {
    return parse(with_body(R"("render": {"background": ")" + name + R"("})")).render.background;
  };
  EXPECT_EQ(background("white"), (Color{1, 1, 1}));
  EXPECT_EQ(background("black"), (Color{0, 0, 0}));
}

TEST(ParseScene, ReadsEverything) {
  const Scene scene = parse(R"({
    "version": 1,
    "data": {"path": "../silica.lammpstrj", "frame": 3, "types": {"1": "Si", "2": "O"}},
    "camera": {"eye": [0, 0, -80], "target": [0, 0, 0.5], "up": [0, 1, 0], "fov": 30},
    "kernel": {"type": "gaussian", "support_factor": 2.5, "kernel_scale": -1},
    "fields": [
      {"name": "silicon",
       "select": {"species": ["Si"], "index": [5, 10], "expression": "z > 3"},
       "radius": 1.11, "weight": "q", "normalise": true,
       "kernel": {"support_factor": 3},
       "transfer_function": {"scale": "log", "points": [
         {"value": 0.2, "color": "#000033", "extinction": 0.0},
         {"value": 1.2, "color": [1.0, 0.6, 0.1], "extinction": 2.0}]}},
      {"radius": "h", "transfer_function": {"name": "magma", "range": [1, 2], "extinction": 4}},
      {"transfer_function": "species"}],
    "render": {"size": [640, 480], "step_size": 0.5, "termination_opacity": 0.99,
      "lighting": {"enabled": false, "ambient": 0.1, "diffuse": 0.2, "specular": 0.4,
                   "shininess": 8, "direction": [1, 2, 3]},
      "background": "#ffffff", "engine": "direct"}})");

  EXPECT_EQ(scene.data_path, "silica.lammpstrj");
  EXPECT_EQ(scene.frame, 3u);
  EXPECT_EQ(scene.types, (std::map<int, std::string>{{1, "Si"}, {2, "O"}}));
  EXPECT_EQ(scene.eye, (Point3d{0, 0, -80}));
  EXPECT_EQ(scene.target, (Point3d{0, 0, 0.5}));
  EXPECT_EQ(scene.fov_degrees, 30);
  EXPECT_EQ(scene.kernel, (Kernel{2.5, -1}));
  ASSERT_EQ(scene.fields.size(), 3u);
  const Field& silicon = scene.fields[0];
  EXPECT_EQ(silicon.select, (Selection{{"Si"}, {{5, 10}}, "z > 3"}));
  EXPECT_EQ(silicon.radius, NumberOrProperty(1.11));
  EXPECT_EQ(silicon.weight, NumberOrProperty("q"));
  EXPECT_EQ(silicon.normalise, true);
  EXPECT_EQ(silicon.support_factor, 3);
  EXPECT_EQ(silicon.kernel_scale, std::nullopt);
  const auto& points = std::get<TransferFunction>(silicon.transfer_function);
  EXPECT_TRUE(points.log_scale);
  ASSERT_EQ(points.points.size(), 2u);
  EXPECT_NEAR(points.points[0].color.b, srgb_to_linear(0.2), 1e-7);
  EXPECT_EQ(points.points[1].color, (Color{1, 0.6f, 0.1f}));
  EXPECT_EQ(points.points[1].extinction, 2);
  EXPECT_EQ(std::get<NamedTransferFunction>(scene.fields[1].transfer_function),
            (NamedTransferFunction{"magma", {{1, 2}}, 4, {}}));
  EXPECT_EQ(std::get<NamedTransferFunction>(scene.fields[2].transfer_function).name, "species");
  EXPECT_EQ(scene.render.width, 640);
  EXPECT_EQ(scene.render.height, 480);
  EXPECT_EQ(scene.render.step_size, 0.5);
  EXPECT_EQ(scene.render.termination_opacity, 0.99);
  EXPECT_EQ(scene.render.lighting, (Lighting{false, 0.1, 0.2, 0.4, 8, {{Vector3d{1, 2, 3}}}}));
  EXPECT_EQ(scene.render.background, (Color{1, 1, 1}));
  EXPECT_EQ(scene.render.engine, Engine::direct);
}

TEST(ParseScene, NeedsVersionAndPathAlone) {
  const Scene scene = parse(R"({"version": 1, "data": {"path": "a.xyz"}})");
  Scene expected;
  expected.data_path = "dir/a.xyz";
  EXPECT_EQ(scene, expected);
  EXPECT_EQ(parse(R"({"version": 1, "data": {"path": "/b/a.xyz"}})").data_path, "/b/a.xyz");
  EXPECT_EQ(message_of("{}"), "dir/s.json: expected the key 'version'");
  EXPECT_EQ(message_of(R"({"version": 2})"),
            "dir/s.json: version: expected 1, the only version there is, found 2");
  EXPECT_EQ(message_of(R"({"version": 1})"), "dir/s.json: expected the key 'data'");
  EXPECT_EQ(message_of(R"({"version": 1, "data": {}})"),
            "dir/s.json: data: expected the key 'path'");
}

TEST(ParseScene, ReadsGrids) {
  const Scene scene = parse(R"({"version": 1, "fields": [
      {"grid": "../a.cube"},
      {"name": "b", "grid": {"path": "b.nrrd", "array": "heat", "interpolation": "tricubic"}}]})");
  Scene expected;
  expected.fields.resize(2);
  expected.fields[0].grid = {"a.cube", "", Reconstruction::trilinear};
  expected.fields[1].name = "b";
  expected.fields[1].grid = {"dir/b.nrrd", "heat", Reconstruction::tricubic};
  EXPECT_EQ(scene, expected);
  EXPECT_EQ(parse(with_body(R"("fields": [{"grid": {}}])")).fields[0].grid, FieldGrid{});
}

TEST(ParseScene, NeedsDataForAllButGridsOfTheirOwn) {
  for (const std::string rest :
       {R"("fields": [{"grid": {"array": "a"}}])", R"("fields": [{"grid": "a"}, {}])",
        R"("fields": [{"grid": "a"}], "geometry": [{"type": "spheres"}])", R"("fields": [])"}) {
    EXPECT_EQ(message_of(R"({"version": 1, )" + rest + "}"), "dir/s.json: expected the key 'data'");
  }
}

TEST(ParseScene, NamesTheNearestKey) {
  EXPECT_EQ(message_of(with_body(R"("camra": {})")),
            "dir/s.json: unknown key 'camra'; did you mean 'camera'?");
  EXPECT_EQ(message_of(with_body(R"("fields": [{}, {"raduis": 1}])")),
            "dir/s.json: fields[1]: unknown key 'raduis'; did you mean 'radius'?");
  EXPECT_THAT(message_of(with_body(R"("render": {"lighting": {"speculr": 1}})")),
              HasSubstr("render.lighting: unknown key 'speculr'; did you mean 'specular'?"));
  EXPECT_EQ(message_of(with_body(R"("fields": [{"select": {"colour": 1}}])")),
            "dir/s.json: fields[0].select: unknown key 'colour'; there are: species, index, "
            "expression; the nearest known key is 'index'");
}

TEST(ParseScene, SaysWhereKeysBelong) {
  EXPECT_EQ(message_of(with_body(R"("render": {"lighting": {"shadows": true}})")),
            "dir/s.json: render.lighting: the key 'shadows' belongs in render.surface");
  EXPECT_EQ(message_of(with_body(R"("fields": [{"kernel_scale": 2}])")),
            "dir/s.json: fields[0]: the key 'kernel_scale' belongs in kernel");
  // They do: of the wrong type there, they are known.
  for (const std::string body :
       {R"("camera": {"eye": {}})",
        R"("camera": {"target": {}})",
        R"("camera": {"fov": {}})",
        R"("camera": {"orthographic": {}})",
        R"("kernel": {"support_factor": {}})",
        R"("kernel": {"kernel_scale": {}})",
        R"("fields": [{"isosurfaces": {}}])",
        R"("fields": [{"transfer_function": 1}])",
        R"("fields": [{"weight": {}}])",
        R"("fields": [{"normalise": {}}])",
        R"("fields": [{"grid": {"interpolation": {}}}])",
        R"("fields": [{"grid": {"array": {}}}])",
        R"("fields": [{"transfer_function": {"name": "heat", "extinction": {}}}])",
        R"("geometry": [{"type": "sticks", "bonds": {}}])",
        R"("render": {"step_size": {}})",
        R"("render": {"termination_opacity": {}})",
        R"("render": {"lighting": 1})",
        R"("render": {"clip_planes": {}})",
        R"("render": {"background": {}})",
        R"("render": {"engine": {}})",
        R"("render": {"lighting": {"lights": {}}})",
        R"("render": {"lighting": {"lights": [{"direction": {}}]}})",
        R"("render": {"lighting": {"lights": [{"intensity": {}}]}})",
        R"("render": {"surface": {"antialiasing": {}}})",
        R"("render": {"surface": {"ambient_occlusion": {}}})",
        R"("render": {"surface": {"occlusion_distance": {}}})",
        R"("render": {"surface": {"shadows": {}}})",
        R"("render": {"surface": {"light_angle": {}}})"}) {
    EXPECT_THAT(message_of(with_body(body)), HasSubstr("expected")) << body;
  }
}

TEST(ParseScene, NamesTheLineOfBrokenJson) {
  EXPECT_THAT(message_of("{\"version\": 1,\n\n \"data\": }"),
              HasSubstr("dir/s.json:3: expected JSON: "));
  EXPECT_THAT(message_of(""), HasSubstr("dir/s.json:1: expected JSON"));
  EXPECT_THAT(message_of("{\"version\": 1e999}"), HasSubstr("overflow"));
  EXPECT_THAT(message_of("[1]"), HasSubstr("expected an object, found an array of 1"));
  EXPECT_THAT(message_of("{\"a\xff\": 1}"), HasSubstr("dir/s.json:1: "));
}

TEST(ParseScene, RefusesWhatJsonAllowsButNoSceneHas) {
  EXPECT_EQ(message_of(R"({"version": 1, "version": 1})"),
            "dir/s.json: the key 'version' is there twice in one object");
  EXPECT_NE(message_of(with_body(R"("fields": [{"name": "a", "radius": 1}, {"radius": 1}])")),
            "dir/s.json: the key 'radius' is there twice in one object");
  EXPECT_THAT(message_of(std::string(1000000, '[')), HasSubstr("nested more than"));
  std::string objects;
  for (int i = 0; i < 100000; ++i) objects += "{\"a\":";
  EXPECT_THAT(message_of(objects), HasSubstr("nested more than"));
}

struct Refusal {
  std::string body, message;
};

class Refuses : public testing::TestWithParam<Refusal> {};

TEST_P(Refuses, WithOneClearLine) {
  const std::string message = message_of(with_body(GetParam().body));
  EXPECT_THAT(message, HasSubstr("dir/s.json: " + GetParam().message));
  EXPECT_EQ(message.find('\n'), std::string::npos);
}

INSTANTIATE_TEST_SUITE_P(
    ParseScene, Refuses,
    testing::Values(
        Refusal{R"("fields": [{"grid": 1}])", "fields[0].grid: expected the path of a grid"},
        Refusal{R"("fields": [{"grid": {"file": "a"}}])", "fields[0].grid: unknown key 'file'"},
        Refusal{R"("fields": [{"grid": {"interpolation": "linear"}}])",
                "fields[0].grid.interpolation: unknown interpolation 'linear'; did you mean "
                "'trilinear'?"},
        Refusal{R"("fields": [{}, {"grid": "a", "select": {}}])",
                "fields[1].select: is for fields "
                "of particles; expected none"},
        Refusal{R"("fields": [{"grid": "a", "radius": 1}])", "fields[0].radius: is for fields of"},
        Refusal{R"("fields": [{"grid": "a", "weight": 1}])", "fields[0].weight: is for fields of"},
        Refusal{R"("fields": [{"grid": "a", "normalise": true}])", "fields[0].normalise: is for"},
        Refusal{R"("fields": [{"grid": "a", "kernel": {}}])", "fields[0].kernel: is for fields of"},
        Refusal{R"("fields": [{"grid": "a", "isosurfaces": [{"value": 1, "color": "element"}]}])",
                "fields[0].isosurfaces: has a colour by particles"},
        Refusal{R"("fields": [{"isosurfaces": {"value": 1}}])",
                "fields[0].isosurfaces: expected an array of isosurfaces"},
        Refusal{R"("fields": [{"isosurfaces": [{"value": 1e999}]}])", ""},
        Refusal{R"("fields": [{"isosurfaces": [{"color": "element"}]}])",
                "fields[0].isosurfaces[0]: expected the key 'value'"},
        Refusal{R"("fields": [{"isosurfaces": [{"value": "x"}]}])",
                "fields[0].isosurfaces[0].value: expected a number"},
        Refusal{R"("fields": [{"isosurfaces": [{"value": 1, "opacity": 1.5}]}])",
                "fields[0].isosurfaces[0].opacity: expected a number from 0 to 1"},
        Refusal{R"("fields": [{"isosurfaces": [{"value": 1, "color": "elements"}]}])",
                "fields[0].isosurfaces[0].color: expected \"element\", \"species\" or a colour"},
        Refusal{R"("style": "surface", "fields": [{}])",
                "style: expected no fields of particles with the style 'surface'"},
        Refusal{R"("fields": [{"isosurfaces": "fitted"}])",
                "fields[0].isosurfaces: only those of grids are fitted; expected an array"},
        Refusal{R"("fields": [{"grid": "a", "isosurfaces": "fit"}])",
                "fields[0].isosurfaces: expected \"fitted\" or an array of isosurfaces"},
        Refusal{R"("camera": {"eye": [0, 1]})",
                "camera.eye: expected an array of three numbers, found an array of 2"},
        Refusal{R"("camera": {"eye": [0, 1, "2"]})",
                "camera.eye[2]: expected a number, found \"2\""},
        Refusal{R"("camera": {"up": [0, 0, 0]})", "camera.up: a direction must not be zero"},
        Refusal{R"("camera": {"fov": 180})", "camera.fov: expected an angle"},
        Refusal{R"("camera": {"fov": 30, "orthographic": 10})", "camera: expected either"},
        Refusal{R"("camera": {"orthographic": 0})", "camera.orthographic: expected a number gr"},
        Refusal{R"("camera": {"eye": [1, 2, 3], "target": [1, 2, 3]})", "camera: expected two"},
        Refusal{R"("kernel": {"type": "m4"})",
                "kernel.type: unknown kernel 'm4'; there are: gaussian, cubic_spline"},
        Refusal{R"("kernel": {"type": "cubic_spline", "support_factor": 3})",
                "kernel.support_factor: only a gaussian has one"},
        Refusal{
            R"("kernel": {"type": "wendland_c2"}, "fields": [{"kernel": {"support_factor": 3}}])",
            "fields[0].kernel.support_factor: only a gaussian has one"},
        Refusal{R"("kernel": {"type": "tabulated"})", "kernel: expected the key 'path'"},
        Refusal{R"("kernel": {"path": "a.txt"})", "kernel.path: expected none"},
        Refusal{R"("kernel": {"type": "tabulated", "path": "/none.txt"})",
                "kernel.path: /none.txt: there is no such file"},
        Refusal{R"("kernel": {"support_factor": 0})", "kernel.support_factor: expected a number"},
        Refusal{R"("kernel": 3)", "kernel: expected an object, found 3"},
        Refusal{R"("fields": {})", "fields: expected an array of fields, found an object"},
        Refusal{R"("fields": [{"name": ""}])", "fields[0].name: expected a name, found \"\""},
        Refusal{R"("fields": [{"name": "a"}, {"name": "a"}])", "fields[1].name: expected a name"},
        Refusal{R"("fields": [{"radius": -1}])",
                "fields[0].radius: expected a number greater than 0 or the name of a property, "
                "found -1"},
        Refusal{R"("fields": [{"radius": 1e-60}])", "fields[0].radius: expected"},
        Refusal{R"("fields": [{"radius": true}])", "fields[0].radius: expected"},
        Refusal{R"("fields": [{"weight": 1e60}])", "fields[0].weight: expected"},
        Refusal{R"("fields": [{"normalise": 1}])", "fields[0].normalise: expected true or false"},
        Refusal{R"("fields": [{"select": {"species": []}}])", "fields[0].select.species: expected"},
        Refusal{R"("fields": [{"select": {"species": [3]}}])", "fields[0].select.species[0]: exp"},
        Refusal{R"("fields": [{"select": {"index": [5, 3]}}])", "fields[0].select.index: expected"},
        Refusal{R"("fields": [{"select": {"index": [-5, 3]}}])", "fields[0].select.index[0]: exp"},
        Refusal{R"("fields": [{"select": {"expression": "z >"}}])",
                "fields[0].select.expression: expression \"z >\", column 4: expected a number"},
        Refusal{R"("fields": [{"transfer_function": "virids"}])",
                "fields[0].transfer_function: unknown colour map 'virids'; did you mean 'viridis'"},
        Refusal{R"("fields": [{"transfer_function": {}}])",
                "fields[0].transfer_function: expected"},
        Refusal{R"("fields": [{"transfer_function": {"point": []}}])",
                "fields[0].transfer_function: unknown key 'point'; did you mean 'points'"},
        Refusal{R"("fields": [{"transfer_function": {"points": []}}])",
                "fields[0].transfer_function.points: expected"},
        Refusal{R"("fields": [{"transfer_function": {"points": [{"value": 1, "color": "#12345",
                "extinction": 1}]}}])",
                "fields[0].transfer_function.points[0].color: expected a colour"},
        Refusal{R"("fields": [{"transfer_function": {"points": [{"value": 1, "color": [0, 0, -1],
                "extinction": 1}]}}])",
                "fields[0].transfer_function.points[0].color[2]: expected a number of 0 or more"},
        Refusal{R"("fields": [{"transfer_function": {"points": [
                {"value": 1, "color": "#123456", "extinction": 1},
                {"value": 1, "color": "#123456", "extinction": 1}]}}])",
                "fields[0].transfer_function.points[1].value: expected a number greater than the "
                "point's before, 1"},
        Refusal{R"("fields": [{"transfer_function": {"scale": "log", "points": [
                {"value": 0, "color": "#123456", "extinction": 1}]}}])",
                "fields[0].transfer_function.points[0].value: expected a number greater than 0"},
        Refusal{R"("fields": [{"transfer_function": {"points": [
                {"value": 1, "color": "#123456", "extinction": -1}]}}])",
                "fields[0].transfer_function.points[0].extinction: expected a number of 0"},
        Refusal{R"("fields": [{"transfer_function": {"name": "heat", "range": [2, 1]}}])",
                "fields[0].transfer_function.range: expected low < high"},
        Refusal{R"("render": {"size": [0, 5]})",
                "render.size[0]: expected a whole number from 1 to 16384, found 0"},
        Refusal{R"("render": {"size": [5, 16385]})", "render.size[1]: expected"},
        Refusal{R"("render": {"size": [5.5, 5]})", "render.size[0]: expected"},
        Refusal{R"("render": {"step_size": 0})", "render.step_size: expected"},
        Refusal{R"("render": {"termination_opacity": 1.5})", "render.termination_opacity: exp"},
        Refusal{R"("render": {"lighting": {"shininess": -1}})", "render.lighting.shininess: exp"},
        Refusal{R"("render": {"lighting": {"direction": [0, 0, 0]}})",
                "render.lighting.direction: a direction must not be zero"},
        Refusal{R"("render": {"lighting": {"lights": {}}})",
                "render.lighting.lights: expected an array of lights"},
        Refusal{R"("render": {"lighting": {"lights": ["headlight"]}})",
                "render.lighting.lights[0]: expected an object such as {\"direction\""},
        Refusal{R"("render": {"lighting": {"lights": [{}, {"direction": [0, 0, 0]}]}})",
                "render.lighting.lights[1].direction: a direction must not be zero"},
        Refusal{R"("render": {"lighting": {"lights": [{"intensity": -1}]}})",
                "render.lighting.lights[0].intensity: expected a number of 0 or more"},
        Refusal{R"("render": {"lighting": {"lights": [{"intensity": 1e39}]}})",
                "render.lighting.lights[0].intensity: expected a number from 0 to a million"},
        Refusal{R"("render": {"lighting": {"lights": [{"color": "#ffffff"}]}})",
                "render.lighting.lights[0]"},
        Refusal{R"("render": {"lighting": {"lights": [{},{},{},{},{},{},{},{},{}]}})",
                "render.lighting.lights: expected an array of at most 8 lights"},
        Refusal{R"("render": {"lighting": {"direction": [1, 0, 0], "lights": [{}]}})",
                "render.lighting: expected either direction or lights, found both"},
        Refusal{R"("render": {"lighting": false})",
                "render.lighting: expected an object such as {\"enabled\": false}, found false"},
        Refusal{R"("render": {"clip_planes": {}})", "render.clip_planes: expected an array of pl"},
        Refusal{R"("render": {"clip_planes": [{"distance": 1}]})",
                "render.clip_planes[0]: expected the key 'normal'"},
        Refusal{R"("render": {"clip_planes": [{"normal": [0, 0, 0]}]})",
                "render.clip_planes[0].normal: a direction must not be zero"},
        Refusal{R"("style": "sphere")", "style: unknown style 'sphere'; did you mean 'spheres'?"},
        Refusal{R"("style": "spheres", "fields": [{}])", "style: expected no fields with the st"},
        Refusal{R"("style": "volume", "geometry": [{"type": "spheres"}])",
                "style: expected either a style or geometry, found both"},
        Refusal{R"("render": {"background": "blakc"})", "render.background: expected a colour"},
        Refusal{R"("render": {"background": [0.5, 128, 0]})",
                "render.background: expected \"black\", \"white\", \"#rrggbb\" (sRGB) or [r, g, b] "
                "(linear, each in [0, 1])"},
        Refusal{R"("render": {"engine": "grid"})",
                "render.engine: unknown engine 'grid'; there are: sweep, coherent, direct, cells"},
        Refusal{R"("render": {"engine": "swep"})",
                "render.engine: unknown engine 'swep'; did you mean 'sweep'?"}));

TEST(ParseScene, DataIsChecked) {
  const auto message = [](const std::string& data) {
    return message_of(R"({"version": 1, "data": )" + data + "}");
  };
  EXPECT_THAT(message(R"({"path": ""})"), HasSubstr("data.path: expected the path of a file"));
  EXPECT_THAT(message(R"({"path": "a", "frame": -1})"), HasSubstr("data.frame: expected a whole"));
  EXPECT_THAT(message(R"({"path": "a", "types": {"Si": "1"}})"), HasSubstr("data.types: expected"));
  EXPECT_THAT(message(R"({"path": "a", "types": {"1": ""}})"), HasSubstr("data.types.1: expected"));
}

RC_GTEST_PROP(ParseScene, AnyTextIsAnswered, (const std::string& text)) {
  try {
    parse(text);
    RC_FAIL("random text is no scene");
  } catch (const Error& error) {
    RC_ASSERT(std::string(error.what()).find('\n') == std::string::npos);
  }
}

}  // namespace
}  // namespace motes
