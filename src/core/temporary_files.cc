// A set behind a mutex.
#include "core/temporary_files.h"

#include <unistd.h>

namespace motes {

TemporaryFiles& TemporaryFiles::of_program() {
  // Never destroyed: a thread may still end the program while others leave main().
  static TemporaryFiles* const files = new TemporaryFiles;
  return *files;
}

void TemporaryFiles::add(const std::filesystem::path& path) {
  const std::lock_guard lock(mutex_);
  paths_.insert(path);
}

void TemporaryFiles::remove(const std::filesystem::path& path) {
  const std::lock_guard lock(mutex_);
  paths_.erase(path);
}

void TemporaryFiles::abandon() {
  mutex_.lock();  // for good
  for (const auto& path : paths_) unlink(path.c_str());
}

}  // namespace motes
