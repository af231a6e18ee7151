// Trajectories of text formats whose frames follow each other: finds, indexes and reads frames.
#pragma once

#include <filesystem>
#include <optional>
#include <string_view>
#include <vector>

#include "io/reader.h"
#include "io/text.h"
#include "io/text_source.h"

namespace motes {

/// Frame 0 is read without a look at what follows it; an index of where frames begin grows as far
/// as it is asked for. A file whose end is damaged keeps the frames before the damage:
/// num_frames() counts them and warns, read_frame() beyond them throws the damage's Error.
class TextTrajectory : public Trajectory {
 public:
  std::size_t num_frames() override;
  ParticleSet read_frame(std::size_t frame) override;

 protected:
  TextTrajectory(const std::filesystem::path& path, const ReadOptions& options);

  /// Moves `lines` from the start of a frame past its end, looking at no more than it must to find
  /// it. Throws Error where the text is no frame, TextEnds (as LineReader does) where it ends.
  virtual void skip_frame(LineReader& lines) const = 0;
  /// The particles of the frame that is exactly this block.
  virtual ParticleSet parse_frame(TextBlock frame) = 0;

  const std::filesystem::path& path() const { return path_; }
  const ReadOptions& options() const { return options_; }
  void warn(std::string line) const;

 private:
  struct Frame {
    TextBlock block;
    TextSource::Position end;
  };

  Frame find_frame();
  bool find_next_start();
  bool at_end();

  std::filesystem::path path_;
  ReadOptions options_;
  TextSource source_;
  std::vector<TextSource::Position> starts_{{}};  ///< of the frames that are known
  bool all_known_ = false;
};

}  // namespace motes
