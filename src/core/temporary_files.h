// Files that must not outlive the program, however it ends.
#pragma once

#include <filesystem>
#include <mutex>
#include <set>

namespace motes {

/// The temporary files that there are at the moment. Safe for several threads.
class TemporaryFiles {
 public:
  /// Those of AtomicFile.
  static TemporaryFiles& of_program();

  void add(const std::filesystem::path& path);
  void remove(const std::filesystem::path& path);
  /// Deletes all. The program is about to end: threads that add or remove others wait from now on.
  void abandon();

 private:
  std::mutex mutex_;
  std::set<std::filesystem::path> paths_;
};

}  // namespace motes
