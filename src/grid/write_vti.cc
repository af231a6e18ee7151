// VTK's XML image data: docs.vtk.org/en/latest/design_documents/VTKFileFormats.html
#include <fmt/format.h>

#include <array>
#include <cassert>
#include <cstdint>
#include <string>
#include <utility>

#include "core/atomic_file.h"
#include "core/base64.h"
#include "grid/value_bytes.h"
#include "grid/write_grid.h"

namespace motes {

namespace {

/// `text` as the value of an attribute.
std::string in_xml(std::string_view text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '"':
        out += "&quot;";
        break;
      default:
        out += static_cast<unsigned char>(c) < ' ' ? ' ' : c;
    }
  }
  return out;
}

/// What stands before an array's values: their number of bytes.
std::string size_header(const Grid& grid) {
  const std::uint64_t size = value_bytes(grid).size();
  return {reinterpret_cast<const char*>(&size), sizeof(size)};
}

/// Bytes that an array takes among the appended data.
std::size_t stored_size(const Grid& grid, VtiEncoding encoding) {
  const std::size_t size = sizeof(std::uint64_t) + value_bytes(grid).size();
  return encoding == VtiEncoding::base64 ? (size + 2) / 3 * 4 : size;
}

std::string header_of(std::span<const Grid> grids, VtiEncoding encoding) {
  const Grid& first = grids[0];
  std::array<double, 3> spacing{};
  for (std::size_t axis = 0; axis < 3; ++axis) spacing[axis] = length(first.steps[axis]);
  std::string direction;
  for (int row = 0; row < 3; ++row) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      direction +=
          fmt::format("{}{}", direction.empty() ? "" : " ", first.steps[axis][row] / spacing[axis]);
    }
  }
  const std::string extent =
      fmt::format("0 {} 0 {} 0 {}", first.dims[0] - 1, first.dims[1] - 1, first.dims[2] - 1);
  std::string header = fmt::format(
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"ImageData\" version=\"1.0\" byte_order=\"{}\" "
      "header_type=\"UInt64\">\n",
      is_little_endian ? "LittleEndian" : "BigEndian");
  header += fmt::format(
      "<ImageData WholeExtent=\"{}\" Origin=\"{} {} {}\" Spacing=\"{} {} {}\" Direction=\"{}\">\n",
      extent, first.origin.x, first.origin.y, first.origin.z, spacing[0], spacing[1], spacing[2],
      direction);
  header += fmt::format("<Piece Extent=\"{}\">\n<PointData Scalars=\"{}\">\n", extent,
                        in_xml(first.name));
  std::size_t offset = 0;
  for (const Grid& grid : grids) {
    header +=
        fmt::format("<DataArray type=\"Float32\" Name=\"{}\" format=\"appended\" offset=\"{}\"/>\n",
                    in_xml(grid.name), offset);
    offset += stored_size(grid, encoding);
  }
  header += fmt::format("</PointData>\n</Piece>\n</ImageData>\n<AppendedData encoding=\"{}\">\n_",
                        encoding == VtiEncoding::base64 ? "base64" : "raw");
  return header;
}

void write_base64(AtomicFile& file, std::string head, std::string_view bytes) {
  constexpr std::size_t block_bytes = 3 << 18;  // whole groups of three, so that blocks join
  for (std::string block = std::move(head); !block.empty();) {
    const std::string_view next = bytes.substr(0, block_bytes - block.size());
    bytes.remove_prefix(next.size());
    file.write(encode_base64(block.append(next)));
    block = bytes.substr(0, 3);
    bytes.remove_prefix(block.size());
  }
}

}  // namespace

void write_vti(AtomicFile& file, std::span<const Grid> grids, VtiEncoding encoding) {
  assert(!grids.empty());
  file.write(header_of(grids, encoding));
  for (const Grid& grid : grids) {
    assert(grid.dims == grids[0].dims && grid.origin == grids[0].origin &&
           grid.steps == grids[0].steps);
    if (encoding == VtiEncoding::base64) {
      write_base64(file, size_header(grid), value_bytes(grid));
    } else {
      file.write(size_header(grid));
      file.write(value_bytes(grid));
    }
  }
  file.write("\n</AppendedData>\n</VTKFile>\n");
}

void write_vti(const std::filesystem::path& path, std::span<const Grid> grids,
               VtiEncoding encoding) {
  AtomicFile file(path);
  write_vti(file, grids, encoding);
  file.commit();
}

}  // namespace motes
