// motes bench spheres: balls by Motes' one tree beside Embree's sphere geometry.
#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <numbers>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/stopwatch.h"
#include "motes/bench/chart.h"
#include "motes/bench/embree.h"
#include "motes/bench/embree_spheres.h"
#include "motes/bench/measure.h"
#include "motes/bench/report.h"
#include "motes/frame_times.h"
#include "surface/directions.h"
#include "surface/surface.h"
#include "surface/trace.h"

namespace motes {
namespace {

constexpr int tile_size = 64, occlusion_samples = 16;

/// Most that is in memory at once, for each ball: 73 of Embree's, what both are built from, and
/// what Embree's build takes besides.
constexpr std::size_t bytes_per_ball = 128;

/// Rays of a whole picture, in tiles.
struct Picture {
  SurfaceView view;
  RayGrid grid;  ///< a whole number of packets, which may be a little more than the picture

  Picture(const KernelSet& kernels, const Camera& camera, const BenchOptions& options) {
    const Vector3d eye = kernels.length_scale * (camera.eye - kernels.origin);
    view = {camera_axes(camera), {eye.x, eye.y, eye.z}, camera.orthographic_height.has_value()};
    const double half_v = half_height(camera) * (view.orthographic ? kernels.length_scale : 1);
    const double half_u = half_v * options.width / options.height;
    grid.du = 2 * half_u / options.width;
    grid.dv = -2 * half_v / options.height;
    grid.u = 0.5 * grid.du - half_u;
    grid.v = 0.5 * grid.dv + half_v;
    grid.width = (options.width + 7) / 8 * 8;
    grid.height = (options.height + 7) / 8 * 8;
  }

  int columns() const { return (grid.width + tile_size - 1) / tile_size; }
  int num_tiles() const { return columns() * ((grid.height + tile_size - 1) / tile_size); }
  RayGrid tile(int i) const {
    RayGrid tile = grid;
    tile.column = i % columns() * tile_size;
    tile.row = i / columns() * tile_size;
    tile.width = std::min(tile_size, grid.width - tile.column);
    tile.height = std::min(tile_size, grid.height - tile.row);
    return tile;
  }
};

/// Hits of all tiles.
using PictureHits = std::vector<SurfaceHits>;

/// trace(tile's grid, tile's hits) for all tiles in parallel; milliseconds.
template <class Trace>
double time_picture(const Picture& picture, PictureHits& hits, const Trace& trace) {
  hits.resize(static_cast<std::size_t>(picture.num_tiles()));
  const Stopwatch stopwatch;
  tbb::parallel_for(0, picture.num_tiles(),
                    [&](int i) { trace(picture.tile(i), hits[static_cast<std::size_t>(i)]); });
  return stopwatch.milliseconds();
}

/// What ambient occlusion asks: 16 rays from what every fourth pixel of every fourth row shows.
struct OcclusionTimes {
  double ms = 0;
  std::size_t rays = 0, unoccluded = 0;
  double mega_rays() const { return static_cast<double>(rays) / ms / 1000; }
};

/// count(point, directions) for each of the points, in parallel.
template <class Count>
OcclusionTimes time_occlusion(const Picture& picture, const PictureHits& hits, const Count& count) {
  static const std::vector<Vector3f> sky = cosine_directions(occlusion_samples, 0);
  std::atomic<std::size_t> points = 0, unoccluded = 0;
  const Stopwatch stopwatch;
  tbb::parallel_for(0, picture.num_tiles(), [&](int i) {
    const RayGrid grid = picture.tile(i);
    std::vector<Vector3f> directions;
    for (int k = 0; k < static_cast<int>(grid.size()); ++k) {
      const int column = grid.column + k % grid.width, row = grid.row + k / grid.width;
      const SurfaceHit hit = hits[static_cast<std::size_t>(i)][static_cast<std::size_t>(k)];
      if (column % 4 != 0 || row % 4 != 0 || !hit.any()) continue;
      const CameraAxes& axes = picture.view.axes;
      const Vector3d to =
          axes.forward + (grid.u + column * grid.du) * axes.x + (grid.v + row * grid.dv) * axes.y;
      const Vector3d normal(hit.normal);
      const Across sides = across(normal);
      directions.clear();
      for (const Vector3f& direction : directions_of(sky, pattern_number(column / 4, row / 4))) {
        const Vector3d d(direction);
        directions.emplace_back(d.x * sides.x + d.y * sides.y + d.z * normal);
      }
      const SurfacePoint point{picture.view.eye + hit.depth * to, hit.particle, hit.stick};
      unoccluded += static_cast<std::size_t>(count(point, directions));
      ++points;
    }
  });
  return {stopwatch.milliseconds(), points * occlusion_samples, unoccluded};
}

/// One way of tracing, measured.
struct Method {
  std::vector<double> picture_ms;
  OcclusionTimes occlusion;
  double median_ms() const { return median(picture_ms); }
  double mega_rays(const Picture& picture) const {
    return static_cast<double>(picture.grid.size()) / median_ms() / 1000;
  }
};

/// What is measured from one camera.
struct View {
  View(bool is_close, const Picture& its_picture) : close(is_close), picture(its_picture) {}

  bool close;
  Picture picture;
  Method motes;
  struct Embree {
    EmbreeBuild build;
    EmbreeRays rays;
    Method method;
  };
  std::vector<Embree> embree;
  double hit = 0;        ///< part of the rays that hit
  double different = 0;  ///< part whose depths differ by more than a thousandth of a radius
  PictureHits hits;

  std::string_view name() const { return close ? "close" : "far"; }
  const Embree& fastest() const {
    return *std::ranges::min_element(embree, {},
                                     [](const Embree& e) { return e.method.median_ms(); });
  }
  const Embree& fastest_occlusion() const {
    return *std::ranges::max_element(
        embree, {}, [](const Embree& e) { return e.method.occlusion.mega_rays(); });
  }
};

/// Builds, which are of all views.
struct Builds {
  double motes_ms = 0, reach_ms = 0;
  std::size_t motes_bytes = 0;
  struct Embree {
    EmbreeBuild build;
    double ms;
    std::size_t bytes;
  };
  std::vector<Embree> embree;
};

void measure_motes(const Surface& surface, View& view) {
  view.motes.picture_ms.push_back(
      time_picture(view.picture, view.hits, [&](const RayGrid& grid, SurfaceHits& hits) {
        trace(surface, view.picture.view, grid, hits);
      }));
}

/// Both in turn, frame by frame, after one that warms up.
void measure_view(const Surface& surface, const EmbreeSpheres* embree, EmbreeBuild build,
                  int repeat, View& view) {
  std::vector<View::Embree> methods;
  if (embree != nullptr) {
    for (const EmbreeRays rays : embree_rays) methods.push_back({build, rays, {}});
  }
  PictureHits hits;
  for (int round = -1; round < repeat; ++round) {
    if (round == 0) {
      view.motes.picture_ms.clear();
      for (auto& each : methods) each.method.picture_ms.clear();
    }
    measure_motes(surface, view);
    for (auto& each : methods) {
      each.method.picture_ms.push_back(
          time_picture(view.picture, hits, [&](const RayGrid& grid, SurfaceHits& out) {
            embree->trace(view.picture.view, grid, each.rays, out);
          }));
    }
  }
  view.motes.occlusion = time_occlusion(
      view.picture, view.hits, [&](const SurfacePoint& point, const auto& directions) {
        return num_unoccluded(surface, point, directions, std::numeric_limits<double>::infinity());
      });
  for (auto& each : methods) {
    if (each.rays == EmbreeRays::stream) continue;
    each.method.occlusion = time_occlusion(
        view.picture, view.hits, [&](const SurfacePoint& point, const auto& directions) {
          const float near = 1e-3f * surface.radius[point.particle];
          return embree->num_unoccluded(point.place, directions, near, each.rays);
        });
  }
  view.embree.insert(view.embree.end(), methods.begin(), methods.end());

  std::size_t any = 0, different = 0;
  for (std::size_t t = 0; t < view.hits.size(); ++t) {
    for (std::size_t i = 0; i < view.hits[t].depth.size(); ++i) {
      const SurfaceHit hit = view.hits[t][i];
      any += hit.any() ? 1 : 0;
      if (embree == nullptr) continue;
      const SurfaceHit other = hits[t][i];
      if (hit.any() != other.any()) {
        ++different;
      } else if (hit.any()) {
        const double radius = static_cast<double>(surface.radius[hit.particle]);
        different += std::abs(hit.depth - other.depth) > 1e-3 * radius + 1e-6 * hit.depth ? 1 : 0;
      }
    }
  }
  const auto rays = static_cast<double>(view.picture.grid.size());
  view.hit = static_cast<double>(any) / rays;
  view.different = static_cast<double>(different) / rays;
}

/// Balls of the kernels' radii.
std::vector<Sphere> spheres_of(const Surface& surface) {
  const KernelSet& kernels = *surface.kernels;
  std::vector<Sphere> spheres(kernels.size());
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    spheres[i] = {kernels.x[i], kernels.y[i], kernels.z[i], surface.radius[i]};
  }
  return spheres;
}

struct SceneResult {
  const BenchScene* scene;
  std::size_t balls;
  Builds builds;
  std::vector<View> views;
};

SceneResult measure_scene(const BenchJob& job, const BenchScene& entry, Console& console) {
  const PreparedScene prepared = prepare_bench_scene(job, entry, console);
  const KernelSet& kernels = prepared.renderer.kernels();
  Surface surface;
  surface.kernels = &kernels;
  surface.radius = kernels.radius;
  SceneResult result{&entry, kernels.size(), {}, {}};
  const Stopwatch stopwatch;
  fit_reach(surface);
  result.builds.reach_ms = stopwatch.milliseconds();
  result.builds.motes_ms = prepared.renderer.build_ms();
  result.builds.motes_bytes =
      kernels.particle_bytes() + kernels.bvh.bytes() + surface.reach.bytes();
  const Camera& camera = prepared.resolved.camera;
  result.views.emplace_back(false, Picture(kernels, camera, job.options));
  result.views.emplace_back(true, Picture(kernels, moved_closer(camera, entry.close), job.options));

  const std::vector<Sphere> spheres = spheres_of(surface);
  for (const EmbreeBuild build : embree_builds) {
    console.update("tracing balls", static_cast<double>(build) / embree_builds.size());
    const Stopwatch build_time;
    const auto embree = build_embree_spheres(spheres, build, job.options.threads);
    if (embree != nullptr) {
      result.builds.embree.push_back({build, build_time.milliseconds(), embree->bytes()});
    }
    for (View& view : result.views) {
      measure_view(surface, embree.get(), build, job.options.repeat, view);
    }
    if (embree == nullptr) break;
  }
  console.finish();
  return result;
}

void print(const SceneResult& result) {
  for (const View& view : result.views) {
    fmt::print("{:<16}{:<6}{:>10}{:>7.3f}  |{:>8.1f}{:>8.1f}{:>9.2f}  |", result.scene->name,
               view.name(), result.balls, view.hit, view.motes.median_ms(),
               view.motes.mega_rays(view.picture), view.motes.occlusion.mega_rays());
    if (!view.embree.empty()) {
      const View::Embree& best = view.fastest();
      const View::Embree& occlusion = view.fastest_occlusion();
      fmt::print("{:>8.1f}{:>8.1f}{:>16}{:>9.2f}{:>16}  |{:>7.2f}{:>10.2f}",
                 best.method.median_ms(), best.method.mega_rays(view.picture),
                 fmt::format("{}, {}", name_of(best.build), name_of(best.rays)),
                 occlusion.method.occlusion.mega_rays(),
                 fmt::format("{}, {}", name_of(occlusion.build), name_of(occlusion.rays)),
                 best.method.median_ms() / view.motes.median_ms(),
                 view.motes.occlusion.mega_rays() / occlusion.method.occlusion.mega_rays());
    }
    fmt::print("\n");
  }
  const auto per_ball = [&](std::size_t bytes) {
    return static_cast<double>(bytes) / static_cast<double>(result.balls);
  };
  fmt::print("  build: Motes {:.0f} ms and {:.0f} ms for reach, {:.1f} bytes a ball",
             result.builds.motes_ms, result.builds.reach_ms, per_ball(result.builds.motes_bytes));
  for (const auto& embree : result.builds.embree) {
    fmt::print("; Embree {} {:.0f} ms, {:.1f}", name_of(embree.build), embree.ms,
               per_ball(embree.bytes));
  }
  fmt::print("\n");
  std::fflush(stdout);
}

nlohmann::ordered_json to_json(const Method& method, const Picture& picture) {
  nlohmann::ordered_json out{{"picture_ms", method.median_ms()},
                             {"mega_rays_per_s", method.mega_rays(picture)},
                             {"occlusion_mega_rays_per_s", nullptr}};
  if (method.occlusion.rays > 0) {
    out["occlusion_mega_rays_per_s"] = method.occlusion.mega_rays();
    out["occlusion_rays"] = method.occlusion.rays;
    out["unoccluded"] = method.occlusion.unoccluded;
  }
  return out;
}

nlohmann::ordered_json to_json(const SceneResult& result) {
  nlohmann::ordered_json out{{"scene", result.scene->name},
                             {"balls", result.balls},
                             {"build",
                              {{"motes_ms", result.builds.motes_ms},
                               {"motes_reach_ms", result.builds.reach_ms},
                               {"motes_bytes", result.builds.motes_bytes},
                               {"embree", nlohmann::json::array()}}},
                             {"views", nlohmann::json::array()}};
  for (const auto& embree : result.builds.embree) {
    out["build"]["embree"].push_back(
        {{"quality", name_of(embree.build)}, {"ms", embree.ms}, {"bytes", embree.bytes}});
  }
  for (const View& view : result.views) {
    nlohmann::ordered_json row{{"view", view.name()},
                               {"hit", view.hit},
                               {"motes", to_json(view.motes, view.picture)},
                               {"embree", nlohmann::json::array()}};
    for (const View::Embree& embree : view.embree) {
      row["embree"].push_back(to_json(embree.method, view.picture));
      row["embree"].back()["quality"] = name_of(embree.build);
      row["embree"].back()["rays"] = name_of(embree.rays);
    }
    if (!view.embree.empty()) {
      row["different"] = view.different;
      row["embree_over_motes"] = view.fastest().method.median_ms() / view.motes.median_ms();
    }
    out["views"].push_back(row);
  }
  return out;
}

}  // namespace

void run_spheres(const BenchJob& job) {
  job.workplace.check_room(job.scenes, bytes_per_ball);
  const auto builder = make_embree_builder(job.options.threads);
  fmt::print("{}, {}\n\n", describe_measurement(job.options),
             builder != nullptr
                 ? fmt::format("Embree {}", builder->version())
                 : "without Embree (script/bootstrap bench installs it; then build Motes again)");
  fmt::print("{:<39}  |{:<25}  |{:<57}  |{}\n{:<16}{:<6}{:>10}{:>7}  |", "", " Motes",
             " Embree, its fastest", " Motes / Embree", "scene", "view", "balls", "hit");
  fmt::print("{:>8}{:>8}{:>9}  |{:>8}{:>8}{:>16}{:>9}{:>16}  |{:>7}{:>10}\n", "ms", "Mrays/s",
             "occl.", "ms", "Mrays/s", "", "occl.", "", "speed", "occl.");
  nlohmann::ordered_json rows = nlohmann::json::array();
  BarChart chart{"Balls", "million rays a second", {}, {{"Motes", {}}, {"Embree", {}}}, false};
  std::vector<double> ratios;
  for (const BenchScene* entry : job.scenes) {
    Console console;
    const SceneResult result = measure_scene(job, *entry, console);
    print(result);
    rows.push_back(to_json(result));
    for (const View& view : result.views) {
      chart.categories.push_back(fmt::format("{} {}", entry->name, view.name()));
      chart.series[0].values.emplace_back(view.motes.mega_rays(view.picture));
      std::optional<double> embree;
      if (!view.embree.empty()) {
        embree = view.fastest().method.mega_rays(view.picture);
        ratios.push_back(view.fastest().method.median_ms() / view.motes.median_ms());
      }
      chart.series[1].values.push_back(embree);
    }
  }
  if (!ratios.empty()) {
    fmt::print("\nMotes is {:.2f} times as fast as Embree in the geometric mean, {:.2f} at least\n",
               geometric_mean(ratios), *std::ranges::min_element(ratios));
  }
  write_results(job, "spheres", rows);
  write_result_file(job, "spheres.svg", to_svg(chart));
}

}  // namespace motes
