// The XML of a VTI file: the lattice, and where the values of its arrays are.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "particles/grid.h"

namespace motes {

/// One <DataArray>, as it is described.
struct VtiArray {
  std::string name, type;
  std::uint64_t num_components = 1;
  bool of_cells = false;     ///< of <CellData>, not <PointData>
  std::string format;        ///< ascii, binary or appended
  std::uint64_t offset = 0;  ///< of an appended one: from the beginning of the appended data
  std::string text;          ///< of the others: the values
  std::uint64_t line = 0;
};

struct VtiHeader {
  Grid points;  ///< of the lattice, without values
  bool big_endian = false;
  std::size_t header_bytes = 4;  ///< of the numbers that stand before an array's values
  bool compressed = false;       ///< by zlib
  std::vector<VtiArray> arrays;
  std::string_view appended;  ///< the appended data, and what follows them
  bool appended_base64 = false;
};

/// Parses the whole content of a file. The result looks into `content`. Throws Error, with the
/// line, for what is no VTK file of image data in one piece.
VtiHeader parse_vti(const std::filesystem::path& path, std::string_view content);

}  // namespace motes
