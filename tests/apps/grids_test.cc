// Grids on the command line: pictures, numbers and what is told of mistakes.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <sstream>

#include "apps/command_line.h"

namespace motes {
namespace {

using testing::HasSubstr;

/// A cube file of hydrogen fluoride in bohr, n^3 samples one apart: x + 2 y + 3 z in steps.
std::string cube(int n) {
  std::string text = fmt::format(
      "title\ncomment\n 2 0 0 0\n {0} 1 0 0\n {0} 0 1 0\n {0} 0 0 1\n"
      "1 0 2 2 2\n9 0 2 2 3.7\n",
      n);
  for (int x = 0; x < n; ++x) {
    for (int y = 0; y < n; ++y) {
      for (int z = 0; z < n; ++z) text += fmt::format("{}\n", x + 2 * y + 3 * z);
    }
  }
  return text;
}

/// An ASCII NRRD of 3^3 samples one apart, with these values.
std::string nrrd(const std::string& values) {
  return "NRRD0004\ntype: float\ndimension: 3\nsizes: 3 3 3\nspacings: 1 1 1\n"
         "axis mins: 0 0 0\ncenters: node node node\ncontent: heat\nencoding: ascii\n\n" +
         values + "\n";
}

std::string repeated(const std::string& value, int count) {
  std::string text;
  for (int i = 0; i < count; ++i) text += value + " ";
  return text;
}

class Grids : public CommandLine {
 protected:
  Grids() {
    workspace_.write("hf.cube", cube(6));
    workspace_.write("heat.nrrd", nrrd(repeated("0 1 4", 9)));
    workspace_.write("p.csv", "x,y,z\n0.5,1,1.5\n99,0,0\n");
  }

  /// Of a scene with these fields, and with `more` before them.
  std::string scene_failure(const std::string& fields, const std::string& more = "") {
    workspace_.write("s.json", R"({"version": 1, )" + more + R"("fields": [)" + fields + "]}");
    return failure("render s.json -o a.png --size 16x16", 1);
  }
  float largest_opacity(const std::string& picture) {
    const std::vector<float> rgba = pixels(picture);
    float largest = 0;
    for (std::size_t i = 3; i < rgba.size(); i += 4) largest = std::max(largest, rgba[i]);
    return largest;
  }
};

TEST_F(Grids, HaveAPictureWithoutOptions) {
  for (const std::string file : {"hf.cube", "heat.nrrd"}) {
    for (const std::string name : {"trilinear", "tricubic", "tricubic_smoothing"}) {
      succeed(fmt::format("render {} -o a.npy --size 24x24 --interpolation {}", file, name));
      EXPECT_GT(largest_opacity("a.npy"), 0.5) << file;
    }
  }
}

TEST_F(Grids, AtomsOfTheFileAreInThePicture) {
  succeed("render hf.cube -o a.npy --size 24x24 --save-scene both.json");
  succeed("render hf.cube -o b.npy --size 24x24 --style volume --save-scene grid.json");
  EXPECT_NE(pixels("a.npy"), pixels("b.npy"));
  auto scene = nlohmann::json::parse(workspace_.read("both.json"));
  EXPECT_EQ(scene["fields"][0]["name"], "value");
  EXPECT_EQ(scene["fields"][0]["grid"]["array"], "value");
  EXPECT_EQ(scene["geometry"].size(), 2u);
  EXPECT_FALSE(nlohmann::json::parse(workspace_.read("grid.json")).contains("geometry"));
  succeed("render both.json -o c.npy");
  EXPECT_EQ(pixels("c.npy"), pixels("a.npy"));
  succeed("render hf.cube -o d.npy --size 24x24 --style ball-and-stick");
  EXPECT_EQ(largest_opacity("d.npy"), 1);
}

TEST_F(Grids, AreWhatAStyleShowsOfTheirFile) {
  workspace_.write("s.json", R"({"version": 1, "data": {"path": "hf.cube"}, "style": "volume"})");
  succeed("render s.json -o a.npy --size 24x24");
  succeed("render hf.cube -o b.npy --size 24x24 --style volume");
  EXPECT_EQ(pixels("a.npy"), pixels("b.npy"));
}

TEST_F(Grids, HaveSurfacesAtFittedLevels) {
  // Of layers of 0, 1 and 4 the last has 80 % of the sum: for 85 % it takes the one of 1 too.
  succeed("render heat.nrrd -o a.npy --size 24x24 --style surface --save-scene a.json");
  EXPECT_EQ(largest_opacity("a.npy"), 1);
  auto scene = nlohmann::json::parse(workspace_.read("a.json"));
  EXPECT_EQ(scene["fields"][0]["isosurfaces"].size(), 1u);
  EXPECT_NEAR(scene["fields"][0]["isosurfaces"][0]["value"], 0.5, 0.01);
  EXPECT_FALSE(scene["fields"][0].contains("transfer_function"));
  EXPECT_FALSE(scene.contains("geometry"));
  succeed("render a.json -o b.npy");
  EXPECT_EQ(pixels("b.npy"), pixels("a.npy"));

  workspace_.write("wave.nrrd", nrrd(repeated("-1 0 1", 9)));
  succeed("render wave.nrrd -o c.npy --size 24x24 --style surface --save-scene c.json");
  scene = nlohmann::json::parse(workspace_.read("c.json"));
  ASSERT_EQ(scene["fields"][0]["isosurfaces"].size(), 2u);
  EXPECT_EQ(scene["fields"][0]["isosurfaces"][0]["value"], 0.5);
  EXPECT_EQ(scene["fields"][0]["isosurfaces"][1]["value"], -0.5);

  // In a scene file too, and with the atoms where there are some.
  workspace_.write("s.json", R"({"version": 1, "data": {"path": "hf.cube"}, "style": "surface"})");
  succeed("render s.json -o d.npy --size 24x24");
  succeed("render hf.cube -o e.npy --size 24x24 --style surface --save-scene e.json");
  EXPECT_EQ(pixels("d.npy"), pixels("e.npy"));
  scene = nlohmann::json::parse(workspace_.read("e.json"));
  EXPECT_TRUE(scene["fields"][0].contains("grid"));
  EXPECT_EQ(scene["geometry"].size(), 2u);
}

TEST_F(Grids, HaveSurfacesWhereChemistsDrawThem) {
  const auto level = [this](const std::string& file, std::size_t field) {
    const std::string path = MOTES_SOURCE_DIR "/data/density/" + file;
    const std::string outcome =
        run("render " + path + " -o a.png --size 8x8 --style surface --save-scene a.json").err;
    EXPECT_EQ(outcome.find("the grid 'orbital_38' is not shown") != std::string::npos,
              file == "caffeine_orbitals.cube.xz")
        << outcome;
    const auto scene = nlohmann::json::parse(workspace_.read("a.json"));
    return scene["fields"][field]["isosurfaces"][0]["value"].get<double>();
  };
  EXPECT_NEAR(level("caffeine_orbitals.cube.xz", 0), 0.0295, 0.0002);
  EXPECT_NEAR(level("quartz_density.cube.xz", 0), 0.0432, 0.0002);
}

TEST_F(Grids, LookTheSameInEveryEngineWhereverTheCameraIs) {
  for (const std::string view : {"--eye 1.3,1.3,9 --target 1.3,1.3,1.3",     // outside
                                 "--eye 1.3,1.2,1.1 --target 0,0.2,0.1",     // inside
                                 "--eye 0,1.3,1.3 --target 1.3,1.3,1.3"}) {  // on a face
    for (const std::string style : {"volume", "surface", "volume+balls", "ball-and-stick"}) {
      for (const std::string engine : {"sweep", "coherent", "direct", "cells"}) {
        succeed(
            fmt::format("render hf.cube -o {}.npy --size 16x16 --fov 80 {} --style {} --engine {}",
                        engine, view, style, engine));
        EXPECT_EQ(pixels(engine + ".npy"), pixels("sweep.npy")) << view << style << engine;
      }
      if (style == "ball-and-stick") continue;  // from inside there may be nothing
      EXPECT_GT(largest_opacity("sweep.npy"), 0.2) << view << style;
    }
  }
}

TEST_F(Grids, OutOfViewAreToldWithTheirAtoms) {
  for (const std::string style : {"volume", "surface", "volume+balls", "ball-and-stick"}) {
    EXPECT_THAT(
        run("render hf.cube -o a.png --size 16x16 --eye 0,0,20 --target 0,0,40 --style " + style)
            .err,
        HasSubstr("motes: warning: nothing is in view"))
        << style;
  }
}

TEST_F(Grids, HaveTheirMemoryInTheStatistics) {
  const auto grid_bytes = [this](const std::string& arguments) {
    succeed("render " + arguments + " -o a.png --size 8x8 --stats s.json");
    const auto stats = nlohmann::json::parse(workspace_.read("s.json"));
    return stats.contains("grid_bytes") ? stats["grid_bytes"].get<std::size_t>() : 0;
  };
  const std::size_t once = grid_bytes("heat.nrrd");
  EXPECT_GE(once, 5 * 5 * 5 * sizeof(float) + 2 * sizeof(float)) << "with a border, and one cell";
  EXPECT_LT(once, 10000u);
  workspace_.write("twice.json", R"({"version": 1, "fields": [
      {"name": "a", "grid": "heat.nrrd"}, {"name": "b", "grid": "heat.nrrd"}]})");
  EXPECT_EQ(grid_bytes("twice.json"), once);
  workspace_.write("ways.json", R"({"version": 1, "fields": [
      {"name": "a", "grid": "heat.nrrd"},
      {"name": "b", "grid": {"path": "heat.nrrd", "interpolation": "tricubic"}}]})");
  EXPECT_EQ(grid_bytes("ways.json"), 2 * once);
  EXPECT_EQ(grid_bytes("a.xyz"), 0u);
}

TEST_F(Grids, OfOneFileHaveColoursOfTheirOwn) {
  workspace_.write("s.json", R"({"version": 1, "fields": [
      {"grid": "heat.nrrd"}, {"name": "again", "grid": "heat.nrrd"}]})");
  succeed("render s.json -o a.png --size 24x24 --save-scene out.json");
  const auto scene = nlohmann::json::parse(workspace_.read("out.json"));
  const auto color = [&](std::size_t f) {
    return scene["fields"][f]["transfer_function"]["points"][0]["color"];
  };
  EXPECT_NE(color(0), color(1));
}

TEST_F(Grids, ShareAPictureWithParticles) {
  workspace_.write("s.json", R"({"version": 1, "data": {"path": "a.xyz"}, "fields": [
      {"name": "atoms", "radius": 1}, {"grid": "heat.nrrd", "transfer_function": "magma"}]})");
  for (const std::string engine : {"sweep", "coherent", "direct", "cells"}) {
    succeed(fmt::format("render s.json -o {0}.npy --size 24x24 --engine {0}", engine));
    ASSERT_EQ(pixels(engine + ".npy").size(), pixels("sweep.npy").size());
    for (std::size_t i = 0; i < pixels("sweep.npy").size(); ++i) {
      ASSERT_NEAR(pixels(engine + ".npy")[i], pixels("sweep.npy")[i], 1e-3) << engine;
    }
  }
}

TEST_F(Grids, AreProbed) {
  // Steps of 1 bohr = 0.529177 angstrom; 0.5, 1, 1.5 angstrom.
  const Outcome outcome = run("probe hf.cube --points p.csv --interpolation tricubic");
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  std::istringstream lines(outcome.out);
  std::string line;
  std::getline(lines, line);
  EXPECT_EQ(line, "x,y,z,value,value_dx,value_dy,value_dz");
  std::getline(lines, line);
  constexpr double bohr = 0.529177210903;
  double x = 0, y = 0, z = 0, value = 0, dx = 0, dy = 0, dz = 0;
  ASSERT_EQ(
      std::sscanf(line.c_str(), "%lf,%lf,%lf,%lf,%lf,%lf,%lf", &x, &y, &z, &value, &dx, &dy, &dz),
      7);
  EXPECT_NEAR(value, (0.5 + 2 + 4.5) / bohr, 1e-5);
  EXPECT_NEAR(dx, 1 / bohr, 1e-5);
  EXPECT_NEAR(dy, 2 / bohr, 1e-5);
  EXPECT_NEAR(dz, 3 / bohr, 1e-5);
  std::getline(lines, line);
  EXPECT_EQ(line, "99,0,0,nan,nan,nan,nan");
}

TEST_F(Grids, AreDescribed) {
  std::string out = run("info hf.cube").out;
  EXPECT_THAT(out, testing::ContainsRegex("format +cube\n"));
  EXPECT_THAT(out, testing::ContainsRegex("grid +value +0 to 30\n"));
  EXPECT_THAT(out, HasSubstr("6 x 6 x 6 samples, 0.529177 x 0.529177 x 0.529177 apart\n"));
  EXPECT_THAT(out, testing::ContainsRegex("particles +2\n"));
  out = run("info heat.nrrd").out;
  EXPECT_THAT(out, testing::ContainsRegex("format +NRRD\n"));
  EXPECT_THAT(out, testing::ContainsRegex("grid +heat +0 to 4\n"));
  const auto info = nlohmann::json::parse(run("info heat.nrrd --json").out);
  EXPECT_EQ(info["particles"], 0);
  EXPECT_EQ(info["grids"][0]["name"], "heat");
  EXPECT_EQ(info["grids"][0]["size"], nlohmann::json::parse("[3, 3, 3]"));
  EXPECT_EQ(info["grids"][0]["spacing"], nlohmann::json::parse("[1, 1, 1]"));
  EXPECT_EQ(info["grids"][0]["range"], nlohmann::json::parse(R"({"min": 0, "max": 4})"));
}

TEST_F(Grids, OfOneValueAreDrawn) {
  workspace_.write("flat.nrrd", nrrd(repeated("2", 27)));
  succeed("render flat.nrrd -o a.npy --size 24x24");
  EXPECT_GT(largest_opacity("a.npy"), 0.2);
  workspace_.write("zero.nrrd", nrrd(repeated("0", 27)));
  EXPECT_THAT(run("render zero.nrrd -o a.npy --size 24x24").err,
              HasSubstr("motes: warning: the fields in view are too transparent"));
}

TEST_F(Grids, LevelsThatAreNotReachedAreTold) {
  workspace_.write("s.json", R"({"version": 1, "fields": [{"name": "heat", "grid": "heat.nrrd",
      "isosurfaces": [{"value": 1}, {"value": 9}]}]})");
  EXPECT_EQ(
      run("render s.json -o a.npy --size 24x24").err,
      "motes: warning: the field 'heat' does not reach its isosurface at 9; its values go from "
      "0 to 4\n");
}

TEST_F(Grids, MistakesOfTheSceneAreTold) {
  EXPECT_THAT(scene_failure(R"({"grid": "none.nrrd"})"),
              HasSubstr("s.json: fields[0].grid: none.nrrd: there is no such file"));
  EXPECT_THAT(scene_failure(R"({"grid": {"path": "heat.nrrd", "array": "heap"}})"),
              HasSubstr("s.json: fields[0].grid.array: unknown grid 'heap'; did you mean 'heat'?"));
  EXPECT_THAT(scene_failure(R"({"grid": "heat.nrrd", "transfer_function": "species"})"),
              HasSubstr("fields[0].transfer_function: the field is a grid"));
  EXPECT_THAT(scene_failure(R"({"grid": "a.xyz"})"), HasSubstr("a.xyz"));
  // Particles without a file, and a file without particles.
  EXPECT_THAT(scene_failure(R"({"grid": "heat.nrrd"}, {})"), HasSubstr("expected the key 'data'"));
  EXPECT_THAT(scene_failure(R"({"grid": "heat.nrrd"}, {"name": "atoms"})",
                            R"("data": {"path": "heat.nrrd"}, )"),
              HasSubstr("is a grid without particles"));
}

TEST_F(Grids, SamplesThatAreNotFiniteAreCounted) {
  const auto warnings_of = [&](const std::string& values) {
    workspace_.write("holes.nrrd", nrrd(values));
    return run("render holes.nrrd -o a.png --size 16x16").err;
  };
  EXPECT_THAT(warnings_of(repeated("0 nan 4", 9)),
              HasSubstr("9 of 27 samples of the grid 'heat' are not finite: they count as 0"));
  EXPECT_THAT(warnings_of(repeated("nan inf nan", 9)),
              HasSubstr("the grid 'heat' has no finite value"));
  EXPECT_EQ(warnings_of(repeated("0 1 4", 9)), "");
}

TEST_F(Grids, MistakesOfTheCommandLineAreTold) {
  EXPECT_THAT(failure("render heat.nrrd -o a.png --radius 1", 1), HasSubstr("--radius"));
  EXPECT_THAT(failure("render a.xyz -o a.png --interpolation tricubic", 1),
              HasSubstr("--interpolation: is for grids"));
  EXPECT_THAT(failure("render heat.nrrd -o a.png --interpolation cubic", 2),
              HasSubstr("--interpolation: unknown interpolation 'cubic'"));
  EXPECT_THAT(failure("render heat.nrrd -o heat.nrrd", 2), HasSubstr("heat.nrrd"));
}

TEST_F(Grids, DamagedFilesAreTold) {
  workspace_.write("short.cube", cube(6).substr(0, 400));
  workspace_.write("huge.nrrd",
                   "NRRD0004\ntype: float\ndimension: 3\nsizes: 100000 100000 100000\n"
                   "encoding: raw\n\nabcd");
  workspace_.write(
      "thin.nrrd",
      "NRRD0004\ntype: float\ndimension: 3\nsizes: 2 1 2\nencoding: ascii\n\n1 2 3 4\n");
  EXPECT_THAT(failure("render short.cube -o a.png", 1), HasSubstr("short.cube"));
  EXPECT_THAT(failure("render huge.nrrd -o a.png", 1), HasSubstr("huge.nrrd"));
  EXPECT_THAT(failure("render thin.nrrd -o a.png", 1),
              HasSubstr("thin.nrrd: the grid 'value' is a single sample thick along y"));
  EXPECT_THAT(failure("info huge.nrrd", 1), HasSubstr("huge.nrrd"));
}

}  // namespace
}  // namespace motes
