// Memory and disk are asked for before anything is made.
#include "motes/bench/workplace.h"

#include <fmt/format.h>

#include <string>

#include "core/atomic_file.h"
#include "core/error.h"
#include "core/memory.h"
#include "motes/bench/particle_file.h"

namespace motes {
namespace {

constexpr double gibibyte = 1024.0 * 1024 * 1024;

}  // namespace

Workplace::Workplace(std::filesystem::path data, std::filesystem::path output,
                     std::optional<std::size_t> memory)
    : data_(std::move(data)), output_(std::move(output)), memory_(memory) {
  std::error_code error;
  if (!std::filesystem::is_directory(data_, error)) {
    throw Error(data_,
                "there is no such directory; expected Motes' data/bench (name another by --data)");
  }
  std::filesystem::create_directories(output_ / "scenes", error);
  if (error) throw Error(output_, fmt::format("cannot be made: {}", error.message()));
}

std::size_t Workplace::memory() const { return memory_ ? *memory_ : available_memory(); }

std::filesystem::path Workplace::scene_file(const BenchScene& scene) const {
  return data_ / fmt::format("{}.json", scene.name);
}

std::filesystem::path Workplace::particle_file(const BenchScene& scene) const {
  if (scene.is_made()) return output_ / "scenes" / fmt::format("{}.npy", scene.name);
  return read_scene(scene_file(scene)).data_path;
}

Scene Workplace::open(const BenchScene& scene) const {
  Scene opened = read_scene(scene_file(scene));
  opened.data_path = particle_file(scene);
  return opened;
}

void Workplace::check_room(const std::vector<const BenchScene*>& scenes,
                           std::size_t bytes_per_particle) const {
  const std::size_t available = memory();
  std::size_t disk = 0;
  for (const BenchScene* scene : scenes) {
    const std::size_t needed = scene->particles * bytes_per_particle;
    if (needed > available) {
      throw Error(
          fmt::format("{}: {} particles need {:.1f} GiB of memory, and there are {:.1f}; "
                      "choose other scenes by --scenes",
                      scene->name, scene->particles, static_cast<double>(needed) / gibibyte,
                      static_cast<double>(available) / gibibyte));
    }
    if (scene->is_made() && !std::filesystem::exists(particle_file(*scene))) {
      disk += scene->particles * scene->row_bytes;
    }
  }
  std::error_code error;
  const std::filesystem::space_info space = std::filesystem::space(output_, error);
  if (!error && disk > space.available) {
    throw Error(output_, fmt::format("the scenes need {:.1f} GiB of disk, and there are {:.1f}",
                                     static_cast<double>(disk) / gibibyte,
                                     static_cast<double>(space.available) / gibibyte));
  }
}

std::size_t Workplace::make(const BenchScene& scene) const {
  AtomicFile file(particle_file(scene));
  const ParticleSet particles = scene.make(data_);
  write_npy_particles(file, particles);
  file.commit();
  return particles.size();
}

void Workplace::make_if_missing(const BenchScene& scene) const {
  if (!scene.is_made() || std::filesystem::exists(particle_file(scene))) return;
  fmt::print(stderr, "motes: making {} ({} particles)\n", particle_file(scene).string(),
             scene.particles);
  make(scene);
}

}  // namespace motes
