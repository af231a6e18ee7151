// Scene files on the command line: read, overridden, saved, and what is told of mistakes in them.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <vector>

#include "apps/command_line.h"

namespace motes {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

using Scenes = CommandLine;

TEST_F(Scenes, ASceneIsToldByItsContentAndOptionsOverrideIt) {
  workspace_.write("scene.txt",
                   R"({"version": 1, "data": {"path": "a.xyz"}, "camera": {"orthographic": 9},
                       "fields": [{"name": "si", "select": {"species": "Si"}, "radius": 1,
                                   "kernel": {"support_factor": 1}}],
                       "render": {"size": [32, 16], "engine": "direct"}})");
  succeed("render scene.txt -o a.npy --stats s.json");
  EXPECT_EQ(pixels("a.npy").size(), 32u * 16 * 4);
  auto stats = nlohmann::json::parse(workspace_.read("s.json"));
  EXPECT_EQ(stats["particles"], 2);
  EXPECT_EQ(stats["engine"], "direct");

  succeed(
      "render scene.txt -o a.npy --stats s.json --size 8x8 --fov 30 --engine coherent "
      "--background white --no-lighting");
  EXPECT_EQ(pixels("a.npy").size(), 8u * 8 * 4);
  EXPECT_EQ(nlohmann::json::parse(workspace_.read("s.json"))["engine"], "coherent");

  // At a distance of 1.5 the kernel of the scene has ended, that of the option has not.
  workspace_.write("p.csv", "-1.5,0,0\n");
  EXPECT_THAT(run("probe scene.txt --points p.csv").out, HasSubstr("\n-1.5,0,0,0,"));
  EXPECT_THAT(run("probe scene.txt --points p.csv --support-factor 2").out,
              HasSubstr(fmt::format("\n-1.5,0,0,{:.9g},", std::exp(-1.125))));
}

TEST_F(Scenes, ASceneWithMistakesNamesTheKey) {
  workspace_.write("s.json", R"({"version": 1, "data": {"path": "a.xyz"}, "rendr": {}})");
  EXPECT_THAT(failure("render s.json -o a.png", 1),
              HasSubstr("s.json: unknown key 'rendr'; did you mean 'render'?"));
  workspace_.write("s.json", R"({"version": 1, "data": {"path": "x.xyz"}})");
  for (const std::string command : {"info s.json", "render s.json -o a.png"}) {
    EXPECT_EQ(failure(command, 1),
              "motes: error: s.json: data.path: x.xyz: there is no such file\n");
  }
  workspace_.write("s.json", "{\"version\": 1,\n\"data\": }");
  EXPECT_THAT(failure("render s.json -o a.png", 1), HasSubstr("s.json:2: "));
}

TEST_F(Scenes, MistakesThatTheDataShowNameTheirPlace) {
  const auto scene = [this](const std::string& body) {
    workspace_.write("s.json", R"({"version": 1, "data": {"path": "a.xyz"}, )" + body + "}");
    return failure("render s.json -o a.png --size 8x8", 1);
  };
  const std::string start = "motes: error: s.json: ";
  EXPECT_THAT(scene(R"("fields": [{}, {"select": {"species": "Sj"}}])"),
              StartsWith(start + "fields[1].select.species: unknown species 'Sj'"));
  EXPECT_THAT(scene(R"("fields": [{"select": {"expression": "q > 1"}}])"),
              StartsWith(start + "fields[0].select.expression: "));
  EXPECT_THAT(scene(R"("fields": [{"select": {"expression": "specis == 'Si'"}}])"),
              HasSubstr("column 1: unknown property 'specis'; did you mean 'species'?"));
  EXPECT_EQ(scene(R"("fields": [{"select": {"expression": "species == 'Sj'"}}])"),
            start +
                "field 'field0' selects none of the 3 particles; unknown species 'Sj'; did you "
                "mean 'Si'?\n");
  EXPECT_THAT(scene(R"("fields": [{"weight": "q"}])"),
              StartsWith(start + "fields[0].weight: unknown property 'q'"));
  EXPECT_THAT(scene(R"("camera": {"eye": [0, 9, 0], "target": [0, 0, 0], "up": [0, 1, 0]})"),
              StartsWith(start + "camera.up: is parallel"));
  EXPECT_THAT(scene(R"("render": {"step_size": 1e-12})"),
              StartsWith(start + "render.step_size: 1e-12 takes "));
  EXPECT_THAT(scene(R"("camera": {"eye": [0, 0, 1e30], "target": [0, 0, 0]})"),
              StartsWith(start + "camera.eye: is 1e+30 away"));
  EXPECT_EQ(scene(R"("fields": [{"select": {"expression": "x > 99"}}])"),
            start + "field 'field0' selects none of the 3 particles\n");
  workspace_.write("p.csv", "0,0,0\n");
  EXPECT_EQ(failure("probe s.json --points p.csv", 1),
            start + "field 'field0' selects none of the 3 particles\n");
  workspace_.write("nan.xyz", "1\n\nSi nan 0 0\n");
  EXPECT_THAT(run("render nan.xyz -o a.png").err,
              HasSubstr("motes: error: nan.xyz: field 'all': none of its particles has a finite"));
}

TEST_F(Scenes, ASavedSceneGivesTheSamePicture) {
  // A field a species; a colour map over all; values of both signs in a selection; parallel rays.
  workspace_.write("signs.json", R"({"version": 1, "data": {"path": "a.xyz"}, "fields": [
      {"select": {"expression": "x < 3"}, "weight": "q", "radius": "r"},
      {"name": "red", "transfer_function": {"points": [
          {"value": 0.5, "color": [1, 0.1, 0], "extinction": 0.7}]}}]})");
  workspace_.write("a.xyz",
                   "3\nProperties=species:S:1:pos:R:3:q:R:1:r:R:1\n"
                   "Si 0 0 0 1 1\nO 2 0 0 -1 1.5\nSi 4 0 0 2 1\n");
  std::filesystem::create_directory(workspace_.path("out"));
  for (const std::string arguments :
       {"a.xyz", "a.xyz --transfer-function magma --no-lighting --background 0.1,0.2,0.3",
        "signs.json --step-size 0.3", "one.xyz --orthographic 7 --up 1,1,0 --engine direct",
        "a.xyz --weight q --support-factor 3 --kernel-scale 2 --termination-opacity 0.5"}) {
    succeed("render " + arguments + " -o first.npy --size 48x32 --save-scene out/s.json");
    succeed("render out/s.json -o second.npy --save-scene out/again.json");
    EXPECT_EQ(workspace_.read("first.npy"), workspace_.read("second.npy")) << arguments;
    EXPECT_EQ(workspace_.read("out/s.json"), workspace_.read("out/again.json")) << arguments;
  }
  const auto scene = nlohmann::json::parse(workspace_.read("out/s.json"));
  EXPECT_EQ(scene["data"]["path"], "../a.xyz");
  EXPECT_EQ(scene["render"]["size"], nlohmann::json::parse("[48, 32]"));
}

TEST_F(Scenes, ASavedSceneHarmsNoOtherFile) {
  workspace_.write("s.json", R"({"version": 1, "data": {"path": "a.xyz"}})");
  const std::string start = "motes: error: ", end = "; expected two different files\n";
  EXPECT_EQ(failure("render a.xyz -o a.png --save-scene ./a.xyz", 1),
            start + "a.xyz: is both FILE and --save-scene" + end);
  EXPECT_EQ(failure("render s.json -o a.png --save-scene s.json", 1),
            start + "s.json: is both FILE and --save-scene" + end);
  EXPECT_EQ(failure("render s.json -o a.png --save-scene a.xyz", 1),
            start + "a.xyz: is both data.path and --save-scene" + end);
  EXPECT_EQ(failure("render a.xyz -o a.png --save-scene a.png", 1),
            start + "a.png: is both --output and --save-scene" + end);
  EXPECT_EQ(failure("render a.xyz -o a.png --stats b --save-scene b", 1),
            start + "b: is both --stats and --save-scene" + end);
  EXPECT_EQ(workspace_.read("a.xyz"), three_atoms);
  workspace_.write("b.json", "old");
  failure("render a.xyz -o a.png --save-scene b.json --radius q", 1);
  EXPECT_EQ(workspace_.read("b.json"), "old");
  EXPECT_THAT(failure("render missing.xyz -o a.png --save-scene no/s.json", 1), HasSubstr("no/"));
}

TEST_F(Scenes, RendersASceneFromStandardInput) {
  workspace_.write("scene.json",
                   R"({"version": 1, "data": {"path": "a.xyz"}, "render": {"size": [33, 33]}})");
  succeed("render scene.json -o file.npy");
  succeed("render - -o piped.npy < scene.json");
  EXPECT_EQ(pixels("piped.npy"), pixels("file.npy"));
  workspace_.write("bad.json", R"({"version": 1, "data": {"path": "none.xyz"}})");
  EXPECT_THAT(failure("render - -o piped.npy < bad.json", 1),
              HasSubstr("-: data.path: none.xyz: there is no such file"));
}

}  // namespace
}  // namespace motes
