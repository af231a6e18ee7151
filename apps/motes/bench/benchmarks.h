// What `motes bench` can be asked for.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "motes/bench/catalogue.h"
#include "motes/bench/workplace.h"

namespace motes {

/// What the options of the command line say.
struct BenchOptions {
  int width = 1024, height = 1024;
  int repeat = 5;   ///< frames, or builds, of which the median is taken
  int threads = 0;  ///< 0: all
};

/// What one benchmark works with.
struct BenchJob {
  const Workplace& workplace;
  std::vector<const BenchScene*> scenes;
  std::vector<std::filesystem::path> files;  ///< further scenes, for `view` alone
  BenchOptions options;
};

void run_scenes(const BenchJob& job);
void run_table1(const BenchJob& job);
void run_build(const BenchJob& job);
void run_table2(const BenchJob& job);
void run_fields(const BenchJob& job);
void run_kernels(const BenchJob& job);
void run_limit(const BenchJob& job);
void run_lattice(const BenchJob& job);  ///< makes its own particles, as radii does
void run_radii(const BenchJob& job);
void run_quality(const BenchJob& job);  ///< of a part of sio2
void run_threads(const BenchJob& job);
void run_spheres(const BenchJob& job);
void run_fig6(const BenchJob& job);
void run_fig7(const BenchJob& job);
void run_fig8(const BenchJob& job);
void run_fig9(const BenchJob& job);
void run_view(const BenchJob& job);  ///< of the demo scenes, where none is named

}  // namespace motes
