// motes: the command line. Exit status 0; 1 for a failure; 2 for a wrong command line.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <new>
#include <string>

#include "core/error.h"
#include "motes/commands.h"

namespace {

constexpr const char* examples = R"(Examples:
  motes render silica.lammpstrj -o silica.png
  motes render snapshot_042.hdf5 -o box.png --transfer-function magma
  motes info silica.lammpstrj
  motes probe silica.lammpstrj --points points.csv -o values.csv

'motes COMMAND --help' tells more about each. A scene file (docs/scene.md) may stand
wherever a FILE of particles does.)";

int report(const std::string& message, int status) {
  fmt::print(stderr, "motes: error: {}\n", message);
  return status;
}

/// The subcommand that the command line names, for the hint at its help.
std::string named_command(const CLI::App& program) {
  const auto commands = program.get_subcommands();
  return commands.empty() ? "" : commands.front()->get_name() + " ";
}

int report_parse_error(const CLI::App& program, const CLI::ParseError& error) {
  if (error.get_exit_code() == 0) return program.exit(error);  // --help, --version
  return report(fmt::format("{} (see motes {}--help)", motes::printable(error.what(), 400),
                            named_command(program)),
                2);
}

int run(int argc, char** argv) {
  CLI::App program(
      "Volume pictures and measurements of particle data, straight from the particles.", "motes");
  program.set_version_flag("--version", "motes " MOTES_VERSION);
  program.set_help_flag("-h,--help", "print this help and exit");
  program.footer(examples);
  program.require_subcommand(1);
  program.get_formatter()->column_width(34);
  motes::add_info_command(program);
  motes::add_probe_command(program);
  motes::add_render_command(program);
  try {
    program.parse(argc, argv);  // runs the subcommand
  } catch (const CLI::ParseError& error) {
    return report_parse_error(program, error);
  }
  // Whatever was printed has to have arrived.
  if (std::fflush(stdout) != 0) throw motes::Error("cannot write the standard output");
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const motes::Error& error) {
    return report(error.what(), 1);
  } catch (const std::bad_alloc&) {
    return report("not enough memory", 1);
  } catch (const std::exception& error) {
    return report(motes::printable(error.what(), 400), 1);
  }
}
