// What motes info and motes probe print.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>

#include "apps/command_line.h"

namespace motes {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

TEST_F(CommandLine, NamesOfTypesThatAreNotThereAreTold) {
  workspace_.write(
      "a.dump",
      "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n2\nITEM: BOX BOUNDS pp pp pp\n0 9\n0 9\n"
      "0 9\nITEM: ATOMS id type x y z\n1 1 0 0 0\n2 2 1 1 1\n");
  EXPECT_EQ(run("info a.dump --types 1=O,3=Si").err,
            "motes: warning: a.dump: has no type 3 to be named Si; there are: 1, 2\n");
  EXPECT_EQ(run("info a.dump --types 1=O,2=Si").err, "");
}

TEST_F(CommandLine, APipeIsRefusedAtOnce) {
  ASSERT_EQ(mkfifo(workspace_.path("pipe").c_str(), 0600), 0);
  const Outcome outcome = run("info pipe");
  EXPECT_EQ(outcome.status, 1);
  EXPECT_THAT(outcome.err, StartsWith("motes: error: pipe: "));
}

TEST_F(CommandLine, InfoPrintsATable) {
  const Outcome outcome = run("info a.xyz");
  EXPECT_EQ(outcome.status, 0);
  EXPECT_THAT(outcome.out, testing::ContainsRegex("particles +3\n"));
  EXPECT_THAT(outcome.out, testing::ContainsRegex("Si +2\n"));
  EXPECT_THAT(outcome.out, testing::ContainsRegex("radius +covalent radii"));
}

TEST_F(CommandLine, InfoKeepsItsColumnsAndSaysWhichFrame) {
  const std::string frame =
      "1\nProperties=species:S:1:pos:R:3:q:R:1:a_very_long_name_of_a_property:R:1\nSi 1 2 3 5 7\n";
  workspace_.write("long.xyz", frame + frame);
  const std::string out = run("info long.xyz --frame 1").out;
  EXPECT_THAT(out, testing::ContainsRegex("frames +2\nframe +1\n"));
  const auto column = [&out](const std::string& value) {
    const auto at = out.find(value);
    EXPECT_NE(at, std::string::npos) << out;
    return at - out.rfind('\n', at);
  };
  EXPECT_EQ(column("5 to 5"), column("7 to 7")) << out;
}

TEST_F(CommandLine, InfoPrintsJson) {
  workspace_.write("cell.xyz",
                   "1\nLattice=\"5 0 0 0 6 0 0 0 7\" pbc=\"T F T\" Time=2.5 "
                   "Properties=species:S:1:pos:R:3:charge:R:1\nSi 1 2 3 0.5\n"
                   "1\nLattice=\"5 0 0 0 6 0 0 0 7\" "
                   "Properties=species:S:1:pos:R:3:charge:R:1\nSi 1 2 3 0.5\n");
  auto info = nlohmann::json::parse(run("info cell.xyz --json").out);
  EXPECT_EQ(info["particles"], 1);
  EXPECT_EQ(info["frames"], 2);
  EXPECT_EQ(info["species"], nlohmann::json::parse(R"([{"name": "Si", "count": 1}])"));
  EXPECT_THAT(info["properties"].dump(), HasSubstr("\"charge\""));
  EXPECT_EQ(info["cell"], nlohmann::json::parse("[[5, 0, 0], [0, 6, 0], [0, 0, 7]]"));
  EXPECT_EQ(info["periodic"], nlohmann::json::parse("[true, false, true]"));
  EXPECT_EQ(info["bounds"], nlohmann::json::parse(R"({"min": [1, 2, 3], "max": [1, 2, 3]})"));
  EXPECT_EQ(info["length_unit"], "angstrom");
  info = nlohmann::json::parse(run("info a.xyz --json").out);
  EXPECT_EQ(info["cell"], nullptr);
  EXPECT_TRUE(info.contains("format"));
  EXPECT_TRUE(info.contains("time"));
}

class Probe : public CommandLine {
 protected:
  /// What probing one silicon atom at the origin with radius 2 gives, at (1, 0, 0).
  std::string row() const {
    const double value = std::exp(-0.125);
    return fmt::format("1,0,0,{:.9g},{:.9g},", value, -value / 4);
  }
  Outcome probe(const std::string& points) {
    workspace_.write("p.csv", points);
    return run("probe one.xyz --radius 2 --points p.csv");
  }
};

TEST_F(Probe, PrintsValuesAndGradients) {
  const Outcome outcome = probe("x,y,z\n1,0,0\n0,0,99\n");
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  std::istringstream lines(outcome.out);
  std::string line;
  std::getline(lines, line);
  EXPECT_EQ(line, "x,y,z,all,all_dx,all_dy,all_dz");
  std::getline(lines, line);
  EXPECT_THAT(line, StartsWith(row()));
  std::getline(lines, line);
  EXPECT_THAT(line, testing::MatchesRegex("0,0,99,-?0,-?0,-?0,-?0"));
}

TEST_F(Probe, ReadsWhatPeopleWrite) {
  for (const std::string points :
       {"1,0,0", "1 0 0\n", "  1\t0\t0 \r\n", "1;0;0\n", "# a comment\n\n1, 0, 0\n",
        "z,name,y,x\n0,a,0,1\n", "\"x\",\"y\",\"z\"\n1,0,0\n", "\xef\xbb\xbfX,Y,Z\n1e0,0.0,+0\n"}) {
    EXPECT_THAT(probe(points).out, HasSubstr("\n" + row())) << points;
  }
  workspace_.write("p.csv", "1,0,0\n");
  EXPECT_THAT(run("probe one.xyz --radius 2 --points - <p.csv").out, HasSubstr(row()));
  succeed("probe one.xyz --radius 2 --points p.csv -o out.csv");
  EXPECT_THAT(workspace_.read("out.csv"), HasSubstr(row()));
}

TEST_F(Probe, NamesTheLineOfAMistake) {
  EXPECT_THAT(probe("x,y,z\n1,0,0\n1,b,0\n").err,
              HasSubstr("p.csv:3: expected a number for y in column 2, found 'b'"));
  EXPECT_THAT(probe("1,0\n").err, HasSubstr("p.csv:1: expected a number for z"));
  EXPECT_THAT(probe("a,b,c\n1,0,0\n").err, HasSubstr("p.csv:1: expected numbers, or names"));
  EXPECT_THAT(probe("x,y,z\n").err, HasSubstr("p.csv: has no points"));
  EXPECT_EQ(probe("").status, 1);
}

}  // namespace
}  // namespace motes
