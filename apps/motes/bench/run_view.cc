// motes bench view: the viewer's server and a client of it on one machine: what comes of moving the
// mouse, and when.
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/error.h"
#include "document/input.h"
#include "motes/bench/chart.h"
#include "motes/bench/hand.h"
#include "motes/bench/measure.h"
#include "motes/bench/report.h"
#include "motes/frame_times.h"

namespace motes {
namespace {

/// Something to look at.
struct ViewedScene {
  std::string name;
  std::filesystem::path file;
  Scene scene;
};

std::vector<std::filesystem::path> demo_scenes(const Workplace& workplace) {
  const std::filesystem::path demo = workplace.data() / "../demo";
  std::vector<std::filesystem::path> files;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(demo, error)) {
    if (entry.path().extension() == ".json") files.push_back(entry.path().lexically_normal());
  }
  if (files.empty()) throw Error(demo, "expected Motes' demo scenes there");
  std::ranges::sort(files);
  return files;
}

std::vector<ViewedScene> scenes_of(const BenchJob& job) {
  job.workplace.check_room(job.scenes);
  std::vector<ViewedScene> scenes;
  for (const BenchScene* entry : job.scenes) {
    job.workplace.make_if_missing(*entry);
    scenes.push_back(
        {std::string(entry->name), job.workplace.scene_file(*entry), job.workplace.open(*entry)});
  }
  const bool none_named = job.scenes.empty() && job.files.empty();
  for (const auto& file : none_named ? demo_scenes(job.workplace) : job.files) {
    scenes.push_back({file.stem().string(), file, open_scene(file)});
  }
  return scenes;
}

/// One scene's drags together. Times in ms, of which the median counts unless another is named.
struct Row {
  std::size_t particles = 0;
  std::vector<double> latencies, renders, encodes, decodes, pixels, full, picks;
  std::size_t frames = 0;  ///< while dragging
  double seconds = 0;      ///< of dragging

  double frames_per_second() const { return static_cast<double>(frames) / seconds; }
};

Row measure(const ViewedScene& viewed, const BenchOptions& options) {
  const server::BackgroundServer server({}, viewed.file.parent_path(),
                                        {viewed.name, [scene = viewed.scene] { return scene; }});
  Hand hand(server, options.width, options.height);
  Row row;
  row.particles = hand.num_particles();
  const auto append = [](std::vector<double>& to, const std::vector<double>& values) {
    to.insert(to.end(), values.begin(), values.end());
  };
  for (int i = 0; i < options.repeat; ++i) {
    const DragTimes drag = hand.drag();
    append(row.latencies, drag.latencies);
    append(row.renders, drag.renders);
    append(row.encodes, drag.encodes);
    append(row.decodes, drag.decodes);
    append(row.pixels, drag.pixels);
    row.full.push_back(drag.full);
    row.frames += drag.frames;
    row.seconds += drag.dragged / 1000;
    append(row.picks, hand.pick());
  }
  return row;
}

void print_header() {
  fmt::print("{:<20}{:>10}  |{:>20}  |{:>8}{:>8}{:>8}{:>8}{:>8}  |{:>9}{:>8}\n", "", "",
             "latency, ms", "frames", "pixels", "render", "encode", "decode", "full", "pick");
  fmt::print("{:<20}{:>10}  |{:>8}{:>6}{:>6}  |{:>8}{:>8}{:>8}{:>8}{:>8}  |{:>9}{:>8}\n", "scene",
             "particles", "median", "95%", "most", "per s", "part", "ms", "ms", "ms", "ms", "ms");
}

void print(const ViewedScene& viewed, const Row& row) {
  fmt::print("{:<20}{:>10}  |{:>8.0f}{:>6.0f}{:>6.0f}  |{:>8.1f}{:>8.2f}{:>8.1f}{:>8.1f}{:>8.1f}",
             viewed.name, row.particles, median(row.latencies), percentile(row.latencies, 0.95),
             percentile(row.latencies, 1), row.frames_per_second(), median(row.pixels),
             median(row.renders), median(row.encodes), median(row.decodes));
  fmt::print("  |{:>9.0f}{:>8}\n", median(row.full),
             row.picks.empty() ? "-" : fmt::format("{:.1f}", percentile(row.picks, 1)));
  std::fflush(stdout);
}

nlohmann::ordered_json to_json(const ViewedScene& viewed, const Row& row) {
  nlohmann::ordered_json pick;
  if (!row.picks.empty()) {
    pick = {{"median", median(row.picks)}, {"most", percentile(row.picks, 1)}};
  }
  return {{"scene", viewed.name},
          {"scene_file", viewed.file.string()},
          {"data", viewed.scene.data_path.string()},
          {"particles", row.particles},
          {"moves", row.latencies.size()},
          {"latency_ms",
           {{"median", median(row.latencies)},
            {"percentile_95", percentile(row.latencies, 0.95)},
            {"most", percentile(row.latencies, 1)}}},
          {"frames_per_second", row.frames_per_second()},
          {"pixels", median(row.pixels)},
          {"render_ms", median(row.renders)},
          {"encode_ms", median(row.encodes)},
          {"decode_ms", median(row.decodes)},
          {"full_ms", median(row.full)},
          {"pick_ms", pick}};
}

}  // namespace

void run_view(const BenchJob& job) {
  const std::vector<ViewedScene> scenes = scenes_of(job);
  fmt::print("{}, {} x {}, {} drags of two seconds, 60 moves a second\n\n",
             machine_line(job.options), job.options.width, job.options.height, job.options.repeat);
  print_header();
  nlohmann::ordered_json results = nlohmann::json::array();
  BarChart chart{"From the mouse's move to the picture", "ms", {}, {}, false};
  chart.series = {{"median", {}}, {"95 %", {}}};
  double slowest = 0, fewest = std::numeric_limits<double>::infinity();
  for (const ViewedScene& viewed : scenes) {
    const Row row = measure(viewed, job.options);
    print(viewed, row);
    results.push_back(to_json(viewed, row));
    const double late = percentile(row.latencies, 0.95);
    chart.categories.push_back(viewed.name);
    chart.series[0].values.emplace_back(median(row.latencies));
    chart.series[1].values.emplace_back(late);
    slowest = std::max(slowest, late);
    fewest = std::min(fewest, row.frames_per_second());
  }
  fmt::print("\n95 % of the moves are seen within {:.0f} ms, at {:.1f} frames a second or more\n",
             slowest, fewest);
  write_results(job, "view", results,
                {{"most_latency_ms_percentile_95", slowest}, {"least_frames_per_second", fewest}});
  write_result_file(job, "view.svg", to_svg(chart));
}

}  // namespace motes
