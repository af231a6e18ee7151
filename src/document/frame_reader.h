// Frames of a scene's data, read ahead or when asked for.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "core/report.h"
#include "io/reader.h"
#include "particles/particle_set.h"

namespace motes {

/// An own look at the file, which is opened when the first frame is read. Not for use from two
/// threads at once; different readers are independent.
class FrameReader {
 public:
  FrameReader(std::filesystem::path path, std::map<int, std::string> types);

  /// Throws Error, also where the frame has no particles, and what `progress` throws; the file is
  /// opened anew after that.
  ParticleSet read_frame(std::uint64_t frame, Progress* progress, Warnings& warnings);
  /// Number of frames; the first call may have to index the file. Throws as read_frame() does.
  std::size_t count_frames(Progress* progress);

  /// The number of frames, if count_frames() has found it.
  std::optional<std::size_t> num_frames() const { return num_frames_; }
  /// The format's name, once something has been read.
  const std::string& format() const { return format_; }

 private:
  /// What an open trajectory points to: passes on to who asks now.
  struct Relay : Progress {
    void update(std::string_view activity, double fraction) override {
      if (target != nullptr) target->update(activity, fraction);
    }
    Progress* target = nullptr;
    Warnings warnings;
  };
  /// Does work(trajectory) on the open file.
  template <class Work>
  auto with_file(Progress* progress, Work&& work);

  std::filesystem::path path_;
  std::map<int, std::string> types_;
  std::unique_ptr<Relay> relay_ = std::make_unique<Relay>();  ///< stays where it is
  std::unique_ptr<Trajectory> trajectory_;
  std::optional<std::size_t> num_frames_;
  std::string format_;
};

}  // namespace motes
