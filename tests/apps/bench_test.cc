// motes bench: scenes that are always the same, results that can be read, refusals before the work.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <set>
#include <string>

#include "apps/command_line.h"

namespace motes {
namespace {

using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

constexpr const char* data = " --data '" MOTES_SOURCE_DIR "/data/bench'";

class Bench : public CommandLine {
 protected:
  /// `arguments` with the bundled data, at a tiny size.
  Outcome bench(const std::string& arguments) { return run("bench " + arguments + data); }
  Outcome measure(const std::string& arguments) {
    Outcome outcome = bench(arguments + " --size 64x64 --repeat 1");
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return outcome;
  }
  nlohmann::json result(const std::string& name) {
    return nlohmann::json::parse(workspace_.read("out/bench/" + name + ".json"));
  }
};

TEST_F(Bench, ScenesAreTheSameEveryTime) {
  const std::string file = "out/bench/scenes/tryptophan.npy";
  const Outcome first = bench("scenes tryptophan");
  EXPECT_EQ(first.status, 0) << first.err;
  EXPECT_THAT(first.out, HasSubstr("6830"));
  const std::string bytes = workspace_.read(file);
  EXPECT_GT(bytes.size(), std::size_t{6830 * 17});
  EXPECT_EQ(bench("scenes --scenes tryptophan").status, 0);
  EXPECT_TRUE(workspace_.read(file) == bytes);
  EXPECT_EQ(bench("scenes tryptophan --threads 1 --output other").status, 0);
  EXPECT_TRUE(workspace_.read("other/scenes/tryptophan.npy") == bytes);

  const auto info = nlohmann::json::parse(run("info --json " + file).out);
  EXPECT_EQ(info["particles"], 6830);
  EXPECT_EQ(info["species"].size(), 5);
  EXPECT_EQ(info["properties"], nlohmann::json({"molecule"}));
}

TEST_F(Bench, CarvedSpheresHaveTheirNumberOfAtoms) {
  const Outcome outcome = bench("scenes nanosphere_740k");
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  const auto info =
      nlohmann::json::parse(run("info --json out/bench/scenes/nanosphere_740k.npy").out);
  EXPECT_EQ(info["particles"], 742000);
  for (const int axis : {0, 1, 2}) {
    EXPECT_NEAR(info["bounds"]["max"][axis].get<double>(), 120.5, 1);
    EXPECT_NEAR(info["bounds"]["min"][axis].get<double>(), -120.5, 1);
  }
}

TEST_F(Bench, Table1NamesSizesAndBuildTimes) {
  measure("table1 --scenes zeolite");
  const auto table = result("table1");
  ASSERT_EQ(table["rows"].size(), 1U);
  const auto& row = table["rows"][0];
  EXPECT_EQ(row["scene"], "zeolite");
  EXPECT_EQ(row["fields"], 2);
  EXPECT_GT(row["build_s"].get<double>(), 0);
  EXPECT_NEAR(row["bytes_per_particle"].get<double>() * row["particles"].get<double>(),
              row["particle_bytes"].get<double>() + row["tree_bytes"].get<double>(), 1);
  EXPECT_EQ(row["paper"]["build_s"], 0.0256);
  EXPECT_THAT(workspace_.read("out/bench/table1.svg"), StartsWith("<svg "));
}

TEST_F(Bench, QualityComesWithFinerGrids) {
  measure("quality");
  const auto table = result("quality");
  ASSERT_EQ(table["rows"].size(), 10U);
  EXPECT_EQ(table["rows"][0]["reconstruction"], "field");
  EXPECT_EQ(table["rows"][0]["rms"], 0);
  double last = 1;
  for (std::size_t i = 1; i < 10; i += 3) {
    const double trilinear = table["rows"][i]["rms"], tricubic = table["rows"][i + 1]["rms"];
    const double smoothing = table["rows"][i + 2]["rms"];
    EXPECT_LT(trilinear, last);
    EXPECT_LT(tricubic, trilinear);
    EXPECT_LT(trilinear, smoothing);
    last = trilinear;
  }
  // Voxels of a quarter of an angstrom show the field, but for the kernels' jumps at their ends.
  EXPECT_LT(last, 0.02);
  EXPECT_GT(table["rows"][7]["bytes"].get<double>(), 1e8);
  for (const auto& row : table["rows"]) {
    EXPECT_TRUE(workspace_.exists(row["picture"].get<std::string>()));
  }
  EXPECT_TRUE(workspace_.exists("out/bench/quality_figure1.png"));
}

TEST_F(Bench, KernelsAreSampledAtTheSamePlaces) {
  measure("kernels --scenes zeolite");
  const auto table = result("kernels");
  ASSERT_EQ(table["rows"].size(), 18U);
  for (std::size_t i = 0; i < 18; ++i) {
    const auto& row = table["rows"][i];
    const auto& gaussian = table["rows"][i < 9 ? 0 : 9];
    EXPECT_EQ(gaussian["kernel"], "gaussian");
    EXPECT_EQ(row["lit"]["samples"], gaussian["unlit"]["samples"]);
    EXPECT_EQ(row["lit_over_gaussian"],
              row["lit"]["frame_ms"].get<double>() / gaussian["lit"]["frame_ms"].get<double>());
  }
  EXPECT_THAT(workspace_.read("out/bench/kernels.svg"), StartsWith("<svg "));
}

TEST_F(Bench, Table2ComparesEnginesInBothViews) {
  const Outcome outcome = measure("table2 --scenes nanobowl,zeolite");
  EXPECT_EQ(outcome.err, "");
  const auto table = result("table2");
  for (const char* key : {"processor", "compiler", "instruction_set", "system"}) {
    EXPECT_FALSE(table["machine"][key].get<std::string>().empty()) << key;
  }
  EXPECT_EQ(table["settings"]["width"], 64);
  ASSERT_EQ(table["rows"].size(), 4U);
  for (const auto& row : table["rows"]) {
    EXPECT_THAT(outcome.out, HasSubstr(row["scene"].get<std::string>()));
    for (const char* lighting : {"lit", "unlit"}) {
      const auto& pair = row[lighting];
      const double ratio = pair["coherent_over_sweep"];
      EXPECT_TRUE(std::isfinite(ratio) && ratio > 0) << row;
      EXPECT_GT(pair["coherent_over_sweep_at_most"], ratio) << row;
      EXPECT_EQ(pair["sweep"]["samples"], pair["coherent"]["samples"]);
    }
    EXPECT_EQ(row["lit"]["sweep"]["samples"], row["unlit"]["sweep"]["samples"]);
    EXPECT_EQ(row["lit_over_unlit"], row["lit"]["sweep"]["frame_ms"].get<double>() /
                                         row["unlit"]["sweep"]["frame_ms"].get<double>());
    EXPECT_GT(row["direct"]["fps"].get<double>(), 0);
    EXPECT_GT(row["structured"]["fps"].get<double>(), 0);
    EXPECT_GT(row["structured_bytes"].get<double>(), 1e5);
    // Half-transparent, as it is meant to be.
    EXPECT_GT(row["mean_opacity"].get<double>(), 0.2);
    EXPECT_LT(row["mean_opacity"].get<double>(), 0.95);
  }
  // The means under the table are those of its rows.
  double logs = 0;
  for (const auto& row : table["rows"]) {
    logs += std::log(row["unlit"]["coherent_over_sweep"].get<double>());
  }
  EXPECT_NEAR(table["summary"]["coherent_over_sweep_unlit"]["geometric_mean"].get<double>(),
              std::exp(logs / 4), 1e-9);
  EXPECT_EQ(table["rows"][0]["scene"], "zeolite");
  EXPECT_TRUE(table["rows"][0]["paper_cpu_fps"].is_null());
  EXPECT_EQ(table["rows"][2]["paper_cpu_fps"], 3.65);
  EXPECT_EQ(table["rows"][3]["paper_cpu_fps"], 2.53);
  EXPECT_EQ(table["rows"][3]["paper_structured_cpu_fps"], 4.02);
  EXPECT_THAT(workspace_.read("out/bench/table2.svg"), HasSubstr("nanobowl close"));
}

TEST_F(Bench, FieldsCompareFramesInWhichRaysGoEquallyDeep) {
  const Outcome outcome = measure("fields zeolite nanobowl");
  EXPECT_EQ(outcome.err, "");
  const auto rows = result("fields")["rows"];
  ASSERT_EQ(rows.size(), 4U);
  for (const auto& row : rows) {
    EXPECT_EQ(row["fields"], 2);  // the bowl's one field becomes one for each of its two elements
    const double one = row["one_field"]["frame_ms"], shared = row["shared"]["frame_ms"];
    EXPECT_NEAR(row["each_additional_field"].get<double>(), shared / one - 1, 1e-9);
    const double samples = row["one_field"]["samples"];
    EXPECT_NEAR(row["shared"]["samples"].get<double>(), samples, 0.01 * samples);
    EXPECT_NEAR(row["doubled"]["samples"].get<double>(), samples, 0.001 * samples);
    // The same kernels, and twice as many; less what the sweep saves by looking more often, with
    // more fields, whether rays have ended.
    const double evaluations = row["one_field"]["kernel_evaluations"];
    const double doubled = row["doubled"]["kernel_evaluations"];
    EXPECT_LT(doubled, 2.05 * evaluations);
    EXPECT_GT(doubled, 1.5 * evaluations);
  }
  EXPECT_THAT(workspace_.read("out/bench/fields.svg"), HasSubstr("zeolite close"));

  const Outcome alike = bench("fields nanosphere_90k");
  EXPECT_EQ(alike.status, 1);
  EXPECT_THAT(alike.err, HasSubstr("nanosphere_90k has one field and one species"));
}

TEST_F(Bench, LimitComparesWithThePeakOfTheMachine) {
  const Outcome outcome = measure("limit zeolite --threads 2 --memory 1");
  EXPECT_EQ(outcome.err, "");
  const auto table = result("limit");
  const auto peak = table["summary"]["peak"];
  EXPECT_EQ(peak["threads"], 2);
  const double lit = peak["lit_evaluations_per_second"];
  EXPECT_GT(lit, 0);
  for (const char* key : {"unlit_evaluations_per_second", "time_stamp_ticks_per_second",
                          "read_bytes_per_second", "copied_bytes_per_second"}) {
    EXPECT_GT(peak[key].get<double>(), 0) << key;
  }
  ASSERT_EQ(table["rows"].size(), 2U);
  for (const auto& row : table["rows"]) {
    EXPECT_EQ(row["lighting"], true);
    double stages = 0;
    for (const auto& stage : row["stages"].items()) stages += stage.value().get<double>();
    EXPECT_NEAR(stages, 1, 1e-9);
    EXPECT_GT(row["stages"]["sums"], 0);
    // The same by hand, all lanes counted.
    const double lanes = row["sweep"]["kernel_evaluations"];
    const double seconds = 1e-3 * row["sweep"]["frame_ms"].get<double>();
    EXPECT_NEAR(row["peak_fraction_lanes"].get<double>(), lanes / lit / seconds, 1e-9);
    EXPECT_GT(row["ticks_per_lane"].get<double>(), 0);
    if (row["evaluations_inside"].is_null()) continue;  // the engine does not count them
    EXPECT_LT(row["evaluations_inside"], lanes);
    EXPECT_LT(row["peak_fraction_inside"], row["peak_fraction_lanes"]);
  }
  EXPECT_THAT(workspace_.read("out/bench/limit.svg"), HasSubstr("zeolite close"));
  EXPECT_THAT(workspace_.read("out/bench/limit_stages.svg"), Not(HasSubstr("nan")));
}

TEST_F(Bench, LimitMeasuresTheInstructionSetThatIsForced) {
  ::setenv("MOTES_TARGET", "SSE4", 1);
  measure("limit zeolite --memory 1");
  ::unsetenv("MOTES_TARGET");
  EXPECT_EQ(result("limit")["machine"]["instruction_set"], "SSE4");
  EXPECT_EQ(result("limit")["summary"]["peak"]["lanes"], 4);
}

TEST_F(Bench, BuildTimesTheTreeAndCountsItsMemory) {
  const Outcome outcome = measure("build nanosphere_90k");
  EXPECT_EQ(outcome.err, "");
  const auto row = result("build")["rows"][0];
  const auto& motes = row["motes"];
  EXPECT_EQ(row["particles"], 92000);
  for (const char* key : {"build_s", "tree_alone_s", "refit_s"}) {
    EXPECT_GT(motes[key].get<double>(), 0) << key;
    EXPECT_LT(motes[key].get<double>(), 60) << key;
  }
  // 5750 leaves; nodes of 224 bytes, level by level.
  EXPECT_EQ(motes["tree_bytes"], (719 + 90 + 12 + 2 + 1) * 224);
  // Positions besides: all have one radius and one weight.
  EXPECT_NEAR(motes["bytes_per_particle"].get<double>(),
              12 + motes["tree_bytes_per_particle"].get<double>(), 0.01);
  // About 32; the system counts pages of small processes in large steps.
  EXPECT_GT(motes["peak_bytes_per_particle"].get<double>(), 20);
  for (const char* chart : {"out/bench/build.svg", "out/bench/build_memory.svg"}) {
    EXPECT_THAT(workspace_.read(chart), StartsWith("<svg "));
    EXPECT_THAT(workspace_.read(chart), Not(HasSubstr("\"nan")));
    EXPECT_THAT(workspace_.read(chart), HasSubstr("nanosphere_90k, Motes: "));
  }
}

TEST_F(Bench, BuildComparesWithEmbreeWhereItIs) {
  const Outcome outcome = measure("build nanosphere_90k");
  const auto row = result("build")["rows"][0];
  if (MOTES_EMBREE == 0) {
    EXPECT_THAT(outcome.out, HasSubstr("without Embree (script/bootstrap bench installs it"));
    EXPECT_TRUE(row["embree_morton"].is_null() && row["embree_default"].is_null());
    return;
  }
  EXPECT_THAT(outcome.out, HasSubstr("Embree 3."));
  const double particles = row["particles"];
  for (const char* key : {"embree_morton", "embree_default"}) {
    const auto& embree = row[key];
    const double nodes = embree["nodes"], leaves = embree["leaves"];
    // Up to sixteen particles a leaf and eight children a node; every node but the root is a child.
    EXPECT_GE(leaves * 16, particles) << key;
    EXPECT_LT(leaves * 4, particles) << key;
    EXPECT_LE(nodes + leaves - 1, 8 * nodes) << key;
    EXPECT_EQ(embree["tree_bytes"], nodes * 256 + (leaves + particles) * 4) << key;
    // The boxes alone are 32, less what the system has not counted yet.
    EXPECT_GT(embree["peak_bytes_per_particle"].get<double>(), 20) << key;
  }
  // Two ways of building are two trees, and the faster way counts.
  EXPECT_NE(row["embree_morton"]["nodes"], row["embree_default"]["nodes"]);
  EXPECT_NEAR(row["embree_morton_over_motes"].get<double>() * row["motes"]["build_s"].get<double>(),
              std::min(row["embree_morton"]["build_s"].get<double>(),
                       row["embree_morton"]["again_s"].get<double>()),
              1e-9);
}

TEST_F(Bench, SpheresComparesWithEmbreeWhereItIs) {
  const Outcome outcome = measure("spheres zeolite");
  EXPECT_EQ(outcome.err, "");
  const auto row = result("spheres")["rows"][0];
  EXPECT_EQ(row["balls"], 3456);
  ASSERT_EQ(row["views"].size(), 2U);
  for (const auto& view : row["views"]) {
    EXPECT_GT(view["hit"].get<double>(), 0.3);
    EXPECT_GT(view["motes"]["picture_ms"].get<double>(), 0);
    EXPECT_GT(view["motes"]["occlusion_rays"].get<double>(), 16 * 16 * 16 * 0.3);
    if (MOTES_EMBREE == 0) {
      EXPECT_TRUE(view["embree"].empty());
      continue;
    }
    ASSERT_EQ(view["embree"].size(), 9U);  // three qualities, three ways of handing over
    // Two that know nothing of each other see the same, but for rays that graze.
    EXPECT_LT(view["different"].get<double>(), 1e-3);
    const double unoccluded = view["motes"]["unoccluded"];
    double fastest = 1e9;
    for (const auto& embree : view["embree"]) {
      fastest = std::min(fastest, embree["picture_ms"].get<double>());
      if (embree["rays"] == "streams") continue;
      EXPECT_NEAR(embree["unoccluded"].get<double>(), unoccluded, 0.01 * unoccluded);
    }
    EXPECT_NEAR(view["embree_over_motes"].get<double>() * view["motes"]["picture_ms"].get<double>(),
                fastest, 1e-9);
  }
  EXPECT_THAT(workspace_.read("out/bench/spheres.svg"), StartsWith("<svg "));
}

TEST_F(Bench, LatticeHasFourSizes) {
  const Outcome outcome = measure("lattice");
  EXPECT_EQ(outcome.err, "");
  const auto rows = result("lattice")["rows"];
  ASSERT_EQ(rows.size(), 14U);  // far and close, with two opacities but for the largest
  std::set<std::size_t> sizes;
  for (const auto& row : rows) {
    sizes.insert(row["particles"].get<std::size_t>());
    EXPECT_EQ(row["sweep"]["samples"], row["coherent"]["samples"]) << row;
    EXPECT_NEAR(row["sweep_over_coherent"].get<double>(),
                row["coherent"]["frame_ms"].get<double>() / row["sweep"]["frame_ms"].get<double>(),
                1e-9);
  }
  EXPECT_EQ(sizes, (std::set<std::size_t>{27, 216, 1331, 19683}));
  EXPECT_THAT(workspace_.read("out/bench/lattice.svg"), Not(HasSubstr("nan")));
  EXPECT_THAT(failure(std::string("bench lattice --size 1024x1024 --memory 1") + data, 1),
              HasSubstr("lattice: 81746504 particles need 4.9 GiB of memory, and there are 1.0"));
}

TEST_F(Bench, RadiiComparesWithEqualOnesThatGiveAsManyEvaluations) {
  const Outcome outcome = measure("radii");
  EXPECT_EQ(outcome.err, "");
  const auto rows = result("radii")["rows"];
  ASSERT_EQ(rows.size(), 6U);
  for (const auto& row : rows) {
    EXPECT_EQ(row["particles"], 1000);
    EXPECT_LT(row["least_radius"], row["most_radius"]);
    for (const char* engine : {"sweep", "coherent"}) {
      const auto& pair = row[engine];
      const double adaptive = pair["adaptive_evaluations"], equal = pair["equal_evaluations"];
      // Within 3 % for the engine that is counted.
      EXPECT_NEAR(equal / adaptive, 1, std::string(engine) == "sweep" ? 0.03 : 1) << row;
      EXPECT_NEAR(pair["adaptive_over_equal"].get<double>(),
                  pair["adaptive"]["frame_ms"].get<double>() / adaptive /
                      (pair["equal"]["frame_ms"].get<double>() / equal),
                  1e-9);
    }
  }
  // As wide as they are said to be.
  const auto orders = [&](std::size_t row) {
    return std::log10(rows[row]["most_radius"].get<double>() /
                      rows[row]["least_radius"].get<double>());
  };
  EXPECT_GT(orders(0), 3.5);
  EXPECT_NEAR(orders(2), 4, 0.1);
  EXPECT_NEAR(orders(3), 8, 0.1);
  EXPECT_THAT(workspace_.read("out/bench/radii.svg"), Not(HasSubstr("nan")));
  EXPECT_THAT(failure(std::string("bench radii zeolite") + data, 1),
              HasSubstr("radii takes no scene; one is named"));
}

TEST_F(Bench, Fig6CutsOutOnePartAfterTheOther) {
  EXPECT_EQ(bench("scenes tryptophan").status, 0);
  const Outcome outcome = measure("fig6 tryptophan");
  EXPECT_EQ(outcome.err, "");
  const auto rows = result("fig6")["rows"];
  ASSERT_EQ(rows.size(), 4U);  // a thousand and all, with two supports each
  EXPECT_EQ(rows[0]["particles"], 1000);
  EXPECT_EQ(rows[1]["particles"], 1000);
  EXPECT_EQ(rows[3]["particles"], 6830);
  EXPECT_EQ(rows[0]["support_factor"], 2.05);
  EXPECT_EQ(rows[1]["support_factor"], 6.61);
  EXPECT_GT(rows[1]["sweep"]["kernel_evaluations"], rows[0]["sweep"]["kernel_evaluations"]);
  EXPECT_THAT(workspace_.read("out/bench/fig6.svg"), Not(HasSubstr("nan")));
}

TEST_F(Bench, Fig7EndsRaysEarlyAndLate) {
  measure("fig7 zeolite");
  const auto rows = result("fig7")["rows"];
  ASSERT_EQ(rows.size(), 2U * (8 + 3 + 5));
  EXPECT_EQ(rows[0]["termination_opacity"], 0.5);
  EXPECT_EQ(rows[7]["termination_opacity"], 1);
  EXPECT_LT(rows[0]["samples_per_ray"], rows[7]["samples_per_ray"]);
  EXPECT_THAT(workspace_.read("out/bench/fig7.svg"), HasSubstr("coherent, close"));
  EXPECT_THAT(workspace_.read("out/bench/fig7_passes.svg"), Not(HasSubstr("nan")));
}

TEST_F(Bench, ThreadsComparesSeveralWithOne) {
  const Outcome outcome = measure("threads zeolite --threads 3");
  EXPECT_THAT(outcome.out, HasSubstr("3 threads over one: "));
  const auto rows = result("threads")["rows"];
  ASSERT_EQ(rows.size(), 2U * 3);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    EXPECT_EQ(rows[i]["threads"], i % 3 + 1);
    EXPECT_EQ(rows[i]["frame"]["samples"], rows[i / 3 * 3]["frame"]["samples"]);
    EXPECT_NEAR(rows[i]["over_one_thread"].get<double>(),
                rows[i / 3 * 3]["frame"]["frame_ms"].get<double>() /
                    rows[i]["frame"]["frame_ms"].get<double>(),
                1e-9);
  }
}

TEST_F(Bench, Fig8AndFig9MakePictures) {
  measure("fig8 zeolite");
  measure("fig9 zeolite");
  const auto kappas = result("fig8")["rows"], sigmas = result("fig9")["rows"];
  ASSERT_EQ(kappas.size(), 3U);
  ASSERT_EQ(sigmas.size(), 5U);
  EXPECT_LT(kappas[0]["mean_opacity"], kappas[2]["mean_opacity"]);
  EXPECT_LT(sigmas[0]["sweep"]["kernel_evaluations"], sigmas[4]["sweep"]["kernel_evaluations"]);
  for (const auto& rows : {kappas, sigmas}) {
    for (const auto& row : rows) {
      EXPECT_THAT(workspace_.read(row["picture"]), StartsWith("\x89PNG")) << row;
    }
  }
}

TEST_F(Bench, ViewMovesLooksAndPicks) {
  const Outcome outcome = measure("view zeolite '" MOTES_SOURCE_DIR "/data/demo/cosmology.json'");
  EXPECT_EQ(outcome.err, "");
  const auto table = result("view");
  ASSERT_EQ(table["rows"].size(), 2U);
  EXPECT_EQ(table["rows"][0]["scene"], "zeolite");
  EXPECT_EQ(table["rows"][0]["particles"], 3494);
  EXPECT_EQ(table["rows"][1]["scene"], "cosmology");
  double slowest = 0;
  for (const auto& row : table["rows"]) {
    EXPECT_EQ(row["moves"], 120);  // each of them is seen in the end
    const auto& latency = row["latency_ms"];
    EXPECT_GT(latency["median"], 0);
    EXPECT_LE(latency["median"], latency["percentile_95"]);
    EXPECT_LE(latency["percentile_95"], latency["most"]);
    slowest = std::max(slowest, latency["percentile_95"].get<double>());
    EXPECT_GT(row["frames_per_second"], 0);
    EXPECT_GT(row["pixels"], 0);
    EXPECT_LE(row["pixels"], 1);
    EXPECT_GT(row["full_ms"], 0);
    EXPECT_GT(row["pick_ms"]["most"], 0);
  }
  EXPECT_EQ(table["summary"]["most_latency_ms_percentile_95"], slowest);
  EXPECT_THAT(workspace_.read("out/bench/view.svg"), HasSubstr("cosmology"));
  EXPECT_THAT(failure(std::string("bench table1 a.xyz") + data, 1),
              HasSubstr("table1 takes scenes by their names; 'a.xyz' is a file"));
}

TEST_F(Bench, ASceneTooLargeForTheMemoryIsRefusedFirst) {
  for (const std::string what :
       {"scenes", "table1", "table2", "fields", "build", "limit", "threads", "spheres"}) {
    EXPECT_THAT(failure("bench " + what + " tryptophan cosmology --memory 2" + data, 1),
                StartsWith("motes: error: cosmology: 82051072 particles need "));
  }
  EXPECT_FALSE(workspace_.exists("out/bench/scenes/tryptophan.npy"));
}

TEST_F(Bench, WrongCommandLines) {
  EXPECT_THAT(failure("bench", 2), HasSubstr("WHAT"));
  EXPECT_THAT(failure("bench table3", 2), HasSubstr("did you mean 'table"));
  EXPECT_THAT(failure("bench table2 --memory -1", 2),
              HasSubstr("--memory: expected a number greater than 0, found '-1'"));
  EXPECT_THAT(failure("bench scenes zeolit", 2), HasSubstr("did you mean 'zeolite'"));
  EXPECT_THAT(failure("bench table1 --scenes zeolite,fog", 2), HasSubstr("unknown scene 'fog'"));
  EXPECT_THAT(failure(std::string("bench fig6 zeolite tryptophan") + data, 1),
              HasSubstr("fig6 takes one scene; 2 are named"));
  EXPECT_THAT(failure("bench table1 --repeat 0", 2), HasSubstr("--repeat"));
  EXPECT_THAT(failure("bench table1 --size 5", 2), HasSubstr("--size"));
  EXPECT_THAT(failure("bench table1", 1),
              StartsWith("motes: error: data/bench: there is no such directory"));
}

TEST_F(Bench, AFileOfAnotherSceneIsRefused) {
  EXPECT_EQ(bench("scenes tryptophan").status, 0);
  workspace_.write("out/bench/scenes/tryptophan.npy", three_atoms);
  const Outcome outcome = bench("table1 tryptophan");
  EXPECT_EQ(outcome.status, 1);
  EXPECT_THAT(outcome.err, HasSubstr("has 3 particles; expected 6830"));
  EXPECT_FALSE(workspace_.exists("out/bench/table1.json"));
}

}  // namespace
}  // namespace motes
