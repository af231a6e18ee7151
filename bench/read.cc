// How fast a LAMMPS dump is read, in MB/s, beside ASE in the same run:
//   cmake --build --preset release --target bench_read && build/release/bench/bench_read
// Writes a dump of 5 million atoms (id type x y z vx vy vz) made from a fixed seed, reads it with
// Motes (median of five reads, the file in the page cache), then a dump of 100,000 atoms with ASE
// (Debian's python3-ase; median of three), and prints the ratio.
#include <fmt/format.h>
#include <fmt/os.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <random>

#include "core/error.h"
#include "core/stopwatch.h"
#include "io/reader.h"

namespace motes {
namespace {

constexpr std::size_t num_atoms = 5'000'000;
constexpr std::size_t num_ase_atoms = 100'000;
constexpr double megabyte = 1e6;

void write_dump(const std::filesystem::path& path, std::size_t n) {
  auto out = fmt::output_file(path.string());
  out.print("ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n{}\nITEM: BOX BOUNDS pp pp pp\n", n);
  for (int axis = 0; axis < 3; ++axis) out.print("{:.16e} {:.16e}\n", 0.0, 400.0);
  out.print("ITEM: ATOMS id type x y z vx vy vz\n");
  std::mt19937_64 random(1);
  // (Distributions differ between standard libraries; these bits do not.)
  const auto uniform = [&] { return static_cast<double>(random() >> 11U) * 0x1p-53; };
  for (std::size_t i = 0; i < n; ++i) {
    out.print("{} {} {:g} {:g} {:g} {:g} {:g} {:g}\n", i + 1, i % 3 == 0 ? 1 : 2, 400 * uniform(),
              400 * uniform(), 400 * uniform(), uniform() - 0.5, uniform() - 0.5, uniform() - 0.5);
  }
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

double seconds_of_motes(const std::filesystem::path& path) {
  const Stopwatch stopwatch;
  const ReadOptions options;
  const ParticleSet particles = open_trajectory(path, options)->read_frame(0);
  const double seconds = stopwatch.milliseconds() / 1000;
  if (particles.size() != num_atoms) throw Error(path, "read another number of atoms than written");
  return seconds;
}

double seconds_of_ase(const std::filesystem::path& path) {
  const std::string command =
      fmt::format("/usr/bin/python3 '{}' '{}'", MOTES_BENCH_DIR "/read_ase.py", path.string());
  std::FILE* pipe = ::popen(command.c_str(), "r");
  double seconds = 0;
  unsigned long found = 0;
  const bool ran = pipe != nullptr && std::fscanf(pipe, "%lf %lu", &seconds, &found) == 2;
  if (pipe != nullptr) ::pclose(pipe);
  if (!ran || found != num_ase_atoms) throw Error("ASE could not read; is python3-ase installed?");
  return seconds;
}

template <class F>
double rate(const std::filesystem::path& path, int repeats, F&& seconds_of) {
  std::vector<double> seconds;
  seconds.reserve(static_cast<std::size_t>(repeats));
  for (int i = 0; i < repeats; ++i) seconds.push_back(seconds_of(path));
  const double size = static_cast<double>(std::filesystem::file_size(path)) / megabyte;
  return size / median(seconds);
}

void run(const std::filesystem::path& directory) {
  const auto large = directory / "large.dump", small = directory / "small.dump";
  write_dump(large, num_atoms);
  write_dump(small, num_ase_atoms);
  const double motes_rate = rate(large, 5, seconds_of_motes);
  fmt::print("Motes: {} atoms, {:.0f} MB, {:.0f} MB/s\n", num_atoms,
             static_cast<double>(std::filesystem::file_size(large)) / megabyte, motes_rate);
  const double ase_rate = rate(small, 3, seconds_of_ase);
  fmt::print("ASE:   {} atoms, {:.1f} MB, {:.1f} MB/s\n", num_ase_atoms,
             static_cast<double>(std::filesystem::file_size(small)) / megabyte, ase_rate);
  fmt::print("ratio: {:.0f}\n", motes_rate / ase_rate);
}

}  // namespace
}  // namespace motes

int main() {
  const auto directory =
      std::filesystem::temp_directory_path() / fmt::format("motes-bench-read-{}", ::getpid());
  std::filesystem::create_directories(directory);
  int status = EXIT_SUCCESS;
  try {
    motes::run(directory);
  } catch (const std::exception& error) {
    fmt::print(stderr, "bench_read: error: {}\n", error.what());
    status = EXIT_FAILURE;
  }
  std::filesystem::remove_all(directory);
  return status;
}
