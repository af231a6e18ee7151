// motes bench quality: pictures of a field resampled into grids beside those of the field itself,
// the paper's Figure 1.
#include <fmt/format.h>

#include <algorithm>
#include <deque>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/stopwatch.h"
#include "image/compare.h"
#include "image/write_image.h"
#include "motes/bench/grids.h"
#include "motes/bench/measure.h"
#include "motes/bench/report.h"

namespace motes {
namespace {

struct Way {
  std::string_view name;
  Reconstruction reconstruction;
};
constexpr Way ways[] = {{"trilinear", Reconstruction::trilinear},
                        {"tricubic", Reconstruction::tricubic},
                        {"tricubic_smoothing", Reconstruction::tricubic_smoothing}};
constexpr double voxel_sizes[] = {1, 0.5, 0.25};

/// A row of the table: the field itself, or a grid of it. Errors are those of the picture to the
/// field's.
struct Row {
  std::string name;
  std::optional<double> voxel_size = {};
  std::size_t bytes = 0;  ///< that the picture is made of
  double resample_ms = 0, build_ms = 0, frame_ms = 0;
  double rms = 0, max = 0;  ///< of linear channels
  std::optional<double> signal_to_noise = {};
  std::string picture = {};
};

std::filesystem::path scene_file(const BenchJob& job) {
  return job.workplace.data() / "quality.json";
}

/// The piece of the fracture around the crack's tip.
Scene quality_scene(const BenchJob& job, const BenchScene& silica) {
  Scene scene = read_scene(scene_file(job));
  job.workplace.make_if_missing(silica);
  scene.data_path = job.workplace.particle_file(silica);
  scene.render.width = job.options.width;
  scene.render.height = job.options.height;
  return scene;
}

/// `images`, of one size, side by side with a gap between them.
Framebuffer beside(const std::vector<Framebuffer>& images) {
  constexpr int gap = 8;
  const int width = images.front().width, height = images.front().height;
  const int count = static_cast<int>(images.size());
  Framebuffer all(count * (width + gap) - gap, height);
  for (int n = 0; n < count; ++n) {
    const Framebuffer& image = images[static_cast<std::size_t>(n)];
    for (int y = 0; y < height; ++y) {
      std::copy_n(image.pixel(0, y), 4 * width, all.pixel(n * (width + gap), y));
    }
  }
  return all;
}

/// The pictures, and what is written of them.
class Comparison {
 public:
  Comparison(const BenchJob& job, const ResolvedScene& scene) : job_(job), scene_(scene) {}

  /// Compares with the first picture that is added, and writes `image`.
  void add(Row row, const Framebuffer& image) {
    const double termination = scene_.render.termination_opacity;
    const Color& background = scene_.render.background;
    const DisplayImage shown = to_display(image, termination, background);
    if (rows.empty()) {
      truth_ = image;
      shown_truth_ = shown;
    } else {
      const ImageDifference difference = compare_images(image, truth_);
      row.rms = difference.rms;
      row.max = difference.max;
      row.signal_to_noise = peak_signal_to_noise(shown_truth_, shown);
    }
    const std::string voxels = row.voxel_size ? fmt::format("_{:g}", *row.voxel_size) : "";
    row.picture = write(row.name + voxels + ".png", image);
    print(row);
    rows.push_back(std::move(row));
  }

  /// Writes a picture of that name; returns its path.
  std::string write(const std::string& name, const Framebuffer& image) const {
    const auto path = job_.workplace.result("quality_" + name);
    write_image(path, image, scene_.render.termination_opacity, scene_.render.background);
    return path.string();
  }

  std::vector<Row> rows;

 private:
  static void print(const Row& row) {
    const auto or_dash = [](std::string_view format, const std::optional<double>& value) {
      return value ? fmt::format(fmt::runtime(format), *value) : "-";
    };
    fmt::print("{:<20}{:>7}{:>12.2f}{:>11.1f}{:>10.1f}{:>10.1f}{:>10.5f}{:>9.4f}{:>9}  {}\n",
               row.name, or_dash("{:g}", row.voxel_size), static_cast<double>(row.bytes) / 1e6,
               row.resample_ms, row.build_ms, row.frame_ms, row.rms, row.max,
               or_dash("{:.1f}", row.signal_to_noise), row.picture);
    std::fflush(stdout);
  }

  const BenchJob& job_;
  const ResolvedScene& scene_;
  Framebuffer truth_;
  DisplayImage shown_truth_;
};

nlohmann::ordered_json to_json(const Row& row) {
  nlohmann::ordered_json out{{"reconstruction", row.name},
                             {"voxel_size", nullptr},
                             {"bytes", row.bytes},
                             {"resample_ms", row.resample_ms},
                             {"build_ms", row.build_ms},
                             {"frame_ms", row.frame_ms},
                             {"rms", row.rms},
                             {"max", row.max},
                             {"peak_signal_to_noise_db", nullptr},
                             {"picture", row.picture}};
  if (row.voxel_size) out["voxel_size"] = *row.voxel_size;
  if (row.signal_to_noise) out["peak_signal_to_noise_db"] = *row.signal_to_noise;
  return out;
}

/// All reconstructions of the grids of one voxel size; returns the pictures, one a way.
std::vector<Framebuffer> add_grids(const BenchJob& job, const PreparedScene& prepared,
                                   double voxel_size, Comparison& comparison, Console& console) {
  const KernelSet& kernels = prepared.renderer.kernels();
  const Lattice lattice = lattice_of_size(kernels.box(), voxel_size);
  // With the copies that are sampled.
  expect_to_fit(lattice, (1 + std::size(ways)) * kernels.fields.size(), job.workplace.memory());
  const Stopwatch stopwatch;
  const auto grids = resample_all(kernels, lattice);
  const double resample_ms = stopwatch.milliseconds();
  std::deque<Renderer> renderers;
  std::vector<Variant> variants;
  for (const Way& way : ways) {
    renderers.push_back(make_grid_renderer(grids, way.reconstruction));
    variants.push_back({&renderers.back(), prepared.resolved});
    variants.back().patience_ms = 500;  // so that all of them take about a minute
  }
  const std::vector<FrameTimes> times = measure_frames(variants, job.options, console);
  std::vector<Framebuffer> images;
  for (std::size_t i = 0; i < std::size(ways); ++i) {
    images.push_back(renderers[i].render(prepared.resolved, {job.options.threads, {}, nullptr}));
    comparison.add({.name = std::string(ways[i].name),
                    .voxel_size = voxel_size,
                    .bytes = grid_bytes(renderers[i]),
                    .resample_ms = resample_ms,
                    .build_ms = renderers[i].build_ms(),
                    .frame_ms = times[i].median_ms},
                   images.back());
  }
  return images;
}

/// Both fields of all of the data in voxels of 1.
struct WholeGrid {
  double bytes = 0, resample_ms = 0;
};

WholeGrid resample_whole(const BenchJob& job, const BenchScene& silica, Console& console) {
  Scene scene = quality_scene(job, silica);
  for (Field& field : scene.fields) field.select.expression.clear();
  const PreparedScene prepared = read_and_prepare_scene(scene, scene_file(job), {}, console);
  const KernelSet& kernels = prepared.renderer.kernels();
  const Lattice lattice = lattice_of_size(kernels.box(), 1);
  expect_to_fit(lattice, kernels.fields.size(), job.workplace.memory());
  const Stopwatch stopwatch;
  resample_all(kernels, lattice);
  return {sample_bytes(lattice, kernels.fields.size()), stopwatch.milliseconds()};
}

/// Beside what the caption of the paper's Figure 1 says: SiO2, two fields, 1024 x 1024 pixels, the
/// same step and sigma; frames on a Xeon Phi SE10P, the grid by 16 cores.
void print_beside_paper(const WholeGrid& whole) {
  constexpr double field = 3.1, trilinear = 2.1, tricubic = 0.221;  // frames a second
  fmt::print(
      "\nall of the data in voxels of 1: {:.0f} MB, resampled in {:.2f} s\n"
      "the paper's Figure 1: 800 MB, 80 s on 16 cores; frames of {:.0f} ms (field), {:.0f} ms "
      "(trilinear) and {:.0f} ms (tricubic) on a Xeon Phi\n",
      whole.bytes / 1e6, whole.resample_ms / 1e3, 1e3 / field, 1e3 / trilinear, 1e3 / tricubic);
}

}  // namespace

void run_quality(const BenchJob& job) {
  const BenchScene& silica = *find_bench_scenes({"sio2"}).front();
  job.workplace.check_room({&silica});
  Console console;
  const PreparedScene prepared =
      read_and_prepare_scene(quality_scene(job, silica), scene_file(job), {}, console);
  const Renderer& renderer = prepared.renderer;
  fmt::print("{}\n{} particles in {} fields, step {:g}\n\n", describe_measurement(job.options),
             renderer.kernels().size(), renderer.kernels().fields.size(),
             prepared.resolved.step_size);
  fmt::print("{:<20}{:>7}{:>12}{:>11}{:>10}{:>10}{:>10}{:>9}{:>9}  {}\n", "", "voxels", "memory,",
             "resample,", "build,", "frame,", "rms", "largest", "PSNR,", "");
  fmt::print("{:<20}{:>7}{:>12}{:>11}{:>10}{:>10}{:>10}{:>9}{:>9}  {}\n", "drawn from", "of", "MB",
             "ms", "ms", "ms", "error", "error", "dB", "picture");
  Comparison comparison(job, prepared.resolved);
  const FrameTimes times =
      measure_frames({{&renderer, prepared.resolved}}, job.options, console)[0];
  const Framebuffer truth =
      renderer.render(prepared.resolved, {job.options.threads, std::nullopt, nullptr});
  comparison.add({.name = "field",
                  .bytes = renderer.kernels().particle_bytes() + renderer.kernels().bvh.bytes(),
                  .build_ms = renderer.build_ms(),
                  .frame_ms = times.median_ms},
                 truth);

  std::vector<Framebuffer> figure{truth};
  for (const double voxel_size : voxel_sizes) {
    const std::vector<Framebuffer> images =
        add_grids(job, prepared, voxel_size, comparison, console);
    // As in the paper's figure: the field, trilinear and tricubic from one voxel an angstrom.
    if (voxel_size == 1) figure.insert(figure.end(), images.begin(), images.begin() + 2);
  }
  const WholeGrid whole = resample_whole(job, silica, console);
  print_beside_paper(whole);
  const Framebuffer side_by_side = beside(figure);
  fmt::print("\nside by side, the field and of voxels of 1 trilinear and tricubic: {}, {}\n",
             comparison.write("figure1.png", side_by_side),
             comparison.write("figure1.jpg", side_by_side));
  nlohmann::ordered_json rows = nlohmann::json::array();
  for (const Row& row : comparison.rows) rows.push_back(to_json(row));
  write_results(job, "quality", rows,
                {{"particles", renderer.kernels().size()},
                 {"fields", renderer.kernels().fields.size()},
                 {"step_size", prepared.resolved.step_size},
                 {"data", job.workplace.particle_file(silica).string()},
                 {"scene_file", scene_file(job).string()},
                 {"whole_bytes", whole.bytes},
                 {"whole_resample_ms", whole.resample_ms}});
}

}  // namespace motes
