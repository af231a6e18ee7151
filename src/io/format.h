// The table of formats: what a reader must offer to be found by open_trajectory().
#pragma once

#include <filesystem>
#include <memory>
#include <string_view>
#include <vector>

#include "io/reader.h"

namespace motes {

struct Format {
  std::string_view name;
  /// Lower-case endings of file names, without the compression's: {".lammpstrj", ".dump"}.
  std::vector<std::string_view> suffixes;
  /// Whether `head`, the first decompressed bytes (up to 64 KiB), can only be this format.
  bool (*matches)(std::string_view head);
  std::unique_ptr<Trajectory> (*open)(const std::filesystem::path&, const ReadOptions&);
};

/// All formats, in the order in which their contents are tried.
const std::vector<Format>& formats();

}  // namespace motes
