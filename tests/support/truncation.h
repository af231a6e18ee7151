// What any reader owes to damaged files: a correct result or one clear line.
#pragma once

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <random>
#include <string>

#include "core/error.h"
#include "io/reader.h"
#include "support/temporary_file.h"

namespace motes {

inline std::string file_content(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// Reads all frames; the message of the Error, or "" if there was none.
inline std::string error_of_reading(const std::filesystem::path& path) {
  try {
    Warnings warnings;
    ReadOptions options;
    options.warnings = &warnings;
    const auto trajectory = open_trajectory(path, options);
    const std::size_t num_frames = trajectory->num_frames();
    for (std::size_t frame = 0; frame < num_frames; ++frame) trajectory->read_frame(frame);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

/// Cuts `content` at 50 points, always the same ones, and reads what is left. The name decides what
/// the file is called.
inline void expect_clear_errors_when_cut(const std::string& name, const std::string& content) {
  std::mt19937_64 random(1);
  for (int i = 0; i < 50; ++i) {
    const std::size_t length = random() % content.size();
    const TemporaryFile file(name, content.substr(0, length));
    const std::string error = error_of_reading(file.path());
    if (error.empty()) continue;
    EXPECT_EQ(error.find('\n'), std::string::npos) << error;
    EXPECT_TRUE(error.starts_with(file.path().string() + ":")) << error;
  }
}

}  // namespace motes
