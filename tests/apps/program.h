// Runs the real motes program in a directory of its own.
#pragma once

#include <filesystem>
#include <string>

#include "support/temporary_directory.h"

namespace motes {

struct Outcome {
  int status = 0;
  std::string out, err;
};

/// A new directory that goes with this object.
class Workspace {
 public:
  /// Runs `motes ARGUMENTS` there, `arguments` as the shell takes them.
  Outcome run(const std::string& arguments) const;
  void write(const std::string& name, const std::string& content) const;
  std::string read(const std::string& name) const;
  std::filesystem::path path(const std::string& name) const { return directory_ / name; }
  bool exists(const std::string& name) const { return std::filesystem::exists(directory_ / name); }
  /// Number of files there, the captured output left out.
  std::size_t num_files() const;

 private:
  TemporaryDirectory directory_;
};

}  // namespace motes
