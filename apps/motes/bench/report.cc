// Asks the system what it is, and writes results.
#include "motes/bench/report.h"

#include <fmt/format.h>
#include <malloc.h>
#include <sys/utsname.h>
#include <tbb/info.h>
#include <unistd.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "core/atomic_file.h"
#include "render/render_tile.h"

namespace motes {
namespace {

#ifdef __clang__
constexpr const char* compiler = "clang " __clang_version__;
#else
constexpr const char* compiler = "g++ " __VERSION__;
#endif

/// What stands after `key` and a colon in a file of such lines, as /proc has them.
std::string value_in(const char* path, std::string_view key) {
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);) {
    const std::size_t colon = line.find(':');
    if (!line.starts_with(key) || colon == line.npos) continue;
    const std::size_t start = line.find_first_not_of(" \t", colon + 1);
    return start == line.npos ? "" : line.substr(start);
  }
  return "unknown";
}

std::string processor() { return value_in("/proc/cpuinfo", "model name"); }

/// One of the sizes of this process in /proc.
std::size_t own_bytes(std::string_view key) {
  return std::strtoull(value_in("/proc/self/status", key).c_str(), nullptr, 10) * 1024;
}

int threads_of(const BenchOptions& options) {
  return options.threads > 0 ? options.threads : tbb::info::default_concurrency();
}

}  // namespace

std::string machine_line(const BenchOptions& options) {
  return fmt::format("{}, {} threads, {}, {}", processor(), threads_of(options), instruction_set(),
                     compiler);
}

std::string describe_measurement(const BenchOptions& options) {
  return fmt::format("{}, {} x {}, medians of {} frames", machine_line(options), options.width,
                     options.height, options.repeat);
}

void write_results(const BenchJob& job, std::string_view name, const nlohmann::ordered_json& rows) {
  write_results(job, name, rows, nlohmann::ordered_json::object());
}

void write_results(const BenchJob& job, std::string_view name, const nlohmann::ordered_json& rows,
                   const nlohmann::ordered_json& summary) {
  utsname system{};
  ::uname(&system);
  const BenchOptions& options = job.options;
  const nlohmann::ordered_json all{
      {"benchmark", name},
      {"motes", MOTES_VERSION},
      {"machine",
       {{"processor", processor()},
        {"logical_cores", tbb::info::default_concurrency()},
        {"memory_bytes", ::sysconf(_SC_PHYS_PAGES) * ::sysconf(_SC_PAGESIZE)},
        {"system", fmt::format("{} {} {}", system.sysname, system.release, system.machine)},
        {"compiler", compiler},
        {"instruction_set", instruction_set()}}},
      {"settings",
       {{"width", options.width},
        {"height", options.height},
        {"repeat", options.repeat},
        {"threads", threads_of(options)}}},
      {"summary", summary},
      {"rows", rows}};
  write_result_file(job, fmt::format("{}.json", name), all.dump(1) + "\n");
}

void write_result_file(const BenchJob& job, std::string_view name, std::string_view text) {
  const std::filesystem::path path = job.workplace.result(name);
  write_file(path, text);
  fmt::print("written: {}\n", path.string());
}

std::size_t resident_memory() { return own_bytes("VmRSS"); }

std::size_t peak_memory() { return own_bytes("VmHWM"); }

void reset_peak_memory() {
  malloc_trim(0);
  std::ofstream("/proc/self/clear_refs") << "5";
}

}  // namespace motes
