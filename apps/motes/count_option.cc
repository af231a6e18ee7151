// Checks counts while they are still a matter of the command line.
#include "motes/count_option.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <charconv>

#include "core/error.h"

namespace motes {

void add_count(CLI::App& command, const std::string& name, int& count, int max,
               const std::string& description) {
  const auto check = [max](const std::string& text) -> std::string {
    int value = 0;
    const char* const last = text.data() + text.size();
    const auto [end, error] = std::from_chars(text.data(), last, value);
    if (error == std::errc{} && end == last && value >= 1 && value <= max) return "";
    return fmt::format("expected a whole number from 1 to {}, found '{}'", max, printable(text));
  };
  command.add_option(name, count, description)->type_name("N")->check(CLI::Validator(check, ""));
}

}  // namespace motes
