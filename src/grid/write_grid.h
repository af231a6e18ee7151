// Writing grids into files that other programs read.
#pragma once

#include <filesystem>
#include <span>

#include "core/atomic_file.h"
#include "particles/grid.h"

namespace motes {

enum class NrrdEncoding { raw, gzip };

/// Writes one grid as NRRD with an attached header: float values, `space directions` and `space
/// origin` in full precision, the length unit as `space units`, the name as `content`. That it is
/// periodic is not kept. Whole or not at all; throws Error as AtomicFile does.
void write_nrrd(const std::filesystem::path& path, const Grid& grid,
                NrrdEncoding encoding = NrrdEncoding::raw);
/// Into a file that is open, and that the caller commits.
void write_nrrd(AtomicFile& file, const Grid& grid, NrrdEncoding encoding = NrrdEncoding::raw);

enum class VtiEncoding { raw, base64 };

/// Writes grids of one lattice as the point data of one VTI file, each a Float32 array of its name
/// with its values appended. Steps become Spacing and the columns of Direction, which need not be
/// at right angles; unit and periodicity are not kept. Whole or not at all; throws Error as
/// AtomicFile does.
void write_vti(const std::filesystem::path& path, std::span<const Grid> grids,
               VtiEncoding encoding = VtiEncoding::raw);
/// Into a file that is open, and that the caller commits.
void write_vti(AtomicFile& file, std::span<const Grid> grids,
               VtiEncoding encoding = VtiEncoding::raw);

}  // namespace motes
