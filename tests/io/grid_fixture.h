// What the tests of readers of grids share.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "core/error.h"
#include "io/grid_reader.h"
#include "support/temporary_file.h"

namespace motes {

/// The grids of a file `name` with this content.
inline std::vector<Grid> grids_of(std::string_view name, std::string_view content,
                                  Warnings* warnings = nullptr) {
  const TemporaryFile file(name, content);
  ReadOptions options;
  options.warnings = warnings;
  return read_grids(file.path(), options);
}

/// The Error that reading them gives, without the directory; "" if there is none.
inline std::string grid_error(std::string_view name, std::string_view content,
                              Warnings* warnings = nullptr) {
  const TemporaryFile file(name, content);
  ReadOptions options;
  options.warnings = warnings;
  try {
    read_grids(file.path(), options);
  } catch (const Error& error) {
    const std::string message = error.what(), directory = file.path().parent_path().string() + "/";
    EXPECT_TRUE(message.starts_with(directory)) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    return message.substr(directory.size());
  }
  return "";
}

/// Cuts a good file at every byte: each piece is refused, or it is the whole but for a last line's
/// end, and then there is a warning if a number may be cut.
inline void expect_refused_when_cut(std::string_view name, const std::string& content) {
  ASSERT_EQ(grid_error(name, content), "");
  for (std::size_t length = 0; length < content.size(); ++length) {
    Warnings warnings;
    const std::string error = grid_error(name, content.substr(0, length), &warnings);
    if (!error.empty()) {
      EXPECT_TRUE(error.starts_with(std::string(name) + ":")) << error;
    } else if (content.find_first_not_of('\n', length) != std::string::npos) {
      EXPECT_THAT(warnings.lines(),
                  testing::Contains(testing::HasSubstr("the last line has no end")))
          << "cut to " << length << " bytes";
    }
  }
}

inline void expect_vector(const Vector3d& found, const Vector3d& expected) {
  for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(found[axis], expected[axis], 1e-12) << axis;
}

}  // namespace motes
