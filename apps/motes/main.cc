// motes: the command line. Exit status 0; 1 for a failure; 2 for a wrong command line.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <new>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.h"
#include "motes/commands.h"
#include "motes/interrupt.h"

namespace {

constexpr const char* examples = R"(Examples:
  motes render silica.lammpstrj -o silica.png
  motes render snapshot_042.hdf5 -o box.png --transfer-function magma
  motes view silica.lammpstrj
  motes info silica.lammpstrj
  motes probe silica.lammpstrj --points points.csv -o values.csv
  motes resample silica.lammpstrj -o silica.vti --voxel-size 0.5
  motes bench table2 --scenes zeolite,nanobowl

'motes COMMAND --help' tells more about each. A scene file (docs/scene.md) may stand
wherever a FILE of particles does.)";

int report(const std::string& message, int status) {
  fmt::print(stderr, "motes: error: {}\n", message);
  return status;
}

/// The subcommand that the command line names, or the program itself.
const CLI::App& named_command(const CLI::App& program) {
  const auto commands = program.get_subcommands();
  return commands.empty() ? program : *commands.front();
}

/// The first argument that nobody takes, in the order of the command line, or "".
std::string first_unknown(const CLI::App& program, int argc, char** argv) {
  const std::vector<std::string> unknown = program.remaining(true);
  const auto it = std::find_if(argv + 1, argv + argc, [&](const char* argument) {
    return std::find(unknown.begin(), unknown.end(), argument) != unknown.end();
  });
  return it == argv + argc ? "" : *it;
}

/// What people look for under other names.
struct Hint {
  std::vector<std::string_view> words;
  std::string_view hint;
};
const Hint hints[] = {
    {{"color", "colour", "colors", "colours", "colormap", "colourmap", "color-map", "colour-map",
      "cmap", "palette", "opacity", "extinction"},
     "colours and opacity are --transfer-function"},
    {{"species", "element", "elements", "select", "selection", "filter", "where", "field",
      "fields"},
     "selections are made in a scene file, docs/scene.md"},
};

std::string describe_unknown_option(const CLI::App& command, const std::string& argument) {
  const std::string option = argument.substr(0, argument.find('='));
  std::vector<std::string> known;
  for (const CLI::Option* each : command.get_options()) {
    known.insert(known.end(), each->get_lnames().begin(), each->get_lnames().end());
  }
  const auto letters = std::min(option.find_first_not_of('-'), option.size());
  const std::string word = option.substr(letters);
  const std::string start = fmt::format("{}: unknown option", motes::printable(option));
  if (command.get_option_no_throw("--transfer-function") != nullptr) {
    for (const auto& [words, hint] : hints) {
      if (std::find(words.begin(), words.end(), word) != words.end()) {
        return fmt::format("{}; {}", start, hint);
      }
    }
  }
  const std::string nearest = motes::nearest_word(word, known);
  return nearest.empty() ? start : fmt::format("{}; did you mean --{}?", start, nearest);
}

std::string describe_unknown_command(const CLI::App& program, const std::string& argument) {
  std::error_code error;
  if (std::filesystem::exists(argument, error)) {
    const std::string file = motes::printable(argument, 400);
    return fmt::format(
        "{}: expected a command first: 'motes render {} -o picture.png' or 'motes info {}'", file,
        file, file);
  }
  std::vector<std::string> known;
  for (const CLI::App* command : program.get_subcommands({})) known.push_back(command->get_name());
  return motes::unknown_name("command", argument, known).what();
}

std::string describe(const CLI::App& program, const CLI::ParseError& error, int argc, char** argv) {
  const CLI::App& command = named_command(program);
  const std::string unknown = first_unknown(program, argc, argv);
  if (unknown.starts_with('-')) return describe_unknown_option(command, unknown);
  if (!unknown.empty() && &command == &program) return describe_unknown_command(program, unknown);
  if (!unknown.empty()) {
    return fmt::format("unexpected argument '{}'", motes::printable(unknown));
  }
  const std::string what = error.what();
  if (const auto at = what.find(": At Most 1 required but received "); at != std::string::npos) {
    return fmt::format("{}: given more than once; expected one value", what.substr(0, at));
  }
  return motes::printable(what, 400);
}

int report_parse_error(const CLI::App& program, const CLI::ParseError& error, int argc,
                       char** argv) {
  if (error.get_exit_code() == 0) return program.exit(error);  // --help, --version
  const CLI::App& command = named_command(program);
  const std::string name = &command == &program ? "" : command.get_name() + " ";
  return report(fmt::format("{} (see motes {}--help)", describe(program, error, argc, argv), name),
                2);
}

/// The arguments, where `motes` and `motes help [COMMAND]` stand for `motes [COMMAND] --help`.
std::vector<char*> with_help(int argc, char** argv) {
  static char help[] = "--help";
  std::vector<char*> arguments(argv, argv + argc);
  if (argc < 2) {
    arguments.push_back(help);
  } else if (argv[1] == std::string_view("help")) {
    arguments.erase(arguments.begin() + 1);
    arguments.push_back(help);
  }
  return arguments;
}

int run(int argc, char** argv) {
  CLI::App program(
      "Volume pictures and measurements of particle data, straight from the particles.", "motes");
  program.set_version_flag("-v,--version", "motes " MOTES_VERSION, "print the version and exit");
  program.set_help_flag("-h,--help", "print this help and exit");
  program.footer(examples);
  program.require_subcommand(1);
  program.get_formatter()->column_width(34);
  motes::add_info_command(program);
  motes::add_probe_command(program);
  motes::add_render_command(program);
  motes::add_resample_command(program);
  motes::add_view_command(program);
  motes::add_bench_command(program);
  try {
    program.parse(argc, argv);  // runs the subcommand
  } catch (const CLI::ParseError& error) {
    return report_parse_error(program, error, argc, argv);
  }
  // Whatever was printed has to have arrived.
  if (std::fflush(stdout) != 0) throw motes::Error("cannot write the standard output");
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  motes::leave_when_interrupted();
  try {
    std::vector<char*> arguments = with_help(argc, argv);
    return run(static_cast<int>(arguments.size()), arguments.data());
  } catch (const motes::Error& error) {
    return report(error.what(), 1);
  } catch (const std::bad_alloc&) {
    return report("not enough memory", 1);
  } catch (const std::exception& error) {
    return report(motes::printable(error.what(), 400), 1);
  }
}
