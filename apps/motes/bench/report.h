// Results as files that say where they come from.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

#include "motes/bench/benchmarks.h"

namespace motes {

/// One line: processor, threads, instruction set, compiler.
std::string machine_line(const BenchOptions& options);

/// The same with the size of the frames and how many are timed.
std::string describe_measurement(const BenchOptions& options);

/// Writes `rows`, with the machine and the settings, to NAME.json of the results; `summary`, an
/// object, holds what is said of all rows together.
void write_results(const BenchJob& job, std::string_view name, const nlohmann::ordered_json& rows);
void write_results(const BenchJob& job, std::string_view name, const nlohmann::ordered_json& rows,
                   const nlohmann::ordered_json& summary);

/// Writes `text` to the result file `name` and says so on the standard output.
void write_result_file(const BenchJob& job, std::string_view name, std::string_view text);

/// Memory that the process has, and most that it had since reset_peak_memory(), bytes; 0 where the
/// system does not tell.
std::size_t resident_memory();
std::size_t peak_memory();
/// Gives the system back what is free first, so that it counts when it is used again.
void reset_peak_memory();

}  // namespace motes
