// Scenes ready to be rendered, and how long their frames take.
#pragma once

#include <cstdint>
#include <limits>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "motes/bench/benchmarks.h"
#include "motes/console.h"
#include "motes/input.h"
#include "motes/prepare.h"
#include "render/renderer.h"

namespace motes {

/// Reads the particles of a scene, which are made first where they are missing. Throws Error where
/// the file holds another number of them than the scene should have.
Input read_bench_particles(const BenchJob& job, const BenchScene& scene, Console& console);

/// The scene of these particles, ready, in the size of the job.
PreparedScene prepare_bench_scene(const BenchJob& job, const BenchScene& scene, const Input& input,
                                  Console& console);
/// The same, of the particles that it reads.
PreparedScene prepare_bench_scene(const BenchJob& job, const BenchScene& scene, Console& console);

/// What results say first: the scene, its view ("far" or "close"), and the files of both.
nlohmann::ordered_json describe_view(const BenchJob& job, const BenchScene& scene,
                                     std::string_view view);

/// `camera` gone towards its target until `fraction` of the distance is left.
Camera moved_closer(const Camera& camera, double fraction);

/// One way of rendering to be measured.
struct Variant {
  const Renderer* renderer;  ///< outlives the variant
  ResolvedScene scene;
  std::optional<int> samples_per_pass = std::nullopt;  ///< see RenderOptions
  /// A warm-up frame that takes longer is the only one, and counts.
  double patience_ms = std::numeric_limits<double>::infinity();
  int threads = 0;            ///< 0: those of the options
  bool count_inside = false;  ///< fills FrameTimes::evaluations_inside, by a frame of its own
};

/// `scene` with sweep, then with coherent.
std::vector<Variant> engine_variants(const Renderer& renderer, const ResolvedScene& scene);

struct FrameTimes {
  double median_ms = 0, min_ms = 0;
  int frames = 0;
  std::uint64_t samples = 0, kernel_evaluations = 0;
  std::uint64_t evaluations_inside = 0;  ///< 0 where they are not counted
  StageTicks stages;                     ///< of the timed frames together
  double opacity = 0;                    ///< mean of the pixels in which there is anything
  double samples_per_ray = 0;            ///< the mean of all pixels
  int threads = 0;

  double fps() const { return 1000 / median_ms; }
};

nlohmann::ordered_json to_json(const FrameTimes& times);

/// Times `variants` in turn, frame by frame, so that whatever else the machine does meets them
/// alike; each is warmed up by a frame. One result a variant.
std::vector<FrameTimes> measure_frames(const std::vector<Variant>& variants,
                                       const BenchOptions& options, Console& console);

double geometric_mean(const std::vector<double>& values);

}  // namespace motes
