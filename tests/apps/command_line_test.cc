// The contract of the command line: exit status, messages, what the options do, no half files.
#include <fcntl.h>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numeric>
#include <vector>

#include "apps/command_line.h"

namespace motes {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

TEST_F(CommandLine, HelpTeachesWithExamples) {
  for (const std::string command : {"", "bench ", "info ", "probe ", "render ", "resample "}) {
    const Outcome outcome = run(command + "--help");
    EXPECT_EQ(outcome.status, 0);
    EXPECT_EQ(outcome.err, "");
    EXPECT_THAT(outcome.out, HasSubstr("Examples:\n")) << command;
    EXPECT_THAT(outcome.out, HasSubstr("motes " + command)) << command;
  }
  EXPECT_THAT(run("--version").out, StartsWith("motes "));
  EXPECT_EQ(run("").out, run("--help").out);
  EXPECT_EQ(run("").status, 0);
  EXPECT_EQ(run("help").out, run("--help").out);
  EXPECT_EQ(run("help render").out, run("render --help").out);
  const std::string render = run("render --help").out;
  EXPECT_THAT(render, HasSubstr("MOTES_TARGET=SSE4, AVX2 or AVX-512"));
  EXPECT_THAT(render, HasSubstr("Reads LAMMPS"));
}

TEST_F(CommandLine, AWrongCommandLineIsStatus2) {
  failure("paint a.xyz", 2);
  failure("render", 2);
  EXPECT_THAT(failure("render a.xyz", 2), HasSubstr("--output"));
  EXPECT_THAT(failure("render a.xyz -o a.png --colour red", 2), HasSubstr("motes render --help"));
  EXPECT_THAT(failure("render a.xyz -o a.tiff", 2), StartsWith("motes: error: --output: a.tiff: "));
  EXPECT_THAT(failure("render a.xyz -o a.png --threads 0", 2),
              HasSubstr("--threads: expected a whole number from 1 to 4096, found '0'"));
  failure("probe a.xyz", 2);
  for (const std::string bad : {"--size 100",
                                "--size 0x5",
                                "--size 5x99999",
                                "--size 5x5x5",
                                "--eye 1,2",
                                "--eye 1,2,3,4",
                                "--eye 1,2,nan",
                                "--up a,b,c",
                                "--up 0,0,0",
                                "--clip-plane 0,0,0,1",
                                "--fov 0",
                                "--fov 180",
                                "--fov x",
                                "--orthographic -1",
                                "--fov 3 --orthographic 3",
                                "--frame -1",
                                "--frame 1.5",
                                "--types 1",
                                "--types 1=",
                                "--types Si=1",
                                "--step-size 0",
                                "--step-size inf",
                                "--support-factor 0",
                                "--termination-opacity 0",
                                "--termination-opacity 1.1",
                                "--radius 0",
                                "--radius -1",
                                "--radius ''",
                                "--weight inf",
                                "--transfer-function virids",
                                "--background blue",
                                "--background 12345",
                                "--background 0,0.5,-1",
                                "--background 128,128,128",
                                "--engine grid",
                                "--style balls",
                                "--kernel m4",
                                "--kernel tabulated",
                                "--ambient-occlusion -1",
                                "--engine fast",
                                "--lighting --no-lighting",
                                "--threads 0",
                                "--threads x",
                                "--repeat 0",
                                "--lighting=maybe"}) {
    failure("render a.xyz -o a.png " + bad, 2);
  }
  EXPECT_FALSE(workspace_.exists("a.png"));
}

TEST_F(CommandLine, ABackgroundIsSrgbOrLinear) {
  EXPECT_EQ(failure("render a.xyz -o a.png --background 128,128,128", 2),
            "motes: error: --background: expected black, white, '#rrggbb' (sRGB) or r,g,b (linear, "
            "each in [0, 1]), found '128,128,128' (see motes render --help)\n");
  for (const std::string good : {"black", "'#808080'", "808080", "0.2,0,1"}) {
    succeed("render a.xyz -o a.png --size 8x8 --background " + good);
  }
}

TEST_F(CommandLine, WrongNamesAreHelpedWithTheNearest) {
  EXPECT_THAT(failure("render a.xyz -o a.png --transfer-function virids", 2),
              HasSubstr("did you mean 'viridis'"));
  EXPECT_THAT(failure("render a.xyz -o a.png --engine direkt", 2),
              HasSubstr("did you mean 'direct'"));
  EXPECT_THAT(failure("render a.xyz -o a.png --radius siize", 1),
              HasSubstr("unknown property 'siize'"));
}

TEST_F(CommandLine, MisspeltOptionsAndCommandsAreHelped) {
  for (const std::string rest : {"render a.xyz -o a.png --trasfer-function magma",
                                 "render --trasfer-function magma a.xyz -o a.png --sise 3x3",
                                 "render a.xyz --trasfer-function=magma --ouput a.png"}) {
    EXPECT_EQ(failure(rest, 2),
              "motes: error: --trasfer-function: unknown option; did you mean "
              "--transfer-function? (see motes render --help)\n");
  }
  EXPECT_EQ(failure("render a.xyz -o a.png --zzz red", 2),
            "motes: error: --zzz: unknown option (see motes render --help)\n");
  for (const std::string option : {"--color", "--colormap", "--colour=red"}) {
    EXPECT_THAT(failure("render a.xyz -o a.png " + option, 2),
                HasSubstr("unknown option; colours and opacity are --transfer-function (see"));
  }
  for (const std::string option : {"--species Si", "--select x"}) {
    EXPECT_THAT(
        failure("render a.xyz -o a.png " + option, 2),
        HasSubstr("unknown option; selections are made in a scene file, docs/scene.md (see"));
  }
  EXPECT_EQ(failure("info a.xyz one.xyz", 2),
            "motes: error: unexpected argument 'one.xyz' (see motes info --help)\n");
  EXPECT_EQ(failure("rendr a.xyz -o a.png", 2),
            "motes: error: unknown command 'rendr'; did you mean 'render'? (see motes --help)\n");
  EXPECT_THAT(failure("a.xyz", 2),
              HasSubstr("a.xyz: expected a command first: 'motes render a.xyz -o picture.png' or "
                        "'motes info a.xyz'"));
  EXPECT_THAT(run("-v").out, StartsWith("motes "));
}

TEST_F(CommandLine, AFailureIsStatus1AndNamesTheFile) {
  EXPECT_THAT(failure("info missing.xyz", 1), HasSubstr("missing.xyz: "));
  EXPECT_THAT(failure("render missing.xyz -o a.png", 1), HasSubstr("missing.xyz: "));
  EXPECT_THAT(failure("probe missing.xyz --points a.xyz", 1), HasSubstr("a.xyz:"));
  EXPECT_THAT(failure("info .", 1), HasSubstr(".: "));
  workspace_.write("text", "no particles here\n");
  EXPECT_THAT(failure("info text", 1), HasSubstr("unknown format"));
  EXPECT_THAT(failure("info a.xyz --frame 1", 1), HasSubstr("no frame 1"));
  workspace_.write("bad.xyz", "2\n\nSi 0 0 0\nO 1 x 0\n");
  EXPECT_THAT(failure("render bad.xyz -o a.png", 1), HasSubstr("bad.xyz:4: "));
  EXPECT_FALSE(workspace_.exists("a.png"));
}

TEST_F(CommandLine, AnOutputThatCannotBeWrittenIsToldBeforeReading) {
  for (const std::string option : {"-o no/a.png", "-o a.png --stats no/s.json"}) {
    EXPECT_THAT(failure("render missing.xyz " + option, 1), HasSubstr("no/"));
  }
  EXPECT_THAT(failure("probe missing.xyz --points missing.csv -o no/a.csv", 1), HasSubstr("no/"));
  failure("render a.xyz -o a.png --size 8x8 --stats /dev/full", 1);
  EXPECT_EQ(run("info a.xyz >/dev/full").status, 1);
}

TEST_F(CommandLine, PictureAndStatisticsAreTwoFiles) {
  workspace_.write("a.png", "old");
  for (const std::string same : {"a.png", "./a.png", "../$(basename $PWD)/a.png"}) {
    EXPECT_THAT(failure("render a.xyz -o a.png --size 8x8 --stats " + same, 1),
                StartsWith("motes: error: a.png: is both --output and --stats; expected two"))
        << same;
  }
  EXPECT_EQ(workspace_.read("a.png"), "old");
}

TEST_F(CommandLine, AFailureHarmsNoOldFileAndLeavesNoneBehind) {
  workspace_.write("a.png", "old");
  workspace_.write("empty.xyz", "0\n\n");
  const std::size_t before = workspace_.num_files();
  failure("render missing.xyz -o a.png", 1);
  EXPECT_THAT(failure("render empty.xyz -o a.png", 1), HasSubstr("empty.xyz: has no particles"));
  failure("render a.xyz -o a.png --eye 1,1,1 --target 1,1,1", 1);
  EXPECT_EQ(workspace_.read("a.png"), "old");
  EXPECT_EQ(workspace_.num_files(), before);
  succeed("render a.xyz -o a.png --size 8x8");
  EXPECT_NE(workspace_.read("a.png"), "old");
  EXPECT_EQ(workspace_.num_files(), before);
}

TEST_F(CommandLine, AKilledProgramLeavesNoFile) {
  const int nameless =
      open(std::filesystem::temp_directory_path().c_str(), O_TMPFILE | O_WRONLY, 0600);
  if (nameless < 0) GTEST_SKIP() << "this file system has no files without names";
  close(nameless);
  const std::size_t before = workspace_.num_files();
  // It waits for points that never come, with its output open.
  const Outcome outcome = run(
      fmt::format("--version; sleep 1 | timeout -s KILL 0.5 '{}' probe a.xyz --points - -o out.csv",
                  MOTES_PROGRAM));
  EXPECT_NE(outcome.status, 0);
  EXPECT_EQ(workspace_.num_files(), before);
}

TEST_F(CommandLine, AnInterruptedProgramSaysSoAndLeavesNoFile) {
  const std::size_t before = workspace_.num_files();
  // So many samples that it is still busy when the signal comes. timeout repeats its signal as its
  // status: 128 + SIGINT.
  const Outcome outcome =
      run(fmt::format("--version >version; timeout --preserve-status -s INT 1 '{}' render a.xyz "
                      "-o a.png --size 4000x4000 --step-size 0.0001",
                      MOTES_PROGRAM));
  EXPECT_EQ(outcome.status, 130);
  EXPECT_EQ(outcome.err, "motes: interrupted\n");
  EXPECT_EQ(workspace_.num_files(), before + 1);
}

TEST_F(CommandLine, RenderWritesEveryFormat) {
  succeed("render a.xyz -o a.png --size 16x8");
  EXPECT_THAT(workspace_.read("a.png"), StartsWith("\x89PNG"));
  succeed("render a.xyz -o a.jpg --size 16x8");
  EXPECT_THAT(workspace_.read("a.jpg"), StartsWith("\xff\xd8"));
  succeed("render a.xyz -o a.EXR --size 16x8");
  EXPECT_THAT(workspace_.read("a.EXR"), StartsWith("\x76\x2f\x31\x01"));
  succeed("render a.xyz -o a.npy --size 16x8");
  EXPECT_EQ(pixels("a.npy").size(), 16u * 8 * 4);
}

TEST_F(CommandLine, WithoutOptionsThePictureIsNeitherEmptyNorABlock) {
  succeed("render a.xyz -o a.npy");
  const std::vector<float> rgba = pixels("a.npy");
  ASSERT_EQ(rgba.size(), 1024u * 1024 * 4);
  std::size_t seen = 0, opaque = 0;
  for (std::size_t i = 3; i < rgba.size(); i += 4) {
    seen += rgba[i] > 0.05f;
    opaque += rgba[i] > 0.95f;
  }
  EXPECT_GT(seen, rgba.size() / 4 / 20);
  EXPECT_LT(opaque, seen / 2);
}

TEST_F(CommandLine, SticksThatLeaveTheCellAreInThePicture) {
  workspace_.write("p.xyz",
                   "2\nLattice=\"6 0 0 0 6 0 0 0 6\" Properties=species:S:1:pos:R:3\n"
                   "C 0.6 3 3\nC 5.4 3 3\n");
  succeed("render p.xyz -o p.npy --style ball-and-stick --size 64x64");
  const std::vector<float> rgba = pixels("p.npy");
  float seen = 0;
  for (std::size_t y = 0; y < 64; ++y) {
    for (std::size_t x = 0; x < 64; ++x) {
      const float alpha = rgba[4 * (64 * y + x) + 3];
      seen += alpha;
      const bool at_edge = x == 0 || y == 0 || x == 63 || y == 63;
      EXPECT_TRUE(!at_edge || alpha == 0) << x << " " << y;
    }
  }
  EXPECT_GT(seen, 100);
}

TEST_F(CommandLine, OptionsOfFieldsAreRefusedWhereThereAreNone) {
  for (const std::string style : {"spheres", "ball-and-stick"}) {
    for (const std::string option : {"--radius 2", "--weight 3", "--transfer-function magma"}) {
      EXPECT_THAT(failure(fmt::format("render a.xyz -o a.png --style {} {}", style, option), 1),
                  HasSubstr(option.substr(0, option.find(' ')) + ": is for fields"))
          << style;
    }
  }
  EXPECT_EQ(
      failure("render a.xyz -o a.png --size 4x4 --size 5x5", 2),
      "motes: error: --size: given more than once; expected one value (see motes render --help)\n");
}

TEST_F(CommandLine, LightsAddUp) {
  workspace_.write("p.xyz", "1\n\nC 0 0 0\n");
  const std::string render = "render p.xyz --size 32x32 --save-scene s.json ";
  const auto with = [&](const std::string& lights) {
    succeed(render + "-o a.npy " + lights);
    std::vector<float> line = pixels("a.npy");
    succeed("render s.json -o b.npy");
    EXPECT_EQ(pixels("b.npy"), line) << lights;
    return line;
  };
  const std::vector<float> none = with("--light headlight,0"), side = with("--light 3,1,1"),
                           head = with("--light headlight,0.5"),
                           both = with("--light 3,1,1 --light headlight,0.5");
  EXPECT_EQ(with("--light-direction 3,1,1"), side);
  EXPECT_EQ(with("--light headlight,1"), with(""));
  double brightest = 0;
  for (std::size_t i = 0; i < both.size(); ++i) {
    EXPECT_NEAR(both[i], side[i] + head[i] - none[i], 1e-5);
    brightest = std::max<double>(brightest, both[i] - side[i]);
  }
  EXPECT_GT(brightest, 0.05);
  EXPECT_EQ(with("--light-direction 3,1,1 --light-angle 0"), side);  // (a volume has no shadows)
  const std::string expected = "--light: expected a direction such as 1,2,1.5, not 0,0,0, or";
  for (const std::string bad :
       {"1,2", "1,2,3,4,5", "headlights", "headlight,x", "1,2,3,-1", "1,2,3,", "headlight,",
        "headlight,inf", "headlight,1e39", "''", "0,0,0", "0,0,0,1"}) {
    EXPECT_THAT(failure("render p.xyz -o a.npy --light " + bad, 2), HasSubstr(expected)) << bad;
  }
  EXPECT_THAT(failure("render p.xyz -o a.npy --light 1,2,3 --no-lighting", 2),
              HasSubstr("excludes"));
  EXPECT_THAT(failure("render p.xyz -o a.npy --light-angle 91", 2), HasSubstr("0 to 90"));
  // Lights are asked for: a scene without has them then.
  workspace_.write("dark.json",
                   R"({"version": 1, "data": {"path": "p.xyz"}, "render": {"size": [32, 32],
                      "lighting": {"enabled": false}}})");
  succeed("render dark.json -o dark.npy --light 3,1,1");
  EXPECT_EQ(pixels("dark.npy"), side);
  std::string nine;
  for (int i = 0; i < 9; ++i) nine += " --light headlight";
  EXPECT_THAT(failure("render p.xyz -o a.npy" + nine, 2), HasSubstr("at most 8 lights, found '9'"));
}

TEST_F(CommandLine, ALightFromASideThrowsShadows) {
  workspace_.write("p.xyz", "2\n\nC 0 0 0\nO 0 0 4\n");
  const std::string render =
      "render p.xyz --style spheres --size 64x64 --eye 9,0,2 --target 0,0,2 ";
  succeed(render + "-o a.npy --light-direction 1,0,0.01");
  succeed(render + "-o b.npy --light-direction 1,0,5 --save-scene b.json");
  const std::vector<float> front = pixels("a.npy"), above = pixels("b.npy");
  EXPECT_LT(std::accumulate(above.begin(), above.end(), 0.0),
            0.95 * std::accumulate(front.begin(), front.end(), 0.0));
  succeed("render b.json -o c.npy");
  EXPECT_EQ(pixels("c.npy"), above);
  EXPECT_THAT(failure("render p.xyz -o a.png --light-direction 0,0,0", 2),
              HasSubstr("not all of them 0, found '0,0,0'"));
  EXPECT_THAT(failure("view nope.xyz", 1), HasSubstr("nope.xyz: there is no such file"));
}

TEST_F(CommandLine, StatisticsHaveEveryKey) {
  succeed("render a.xyz -o a.png --size 32x32 --stats s.json --repeat 3 --threads 1");
  const auto stats = nlohmann::json::parse(workspace_.read("s.json"));
  for (const char* key : {"frame_ms", "frame_ms_min", "build_ms", "read_ms", "particles", "samples",
                          "kernel_evaluations", "particle_bytes", "tree_bytes", "peak_rss_bytes",
                          "threads", "engine", "instruction_set"}) {
    EXPECT_TRUE(stats.contains(key)) << key;
  }
  EXPECT_EQ(stats["particles"], 3);
  EXPECT_EQ(stats["threads"], 1);
  EXPECT_EQ(stats["engine"], "sweep");
  EXPECT_GT(stats["samples"], 0);
  EXPECT_LE(stats["frame_ms_min"], stats["frame_ms"]);
  double sum = 0;
  for (const auto& fraction : stats["stages"]) sum += fraction.get<double>();
  EXPECT_NEAR(sum, 1, 1e-9);
}

TEST_F(CommandLine, MistakesOfOptionsThatTheDataShowNameTheOption) {
  const auto message = [this](const std::string& options) {
    return failure("render a.xyz -o a.png --size 8x8 " + options, 1);
  };
  const std::string start = "motes: error: ";
  EXPECT_THAT(message("--eye 0,9,0 --target 0,0,0 --up 0,1,0"),
              StartsWith(start + "--up: is parallel"));
  EXPECT_THAT(message("--radius q"), StartsWith(start + "--radius: unknown property 'q'"));
  EXPECT_THAT(message("--step-size 1e-12"), StartsWith(start + "--step-size: 1e-12 takes "));
  EXPECT_THAT(message("--eye 0,0,1e30"), StartsWith(start + "--eye: is 1e+30 away"));
  workspace_.write("p.csv", "0,0,0\n");
  EXPECT_THAT(failure("probe a.xyz --points p.csv --weight q", 1),
              StartsWith(start + "--weight: unknown property 'q'"));
  // What has nothing to do with the file does not name it.
  const Outcome outcome =
      run("--version; MOTES_TARGET=no '" MOTES_PROGRAM "' render a.xyz -o a.png");
  EXPECT_THAT(outcome.err, StartsWith(start + "MOTES_TARGET=no: "));
}

TEST_F(CommandLine, ATransferFunctionMayBeAFile) {
  workspace_.write("t.json", R"({"points": [{"value": 0, "color": "#ff0000", "extinction": 0},
                                            {"value": 1, "color": "#ff0000", "extinction": 9}]})");
  succeed("render a.xyz -o a.npy --size 32x32 --no-lighting --transfer-function t.json");
  const std::vector<float> rgba = pixels("a.npy");
  float red = 0, green = 0;
  for (std::size_t i = 0; i < rgba.size(); i += 4) {
    red += rgba[i];
    green += rgba[i + 1];
  }
  EXPECT_GT(red, 1);
  EXPECT_EQ(green, 0);
  EXPECT_THAT(failure("render a.xyz -o a.npy --transfer-function none.json", 1),
              HasSubstr("none.json: there is no such file"));
  EXPECT_THAT(failure("render none.json -o a.npy", 1),
              HasSubstr("none.json: there is no such file"));
  for (const std::string map :
       {"viridis", "magma", "inferno", "plasma", "heat", "grey", "species"}) {
    succeed("render a.xyz -o a.npy --size 16x16 --transfer-function " + map);
  }
}

TEST_F(CommandLine, ACameraThatLooksAtNothingGivesAnEmptyPicture) {
  const Outcome outcome = run("render a.xyz -o a.npy --size 16x16 --eye 0,0,50 --target 0,0,99");
  EXPECT_EQ(outcome.status, 0);
  EXPECT_EQ(outcome.err,
            "motes: warning: nothing is in view; the data span x 0 to 4, y 0 to 0, z 0 to 0 "
            "angstrom\n");
  for (const float v : pixels("a.npy")) EXPECT_EQ(v, 0);
}

TEST_F(CommandLine, ALevelThatIsNotReachedIsNamedWithTheFieldsRange) {
  workspace_.write("s.json", R"({"version": 1, "data": {"path": "a.xyz"}, "fields":
      [{"name": "silicon", "radius": 1, "weight": 2, "select": {"species": "Si"},
        "isosurfaces": [{"value": 1}, {"value": 7}]}]})");
  EXPECT_EQ(run("render s.json -o a.npy --size 16x16").err, "") << "one of them is seen";
  workspace_.write("s.json", R"({"version": 1, "data": {"path": "a.xyz"}, "fields":
      [{"name": "silicon", "radius": 1, "weight": 2, "select": {"species": "Si"},
        "isosurfaces": [{"value": 7}, {"value": -1}]}]})");
  const std::string range = "; it goes from 0 to 2\n";
  EXPECT_EQ(run("render s.json -o a.npy --size 16x16").err,
            "motes: warning: the field 'silicon' does not reach its isosurface at 7" + range +
                "motes: warning: the field 'silicon' does not reach its isosurface at -1" + range);
}

TEST_F(CommandLine, APictureThatIsAllButEmptyIsExplained) {
  const auto warning = [this](const std::string& options) {
    const Outcome outcome = run("render a.xyz -o a.png --size 16x16 " + options);
    EXPECT_EQ(outcome.status, 0);
    return outcome.err;
  };
  workspace_.write("t.json",
                   R"({"points": [{"value": 1, "color": "#ff0000", "extinction": 1e-4}]})");
  EXPECT_THAT(warning("--transfer-function t.json"),
              testing::MatchesRegex("motes: warning: the particles in view are too transparent to "
                                    "be seen \\(largest opacity [0-9.e-]+\\); expected a larger "
                                    "extinction in the transfer function.*\n"));
  EXPECT_THAT(warning("--style spheres --clip-plane 1,0,0,-1"),
              HasSubstr("motes: warning: none of the balls and sticks in view is seen"));
  for (const std::string wide : {"--fov 179.99", "--style spheres --orthographic 1e5"}) {
    EXPECT_THAT(warning(wide),
                HasSubstr("motes: warning: what is in view is no larger than a pixel"));
  }
  const std::string away = " --eye 0,0,50 --target 0,0,99";
  EXPECT_THAT(warning("--transfer-function t.json" + away), HasSubstr("nothing is in view"));
  EXPECT_THAT(warning("--orthographic 5 --target 0,50,0 --eye 0,50,9"),
              HasSubstr("nothing is in view"));
  // The largest radius is that of silicon, 1.11.
  const std::string steps =
      "is larger than the kernels (support diameter 4.44): most of them fall between samples; "
      "expected 1.11 or less, or larger radii\n";
  EXPECT_EQ(warning("--step-size 100"), "motes: warning: step_size 100 " + steps);
  EXPECT_EQ(warning("--step-size 4.5"), "motes: warning: step_size 4.5 " + steps);
  EXPECT_EQ(warning("--step-size 4.4"), "");
  EXPECT_THAT(warning("--radius 0.0001"),
              testing::AllOf(HasSubstr("is larger than the kernels (support diameter 0.0004)"),
                             testing::Not(HasSubstr("in view"))));
  EXPECT_THAT(warning("--step-size 100" + away), HasSubstr("nothing is in view"));
}

TEST_F(CommandLine, ParticlesThatCannotBeDrawnAreCounted) {
  workspace_.write("nan.xyz", "3\n\nSi 0 0 0\nSi nan 0 0\nSi 1 inf 0\n");
  const Outcome outcome = run("render nan.xyz -o a.png --size 16x16");
  EXPECT_EQ(outcome.status, 0);
  EXPECT_THAT(outcome.err, HasSubstr("motes: warning: "));
  EXPECT_THAT(outcome.err, HasSubstr("2 of 3 particles"));
}

TEST_F(CommandLine, StatisticsNameTheEngine) {
  EXPECT_EQ(run("render a.xyz -o a.png --size 16x16 --stats s.json").status, 0);
  EXPECT_EQ(nlohmann::json::parse(workspace_.read("s.json"))["engine"], "sweep");
  EXPECT_EQ(run("render a.xyz -o a.png --size 16x16 --engine coherent --stats s.json").status, 0);
  EXPECT_EQ(nlohmann::json::parse(workspace_.read("s.json"))["engine"], "coherent");
}

}  // namespace
}  // namespace motes
