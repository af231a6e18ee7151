#include "document/frame_reader.h"

#include <utility>

#include "core/error.h"

namespace motes {

FrameReader::FrameReader(std::filesystem::path path, std::map<int, std::string> types)
    : path_(std::move(path)), types_(std::move(types)) {}

template <class Work>
auto FrameReader::with_file(Progress* progress, Work&& work) {
  relay_->target = progress;
  relay_->warnings = {};
  try {
    if (!trajectory_) {
      trajectory_ = open_trajectory(path_, {types_, relay_.get(), &relay_->warnings});
      format_ = trajectory_->format();
    }
    return work(*trajectory_);
  } catch (...) {
    trajectory_.reset();  // it may have been left half indexed
    throw;
  }
}

ParticleSet FrameReader::read_frame(std::uint64_t frame, Progress* progress, Warnings& warnings) {
  ParticleSet particles =
      with_file(progress, [frame](Trajectory& file) { return file.read_frame(frame); });
  for (const std::string& line : relay_->warnings.lines()) warnings.add(line);
  if (particles.size() == 0) throw Error(path_, "has no particles in this frame");
  return particles;
}

std::size_t FrameReader::count_frames(Progress* progress) {
  if (!num_frames_) {
    num_frames_ = with_file(progress, [](Trajectory& file) { return file.num_frames(); });
  }
  return *num_frames_;
}

}  // namespace motes
