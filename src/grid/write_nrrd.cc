// NRRD: teem.sourceforge.net/nrrd/format.html
#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <memory>
#include <new>
#include <string>

#include "core/atomic_file.h"
#include "grid/value_bytes.h"
#include "grid/write_grid.h"

namespace motes {

namespace {

/// `text` in one line, without what would end it or a quotation in it.
std::string in_one_line(std::string_view text) {
  std::string out(text);
  std::replace_if(
      out.begin(), out.end(),
      [](char c) { return static_cast<unsigned char>(c) < ' ' || c == '"'; }, ' ');
  return out;
}

std::string header_of(const Grid& grid, NrrdEncoding encoding) {
  const auto vector = [](const auto& v) { return fmt::format("({},{},{})", v.x, v.y, v.z); };
  std::string header = "NRRD0004\n";
  header += fmt::format("content: {}\n", in_one_line(grid.name));
  header += fmt::format("type: float\ndimension: 3\nspace dimension: 3\nsizes: {} {} {}\n",
                        grid.dims[0], grid.dims[1], grid.dims[2]);
  header += fmt::format("space directions: {} {} {}\nspace origin: {}\n", vector(grid.steps[0]),
                        vector(grid.steps[1]), vector(grid.steps[2]), vector(grid.origin));
  if (grid.length_unit != "unknown") {
    header += fmt::format("space units: \"{0}\" \"{0}\" \"{0}\"\n", in_one_line(grid.length_unit));
  }
  header += fmt::format("kinds: domain domain domain\ncenters: node node node\nendian: {}\n",
                        is_little_endian ? "little" : "big");
  header += fmt::format("encoding: {}\n\n", encoding == NrrdEncoding::gzip ? "gzip" : "raw");
  return header;
}

/// Writes `bytes` as one member of gzip.
void write_gzip(AtomicFile& file, std::string_view bytes) {
  // The mantissas of floats hardly compress, whatever the effort.
  constexpr int level = 1;
  constexpr int gzip_window_bits = 15 + 16;
  constexpr std::size_t block_bytes = std::size_t{1} << 20;
  z_stream stream{};
  if (deflateInit2(&stream, level, Z_DEFLATED, gzip_window_bits, 8, Z_DEFAULT_STRATEGY) != Z_OK) {
    throw std::bad_alloc();
  }
  const std::unique_ptr<z_stream, int (*)(z_stream*)> guard(&stream, deflateEnd);
  std::string out(block_bytes, '\0');
  int result = Z_OK;
  while (result != Z_STREAM_END) {
    if (stream.avail_in == 0) {
      const std::string_view block = bytes.substr(0, block_bytes);
      bytes.remove_prefix(block.size());
      stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(block.data()));
      stream.avail_in = static_cast<uInt>(block.size());
    }
    stream.next_out = reinterpret_cast<Bytef*>(out.data());
    stream.avail_out = static_cast<uInt>(out.size());
    result = deflate(&stream, bytes.empty() ? Z_FINISH : Z_NO_FLUSH);
    file.write(std::string_view(out).substr(0, out.size() - stream.avail_out));
  }
}

}  // namespace

void write_nrrd(AtomicFile& file, const Grid& grid, NrrdEncoding encoding) {
  file.write(header_of(grid, encoding));
  if (encoding == NrrdEncoding::gzip) {
    write_gzip(file, value_bytes(grid));
  } else {
    file.write(value_bytes(grid));
  }
}

void write_nrrd(const std::filesystem::path& path, const Grid& grid, NrrdEncoding encoding) {
  AtomicFile file(path);
  write_nrrd(file, grid, encoding);
  file.commit();
}

}  // namespace motes
