// A trajectory whose frames are all in memory: for formats that are read at once.
#pragma once

#include <string_view>
#include <utility>
#include <vector>

#include "io/reader.h"

namespace motes {

class InMemoryTrajectory : public Trajectory {
 public:
  /// `format` must outlive the trajectory (a literal); `path` is for messages.
  InMemoryTrajectory(std::string_view format, std::filesystem::path path,
                     std::vector<ParticleSet> frames)
      : format_(format), path_(std::move(path)), frames_(std::move(frames)) {}

  std::string_view format() const override { return format_; }
  std::size_t num_frames() override { return frames_.size(); }
  ParticleSet read_frame(std::size_t frame) override {
    if (frame >= frames_.size()) throw_no_such_frame(path_, frame, frames_.size());
    return frames_[frame];
  }

 private:
  std::string_view format_;
  std::filesystem::path path_;
  std::vector<ParticleSet> frames_;
};

}  // namespace motes
