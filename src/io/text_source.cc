// A memory map, or a window that moves over a stream.
#include "io/text_source.h"

#include <algorithm>
#include <cassert>

#include "core/error.h"

namespace motes {

TextSource::TextSource(const std::filesystem::path& path, const ReadOptions& options,
                       std::uint64_t most_bytes)
    : path_(path),
      options_(options),
      most_bytes_(most_bytes),
      stream_(std::make_unique<ByteStream>(path)) {
  if (!stream_->compressed()) {
    stream_.reset();
    mapped_ = std::make_unique<MappedFile>(path);
  }
}

void TextSource::restart() {
  stream_ = std::make_unique<ByteStream>(path_);
  stream_ended_ = false;
  window_.clear();
  window_offset_ = 0;
  position_ = {};
}

void TextSource::seek(Position position) {
  if (mapped_ == nullptr) {
    if (position.offset < window_offset_) restart();
    // What is passed over need not be kept.
    while (position.offset > window_offset_ + window_.size() && !stream_ended_) {
      position_.offset = window_offset_ + window_.size();
      load_more();
    }
  }
  position_ = position;
}

std::string_view TextSource::loaded() const {
  if (mapped_ != nullptr) {
    const std::string_view bytes = mapped_->bytes();
    return bytes.substr(std::min<std::uint64_t>(position_.offset, bytes.size()));
  }
  const std::uint64_t begin = position_.offset - window_offset_;
  std::string_view text = std::string_view(window_).substr(std::min(begin, window_.size()));
  // (rfind gives npos, and npos + 1 is 0, where there is no whole line.)
  return stream_ended_ ? text : text.substr(0, text.rfind('\n') + 1);
}

/// Throws Error if nothing but the beginning of a line is loaded, and that is too long: a few bytes
/// of a compressed file can hold gigabytes without a line's end.
void TextSource::refuse_endless_line() const {
  constexpr std::size_t most_bytes = std::size_t{64} << 20;
  const std::size_t last_end = window_.rfind('\n');
  const std::size_t begin = last_end == std::string::npos ? 0 : last_end + 1;
  if (window_.size() - begin <= most_bytes) return;
  const std::uint64_t line = position_.line + static_cast<std::uint64_t>(std::count(
                                                  loaded().begin(), loaded().end(), '\n'));
  throw Error(path_, line, "a line of more than 64 MiB; expected text");
}

void TextSource::load_more() {
  assert(!complete());
  refuse_endless_line();
  window_.erase(0, position_.offset - window_offset_);
  window_offset_ = position_.offset;
  const std::size_t old_size = window_.size();
  if (old_size >= most_bytes_) {
    throw Error(path_, position_.line, too_large("a frame", most_bytes_));
  }
  const std::size_t block =
      std::min<std::uint64_t>(std::max(old_size, std::size_t{1} << 20), most_bytes_ - old_size);
  window_.resize(old_size + block);
  const std::size_t n = stream_->read(window_.data() + old_size, block);
  window_.resize(old_size + n);
  stream_ended_ = n == 0;
  if (options_.progress != nullptr) {
    options_.progress->update(reading_activity(path_), stream_->fraction());
  }
}

}  // namespace motes
