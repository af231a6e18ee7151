// The text of a file from any position on, without reading what comes before or after.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "io/bytes.h"
#include "io/reader.h"

namespace motes {

/// Plain files are mapped into memory; of compressed ones a window is kept that moves forward, and
/// a step back starts again from the beginning.
class TextSource {
 public:
  struct Position {
    std::uint64_t offset = 0;  ///< bytes of decompressed content
    std::uint64_t line = 1;
  };

  /// What `options` points to must outlive the source. A window has at most `most_bytes`.
  TextSource(const std::filesystem::path& path, const ReadOptions& options,
             std::uint64_t most_bytes = half_of_memory());

  void seek(Position position);
  Position position() const { return position_; }

  /// The text from the position on, as far as it is loaded; whole lines if not complete(). Valid
  /// until the next seek() or load_more().
  std::string_view loaded() const;
  /// Whether loaded() reaches the end of the file.
  bool complete() const { return mapped_ != nullptr || stream_ended_; }
  /// Loads as much again, at least 1 MiB, or what the window may still take. Throws Error where a
  /// compressed file has a line of more than 64 MiB, or the window is full.
  void load_more();

 private:
  void restart();
  void refuse_endless_line() const;

  std::filesystem::path path_;
  ReadOptions options_;
  std::uint64_t most_bytes_;
  Position position_;
  std::unique_ptr<MappedFile> mapped_;
  // A compressed file: window_ holds the content from window_offset_ on.
  std::unique_ptr<ByteStream> stream_;
  bool stream_ended_ = false;
  std::string window_;
  std::uint64_t window_offset_ = 0;
};

}  // namespace motes
