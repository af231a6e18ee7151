// The scenes of the benchmark, with what the paper says of theirs.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "particles/particle_set.h"

namespace motes {

/// Frames a second.
struct FarClose {
  double far = 0, close = 0;
};

/// What the paper reports of its data set of that name (Tables 1 and 2).
struct PaperFigures {
  std::string_view name;
  double particles = 0;
  double size_mb = 0;    ///< of a file
  double memory_mb = 0;  ///< geometry
  double tree_mb = 0;
  double build_s = 0;           ///< one thread of a Xeon E5-2680
  std::optional<FarClose> cpu;  ///< its 16 cores, two Xeon E5-2680
  std::optional<FarClose> mic;  ///< its Xeon Phi SE10P
  // The same of structured volumes, one voxel an angstrom.
  std::optional<FarClose> structured_cpu = std::nullopt, structured_mic = std::nullopt;
  // Nanovol's, on a GPU.
  std::optional<FarClose> nanovol = std::nullopt, structured_nanovol = std::nullopt;
};

struct BenchScene {
  std::string_view name;
  std::size_t particles;
  /// Makes the particles from the files in `data`, the directory data/bench; null where the scene
  /// file names bundled ones.
  ParticleSet (*make)(const std::filesystem::path& data);
  /// Bytes a particle of the file that is made.
  std::size_t row_bytes;
  /// The close camera stands at this fraction of the far one's distance from the target.
  double close;
  PaperFigures paper;

  bool is_made() const { return make != nullptr; }
};

/// All scenes, from the smallest to the largest.
const std::vector<BenchScene>& bench_scenes();

/// Those of that name, in the order of bench_scenes(); all where there is no name. Throws Error
/// that names the nearest.
std::vector<const BenchScene*> find_bench_scenes(const std::vector<std::string>& names);

}  // namespace motes
