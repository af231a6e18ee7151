// Output files that are either written whole or not at all.
#pragma once

#include <filesystem>
#include <string_view>

namespace motes {

/// A file being written under a temporary name beside its own, which commit() renames to `path`.
/// Without commit() the temporary is removed (and where the system can, it is not there before) and
/// what was at `path` stays as it was. Links are
/// followed; what is no regular file (/dev/stdout, a pipe) is written straight.
/// Every failure throws Error(path, "cannot write: REASON").
class AtomicFile {
 public:
  /// Throws if the directory is missing or unwritable, or if `path` is a directory or read-only:
  /// made before long work, it tells of these at once.
  explicit AtomicFile(const std::filesystem::path& path);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  /// Appends `bytes`; unbuffered, so give it large pieces.
  void write(std::string_view bytes);
  /// Brings everything to the disk and gives the file its name. At most once, after the last write.
  void commit();

 private:
  [[noreturn]] void fail(int error_number) const;

  std::filesystem::path path_;       ///< as the caller named it, for messages
  std::filesystem::path target_;     ///< path_ with links followed
  std::filesystem::path temporary_;  ///< empty: nothing to rename or remove
  int descriptor_ = -1;
  bool nameless_ = false;  ///< temporary_ appears only in commit()
};

/// Writes `bytes` to `path`, whole or not at all.
void write_file(const std::filesystem::path& path, std::string_view bytes);

}  // namespace motes
