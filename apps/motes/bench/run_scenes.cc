// motes bench scenes: makes the data.
#include <fmt/format.h>

#include <filesystem>

#include "core/stopwatch.h"
#include "motes/bench/benchmarks.h"

namespace motes {

void run_scenes(const BenchJob& job) {
  job.workplace.check_room(job.scenes);
  fmt::print("{:<16}{:>12}{:>9}{:>9}  {}\n", "scene", "particles", "MB", "s", "file");
  for (const BenchScene* scene : job.scenes) {
    const Stopwatch stopwatch;
    const std::size_t count = scene->is_made() ? job.workplace.make(*scene) : scene->particles;
    const std::filesystem::path file = job.workplace.particle_file(*scene);
    fmt::print("{:<16}{:>12}{:>9.1f}{:>9.1f}  {}{}\n", scene->name, count,
               static_cast<double>(std::filesystem::file_size(file)) / 1e6,
               stopwatch.milliseconds() / 1000, file.string(),
               scene->is_made() ? "" : " (bundled)");
    std::fflush(stdout);
  }
}

}  // namespace motes
