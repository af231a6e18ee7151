// Opening a file of structured volumes, whatever its format: the counterpart of reader.h.
#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

#include "io/reader.h"
#include "particles/grid.h"

namespace motes {

/// The grids of a file, at least one, all of the same shape but for those of a VTI file's cells.
/// Formats: NRRD, VTI, Gaussian cube, VASP's CHGCAR and its like; found from the content first and
/// the name second, through gz, bz2, xz and zst compression. Throws Error if it cannot be read, or
/// its format is not known.
std::vector<Grid> read_grids(const std::filesystem::path& path, const ReadOptions& options);

/// Whether read_grids() is for this file, by its content first and its name second; it may be
/// damaged all the same. A file of cube or CHGCAR is one of particles as well. Throws Error if the
/// file cannot be opened.
bool is_grid_file(const std::filesystem::path& path);

/// Name of the format by which read_grids() reads the file. Precondition: is_grid_file().
std::string_view grid_format(const std::filesystem::path& path);

}  // namespace motes
