// `motes bench` where the benchmarks are not built.
#include <CLI/CLI.hpp>

#include "core/error.h"
#include "motes/commands.h"

namespace motes {

void add_bench_command(CLI::App& program) {
  CLI::App* command = program.add_subcommand("bench", "Measure speed (left out of this build).");
  command->allow_extras();
  command->callback([] {
    throw Error(
        "motes bench: left out of this build, expected one with the CMake option "
        "MOTES_BENCH=ON");
  });
}

}  // namespace motes
