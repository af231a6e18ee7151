// The index of a text trajectory's frames.
#include "io/text_trajectory.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace motes {

TextTrajectory::TextTrajectory(const std::filesystem::path& path, const ReadOptions& options)
    : path_(path), options_(options), source_(path, options) {}

void TextTrajectory::warn(std::string line) const {
  if (options_.warnings != nullptr) options_.warnings->add(std::move(line));
}

/// The frame at the source's position, loaded as far as it takes.
TextTrajectory::Frame TextTrajectory::find_frame() {
  for (;;) {
    const TextSource::Position start = source_.position();
    const TextBlock loaded{source_.loaded(), start.line};
    LineReader lines(path_, loaded, source_.complete());
    try {
      skip_frame(lines);
      return {{loaded.text.substr(0, lines.position()), start.line},
              {start.offset + lines.position(), lines.rest().first_line}};
    } catch (const TextEnds&) {
      if (source_.complete()) throw;
    }
    source_.load_more();
  }
}

bool TextTrajectory::at_end() {
  for (;;) {
    const std::string_view text = source_.loaded();
    if (!std::all_of(text.begin(), text.end(), is_blank)) return false;
    if (source_.complete()) return true;
    source_.load_more();
  }
}

/// Moves behind the last known frame, where the source stands, and notes where the next one begins;
/// false if there is none.
bool TextTrajectory::find_next_start() {
  const TextSource::Position next = find_frame().end;
  source_.seek(next);
  all_known_ = at_end();
  if (!all_known_) starts_.push_back(next);
  return !all_known_;
}

std::size_t TextTrajectory::num_frames() {
  if (all_known_) return starts_.size();
  source_.seek(starts_.back());
  try {
    while (find_next_start()) {
    }
  } catch (const Error& error) {
    const std::size_t num_good = starts_.size() - 1;
    if (num_good == 0) throw;
    warn(fmt::format("{}; {} can be read", error.what(),
                     num_good == 1 ? "only the frame before it"
                                   : fmt::format("only the {} frames before it", num_good)));
    return num_good;
  }
  return starts_.size();
}

ParticleSet TextTrajectory::read_frame(std::size_t frame) {
  if (frame >= starts_.size() && !all_known_) {
    source_.seek(starts_.back());
    while (frame >= starts_.size() && find_next_start()) {
    }
  }
  if (frame >= starts_.size()) throw_no_such_frame(path_, frame, starts_.size());
  source_.seek(starts_[frame]);
  const Frame found = find_frame();
  ParticleSet particles = parse_frame(found.block);
  // Only now: where reading fails, its error says more.
  const std::string_view text = found.block.text;
  if (!text.empty() && text.back() != '\n') {
    warn_of_open_end(path_, found.end.line - 1, options_.warnings);
  }
  return particles;
}

}  // namespace motes
