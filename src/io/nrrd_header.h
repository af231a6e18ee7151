// The header of NRRD files: what the values are, and where they lie.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "io/scalars.h"
#include "particles/grid.h"

namespace motes {

enum class NrrdEncoding { raw, text, compressed };

struct NrrdHeader {
  Grid shape;  ///< without values
  ScalarType type = ScalarType::float32;
  bool big_endian = false;
  NrrdEncoding encoding = NrrdEncoding::raw;
  std::string data_file;  ///< as the header names it; empty: the values follow the header
  std::uint64_t line_skip = 0;
  std::int64_t byte_skip = 0;  ///< -1: the values are the last bytes
  std::size_t end = 0;         ///< of the header, in bytes
  std::uint64_t end_line = 1;  ///< the line that begins there
};

/// Parses the header at the front of `content`. Throws Error, with the line, for what is no NRRD
/// header or has another thing than three axes of space with one number a sample.
NrrdHeader parse_nrrd_header(const std::filesystem::path& path, std::string_view content);

}  // namespace motes
