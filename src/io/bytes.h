// The bytes of a file, whether plain or compressed: as a stream, whole, or mapped into memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "io/reader.h"

struct archive;

namespace motes {

/// A file's content from front to back, through gzip (of several members too), bzip2, xz and zstd,
/// found from the content. Throws Error, here and later, for a file that is missing, is a
/// directory or another thing than a file, cannot be read, or whose compressed data are damaged.
class ByteStream {
 public:
  explicit ByteStream(const std::filesystem::path& path);
  /// The same of a part of a file that is in memory already and outlives the stream; `path` is for
  /// messages.
  ByteStream(const std::filesystem::path& path, std::string_view stored);

  /// Fills `out` with the next bytes; fewer than `size` at the end, 0 behind it. What comes before
  /// damage is given before the Error is thrown.
  std::size_t read(char* out, std::size_t size);
  bool compressed() const;
  /// How much of the file has been consumed, in [0, 1].
  double fraction() const;

 private:
  struct Close {
    void operator()(archive* a) const;
  };

  ByteStream(const std::filesystem::path& path, std::uint64_t size);

  void read_header();
  bool next_block(std::size_t filled);
  [[noreturn]] void fail() const;

  std::filesystem::path path_;
  std::uint64_t file_size_;
  std::unique_ptr<archive, Close> archive_;
  std::string_view block_;  ///< decompressed, not given yet
  bool at_end_ = false;
};

/// A file that is not compressed, as memory; its pages are read when they are looked at. A file
/// that another program shortens meanwhile ends this one (SIGBUS): an accepted risk, since files
/// that are being written grow.
class MappedFile {
 public:
  /// Throws Error if the file cannot be mapped.
  explicit MappedFile(const std::filesystem::path& path);
  ~MappedFile();
  MappedFile(const MappedFile&) = delete;
  MappedFile& operator=(const MappedFile&) = delete;

  std::string_view bytes() const { return {data_, size_}; }

 private:
  const char* data_ = nullptr;
  std::size_t size_ = 0;
};

inline constexpr std::size_t head_bytes = std::size_t{64} << 10;

/// The first bytes of the (decompressed) content, at most `size`.
std::string read_head(const std::filesystem::path& path, std::size_t size = head_bytes);

/// Half of the machine's memory, in bytes: the most of a file's content that is held at once, for a
/// few compressed bytes can stand for any number.
std::uint64_t half_of_memory();

/// The message that `what` has more than `most_bytes`, too many for memory.
std::string too_large(std::string_view what, std::uint64_t most_bytes);

/// The whole (decompressed) content, with progress: for formats that are small, or read at once.
/// Throws Error where it has more than `most_bytes`.
std::string read_decompressed(const std::filesystem::path& path, const ReadOptions& options,
                              std::uint64_t most_bytes = half_of_memory());

/// The whole (decompressed) content of a file: a plain one is mapped, a compressed one read into
/// memory. Throws Error as MappedFile and read_decompressed() do.
class FileContent {
 public:
  FileContent(const std::filesystem::path& path, const ReadOptions& options);

  std::string_view bytes() const { return mapped_ ? mapped_->bytes() : std::string_view(content_); }

 private:
  std::unique_ptr<MappedFile> mapped_;
  std::string content_;
};

/// The file's name in lower case, without the endings that compression adds.
std::string bare_name(const std::filesystem::path& path);

/// "reading NAME", the activity that readers report their progress as.
std::string reading_activity(const std::filesystem::path& path);

}  // namespace motes
