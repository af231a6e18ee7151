// Where a benchmark finds its data, puts its results, and whether there is room for them.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <vector>

#include "motes/bench/catalogue.h"
#include "scene/scene.h"

namespace motes {

class Workplace {
 public:
  /// Most that is in memory at once, for each particle: while its file is read, the file and
  /// positions in double precision. Measured: 59.
  static constexpr std::size_t rendering_bytes = 64;

  /// `data`: the directory data/bench. `output` is made where it is missing. `memory`: bytes that
  /// may be used; nullopt: what is free. Throws Error where there is no such data.
  Workplace(std::filesystem::path data, std::filesystem::path output,
            std::optional<std::size_t> memory);

  const std::filesystem::path& data() const { return data_; }
  /// A file of results.
  std::filesystem::path result(std::string_view name) const { return output_ / name; }
  std::filesystem::path scene_file(const BenchScene& scene) const;
  /// Where the particles are, made or bundled.
  std::filesystem::path particle_file(const BenchScene& scene) const;
  /// The scene file's scene, of the particles in particle_file().
  Scene open(const BenchScene& scene) const;

  /// Throws Error for the first of `scenes` for which there is not memory enough to make it, if it
  /// has to be made, and to work with it, or not disk enough. Making and rendering take up to
  /// rendering_bytes a particle.
  void check_room(const std::vector<const BenchScene*>& scenes,
                  std::size_t bytes_per_particle = rendering_bytes) const;
  /// Makes the particles of a scene and writes their file; returns how many there are.
  std::size_t make(const BenchScene& scene) const;
  /// Makes them unless they are there.
  void make_if_missing(const BenchScene& scene) const;

 private:
  std::filesystem::path data_, output_;
  std::optional<std::size_t> memory_;
};

}  // namespace motes
