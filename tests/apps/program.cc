// Starts the program through the shell and captures what it prints.
#include "apps/program.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <fstream>
#include <iterator>

namespace motes {
namespace {

constexpr const char* captured[] = {".out", ".err"};

std::string read_file(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

}  // namespace

Outcome Workspace::run(const std::string& arguments) const {
  const int status = std::system(fmt::format("cd '{}' && {{ '{}' {}\n}} >.out 2>.err </dev/null",
                                             directory_.path().string(), MOTES_PROGRAM, arguments)
                                     .c_str());
  EXPECT_TRUE(WIFEXITED(status)) << arguments;
  return {WEXITSTATUS(status), read(captured[0]), read(captured[1])};
}

void Workspace::write(const std::string& name, const std::string& content) const {
  std::ofstream(directory_ / name, std::ios::binary) << content;
}

std::string Workspace::read(const std::string& name) const { return read_file(directory_ / name); }

std::size_t Workspace::num_files() const {
  std::size_t count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(directory_.path())) {
    const std::string name = entry.path().filename();
    if (name != captured[0] && name != captured[1]) ++count;
  }
  return count;
}

}  // namespace motes
