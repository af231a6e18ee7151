// Output files through POSIX: write, fsync, rename.
#include "core/atomic_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <atomic>
#include <cassert>
#include <cerrno>
#include <system_error>
#include <utility>

#include "core/error.h"
#include "core/temporary_files.h"

namespace motes {

namespace {

/// A name for a temporary file in the directory of `target`: short, so that any name that fits the
/// file system leaves room for it, and of no other process or thread.
std::filesystem::path temporary_name(const std::filesystem::path& target) {
  static std::atomic<unsigned> counter{0};
  return target.parent_path() / fmt::format(".motes-{}-{}.tmp", getpid(), counter++);
}

std::string path_of(int descriptor) { return fmt::format("/proc/self/fd/{}", descriptor); }

/// A file in `directory` that gets its name only when it is whole, so that not even a program that
/// is killed leaves it behind; negative where the system has no such files.
int open_nameless(const std::filesystem::path& directory) {
  const char* const place = directory.empty() ? "." : directory.c_str();
  const int descriptor = open(place, O_WRONLY | O_TMPFILE | O_CLOEXEC, 0666);
  if (descriptor < 0 || access(path_of(descriptor).c_str(), F_OK) == 0) return descriptor;
  close(descriptor);
  return -1;
}

}  // namespace

AtomicFile::AtomicFile(const std::filesystem::path& path) : path_(path) {
  namespace fs = std::filesystem;
  if (path.empty()) fail(ENOENT);
  std::error_code error;
  target_ = fs::weakly_canonical(path, error);
  if (error) fail(error.value());

  const fs::file_status status = fs::status(target_, error);
  if (fs::is_directory(status)) fail(EISDIR);
  const bool special = fs::exists(status) && !fs::is_regular_file(status);
  // A rename would replace a file that its owner has protected.
  if (fs::exists(status) && access(target_.c_str(), W_OK) != 0) fail(errno);

  if (special) {
    descriptor_ = open(target_.c_str(), O_WRONLY | O_CLOEXEC);
  } else {
    fs::path name = temporary_name(target_);
    TemporaryFiles::of_program().add(name);
    descriptor_ = open_nameless(target_.parent_path());
    nameless_ = descriptor_ >= 0;
    if (!nameless_) {
      descriptor_ = open(name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    }
    const int error_number = errno;
    if (descriptor_ < 0) {
      TemporaryFiles::of_program().remove(name);
      fail(error_number);
    }
    temporary_ = std::move(name);
  }
  if (descriptor_ < 0) fail(errno);
}

AtomicFile::~AtomicFile() {
  if (descriptor_ >= 0) close(descriptor_);
  if (temporary_.empty()) return;
  unlink(temporary_.c_str());
  TemporaryFiles::of_program().remove(temporary_);
}

void AtomicFile::write(std::string_view bytes) {
  assert(descriptor_ >= 0);
  while (!bytes.empty()) {
    const ssize_t written = ::write(descriptor_, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) fail(errno);
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
}

void AtomicFile::commit() {
  assert(descriptor_ >= 0);
  // Some file systems tell of a full disk only here. What is no file has nothing to bring to disk.
  if (!temporary_.empty() && fsync(descriptor_) != 0) fail(errno);
  if (nameless_ && linkat(AT_FDCWD, path_of(descriptor_).c_str(), AT_FDCWD, temporary_.c_str(),
                          AT_SYMLINK_FOLLOW) != 0) {
    fail(errno);
  }
  if (close(std::exchange(descriptor_, -1)) != 0) fail(errno);
  if (temporary_.empty()) return;
  if (rename(temporary_.c_str(), target_.c_str()) != 0) fail(errno);
  TemporaryFiles::of_program().remove(temporary_);
  temporary_.clear();
}

void AtomicFile::fail(int error_number) const {
  throw Error(path_,
              fmt::format("cannot write: {}", std::generic_category().message(error_number)));
}

void write_file(const std::filesystem::path& path, std::string_view bytes) {
  AtomicFile file(path);
  file.write(bytes);
  file.commit();
}

}  // namespace motes
