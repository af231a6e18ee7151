// Options that take a whole number of 1 or more.
#pragma once

#include <string>

namespace CLI {
class App;
}

namespace motes {

/// Adds an option that takes a whole number from 1 to `max`.
void add_count(CLI::App& command, const std::string& name, int& count, int max,
               const std::string& description);

}  // namespace motes
