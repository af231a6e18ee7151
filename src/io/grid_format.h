// The table of formats of structured volumes: what a reader must offer to be found by read_grids().
#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

#include "io/reader.h"
#include "particles/grid.h"

namespace motes {

struct GridFormat {
  std::string_view name;
  /// Lower-case endings of file names, without the compression's.
  std::vector<std::string_view> suffixes;
  /// Whether `head`, the first decompressed bytes (up to 64 KiB), can only be this format.
  bool (*matches)(std::string_view head);
  std::vector<Grid> (*read)(const std::filesystem::path&, const ReadOptions&);
  /// Where the format is one of particles too: whether this file, which matches, has a grid at all.
  bool (*has_grid)(const std::filesystem::path&) = nullptr;
};

const GridFormat& cube_grid_format();
const GridFormat& nrrd_format();
const GridFormat& vasp_grid_format();
const GridFormat& vti_format();

/// All of them, in the order in which their contents are tried.
const std::vector<GridFormat>& grid_formats();

/// Throws Error, naming `file`, if the steps of a grid are not finite or span no volume.
void check_steps(const std::filesystem::path& file, const Grid& grid);

}  // namespace motes
