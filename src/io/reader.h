// Opening a file of particles, whatever its format: the one entrance of this room.
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <string_view>

#include "core/report.h"
#include "particles/particle_set.h"

namespace motes {

struct ReadOptions {
  std::map<int, std::string> types;  ///< names of numeric types: {1: "Si", 2: "O"}
  Progress* progress = nullptr;
  Warnings* warnings = nullptr;
};

/// An open file: one frame or many, read when asked for. Not for use from two threads at once.
class Trajectory {
 public:
  virtual ~Trajectory() = default;
  /// The format's name as users know it: "LAMMPS dump".
  virtual std::string_view format() const = 0;
  /// Number of frames; the first call may have to index the file.
  virtual std::size_t num_frames() = 0;
  /// Frame `frame`, from 0. Frame 0 is read without looking at the rest of the file. Throws Error
  /// if there is no such frame (naming the number of frames) or the file is bad.
  virtual ParticleSet read_frame(std::size_t frame) = 0;
};

/// Opens `path`, finding the format from its content first and its name second, through gz, bz2, xz
/// and zst compression. Throws Error if it cannot be read or its format is not known.
/// The progress and warnings that `options` points to must outlive the trajectory.
std::unique_ptr<Trajectory> open_trajectory(const std::filesystem::path& path,
                                            const ReadOptions& options);

/// Whether open_trajectory() knows the file's format and its first frame has any particles. Throws
/// Error if the file cannot be read.
bool has_particles(const std::filesystem::path& path);

/// For Trajectory::read_frame(): throws the Error for a frame beyond the last of `num_frames` > 0.
[[noreturn]] void throw_no_such_frame(const std::filesystem::path& path, std::size_t frame,
                                      std::size_t num_frames);

}  // namespace motes
