// VTI: image data of VTK's XML files, as text, in base64 or as raw bytes, plain or compressed by
// zlib.
#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <map>
#include <numeric>
#include <optional>
#include <string>
#include <utility>

#include "core/base64.h"
#include "core/error.h"
#include "io/bytes.h"
#include "io/grid_format.h"
#include "io/number_text.h"
#include "io/row_loop.h"
#include "io/scalars.h"
#include "io/vti_header.h"

namespace motes {

namespace {

std::optional<ScalarType> scalar_type(std::string_view name) {
  static const std::map<std::string_view, ScalarType> types{
      {"Int8", ScalarType::int8},       {"UInt8", ScalarType::uint8},
      {"Int16", ScalarType::int16},     {"UInt16", ScalarType::uint16},
      {"Int32", ScalarType::int32},     {"UInt32", ScalarType::uint32},
      {"Int64", ScalarType::int64},     {"UInt64", ScalarType::uint64},
      {"Float32", ScalarType::float32}, {"Float64", ScalarType::float64},
  };
  const auto it = types.find(name);
  return it == types.end() ? std::nullopt : std::optional(it->second);
}

/// The values of one array.
class ArrayReader {
 public:
  ArrayReader(const std::filesystem::path& path, const VtiHeader& header, const VtiArray& array,
              ScalarType type, const std::array<std::size_t, 3>& dims, const ReadOptions& options)
      : path_(path),
        header_(header),
        array_(array),
        type_(type),
        dims_(dims),
        num_samples_(count_samples(path, dims)),
        options_(options) {}

  UninitializedVector<float> read() {
    UninitializedVector<float> values;
    if (array_.format == "ascii") {
      read_text(values);
    } else if (header_.compressed) {
      read_blocks(values);
    } else {
      read_plain(values);
    }
    return values;
  }

 private:
  [[noreturn]] void fail(const std::string& message) const {
    throw Error(path_, array_.line, fmt::format("array '{}': {}", printable(array_.name), message));
  }

  std::string samples_of_extent() const {
    return fmt::format("{} x {} x {} {} by the Extent", dims_[0], dims_[1], dims_[2],
                       array_.of_cells ? "cells" : "points");
  }

  std::uint64_t value_bytes() const { return num_samples_ * size_of(type_); }

  void read_text(UninitializedVector<float>& values) const {
    const TextBlock text{array_.text, array_.line};
    const std::string what =
        fmt::format("array '{}' of {}", printable(array_.name), samples_of_extent());
    const NumberText numbers(path_, text, num_samples_, what);
    expect_no_more(path_, numbers.rest(), num_samples_, what);
    values.resize(num_samples_);
    numbers.parse(options_,
                  [&](std::uint64_t n, double value) { values[n] = static_cast<float>(value); });
  }

  /// The bytes that the file has for the array: those appended end where the next array begins, or
  /// their XML element.
  std::string_view stored() const {
    if (array_.format != "appended") return array_.text;
    if (array_.offset > header_.appended.size()) {
      fail(fmt::format("begins at byte {} of the appended data; expected at most {}", array_.offset,
                       header_.appended.size()));
    }
    std::uint64_t end = header_.appended.rfind("</AppendedData");  // (raw bytes may hold that too)
    for (const VtiArray& other : header_.arrays) {
      if (other.format == "appended" && other.offset > array_.offset) {
        end = std::min(end, other.offset);
      }
    }
    end = std::max(end, array_.offset);
    const std::string_view rest = header_.appended.substr(array_.offset, end - array_.offset);
    // (text ends where XML goes on)
    return header_.appended_base64 ? rest.substr(0, rest.find('<')) : rest;
  }

  /// The array's first `count` bytes, or all that the file has, decoded into `storage` if they must
  /// be.
  std::string_view at_most(std::uint64_t count, std::string& storage) const {
    const std::string_view stored = this->stored();
    if (array_.format != "binary" && !header_.appended_base64) return stored.substr(0, count);
    auto bytes = decode_base64(stored, count);
    if (!bytes) fail("is no good base64");
    storage = std::move(*bytes);
    return storage;
  }
  std::string_view first_bytes(std::uint64_t count, std::string& storage) const {
    const std::string_view bytes = at_most(count, storage);
    if (bytes.size() < count) fail(fmt::format("ends after {} of {} bytes", bytes.size(), count));
    return bytes;
  }

  /// How the numbers in front of the values are stored.
  struct NumberLayout {
    bool big_endian;
    std::size_t width;  ///< bytes of a number
  };
  NumberLayout layout() const { return {header_.big_endian, header_.header_bytes}; }
  std::size_t other_width() const { return 12 - header_.header_bytes; }

  /// Number `index` of those that stand before the values.
  static std::uint64_t header_number(std::string_view bytes, std::size_t index,
                                     const NumberLayout& layout) {
    const char* const at = bytes.data() + index * layout.width;
    return layout.width == 8 ? load_scalar<std::uint64_t>(at, layout.big_endian)
                             : load_scalar<std::uint32_t>(at, layout.big_endian);
  }
  std::uint64_t header_number(std::string_view bytes, std::size_t index) const {
    return header_number(bytes, index, layout());
  }

  static std::string_view order_name(bool big_endian) {
    return big_endian ? "BigEndian" : "LittleEndian";
  }
  static std::string_view type_name(std::size_t width) { return width == 8 ? "UInt64" : "UInt32"; }

  /// `size_in(bytes, layout)`: bytes of all values as the first `count` numbers in front of them
  /// say it, read so, in floating point, so that no product can overflow.
  template <class Size>
  void expect_size(std::size_t count, Size&& size_in) const {
    const auto expected = static_cast<double>(value_bytes());
    std::string storage;
    const double found = size_in(first_bytes(count * layout().width, storage), layout());
    if (found == expected) return;
    const std::string_view bytes = at_most(8 * count, storage);
    const auto fits = [&](const NumberLayout& other) {
      return bytes.size() >= count * other.width && size_in(bytes, other) == expected;
    };
    std::string hint;
    if (fits({!header_.big_endian, header_.header_bytes})) {
      hint =
          fmt::format("; with byte_order=\"{}\" it holds these", order_name(!header_.big_endian));
    } else if (fits({header_.big_endian, other_width()})) {
      hint = fmt::format("; with header_type=\"{}\" it holds these", type_name(other_width()));
    }
    fail(fmt::format("holds {:.0f} bytes; expected {} for {} samples of {} bytes, {}{}", found,
                     value_bytes(), num_samples_, size_of(type_), samples_of_extent(), hint));
  }

  void warn_if_swapped(std::string_view bytes) const {
    if (options_.warnings == nullptr || !looks_swapped(bytes, type_, header_.big_endian)) return;
    options_.warnings->add(
        Error(path_, array_.line,
              fmt::format("array '{}' has values that make no sense with byte_order=\"{}\", but "
                          "would in the other order of bytes",
                          printable(array_.name), order_name(header_.big_endian)))
            .what());
  }

  /// [number of bytes][bytes]
  void read_plain(UninitializedVector<float>& values) const {
    expect_size(1, [](std::string_view bytes, const NumberLayout& layout) {
      return static_cast<double>(header_number(bytes, 0, layout));
    });
    check_header_type();
    std::string storage;
    const std::size_t width = header_.header_bytes;
    const std::string_view bytes = first_bytes(width + value_bytes(), storage).substr(width);
    warn_if_swapped(bytes);
    values.resize(num_samples_);
    convert_scalars(bytes, type_, header_.big_endian, values);
  }

  /// The number in front of the values may be the same in 4 bytes and in 8, and the values then
  /// begin elsewhere: they should end where the file's bytes for them do, but for blanks.
  void check_header_type() const {
    std::string storage;
    const std::size_t width = header_.header_bytes, other = other_width();
    const std::string_view bytes = at_most(width + other + value_bytes(), storage);
    const auto ends_behind = [&](std::size_t front) {
      if (bytes.size() < front + value_bytes()) return false;
      return bytes.find_first_not_of(" \t\r\n", front + value_bytes()) == std::string_view::npos;
    };
    if (ends_behind(width) || !ends_behind(other)) return;
    if (header_number(bytes, 0, {header_.big_endian, other}) != value_bytes()) return;
    fail(fmt::format("does not end behind its {} bytes; with header_type=\"{}\" it would",
                     value_bytes(), type_name(other)));
  }

  struct Block {
    std::string_view compressed;
    std::uint64_t first = 0, count = 0;  ///< samples
  };

  void read_blocks(UninitializedVector<float>& values) const {
    std::string storage;
    const std::vector<Block> blocks = find_blocks(storage);
    values.resize(num_samples_);
    for_each_chunk(
        path_, blocks.size(),
        [&](std::size_t i) {
          const Block& block = blocks[i];
          std::string bytes(block.count * size_of(type_), '\0');
          auto size = static_cast<uLongf>(bytes.size());
          const int result = uncompress(reinterpret_cast<Bytef*>(bytes.data()), &size,
                                        reinterpret_cast<const Bytef*>(block.compressed.data()),
                                        static_cast<uLong>(block.compressed.size()));
          if (result != Z_OK || size != bytes.size()) {
            fail(fmt::format("block {} of {} cannot be decompressed", i + 1, blocks.size()));
          }
          if (i == 0) warn_if_swapped(bytes);
          convert_scalars(bytes, type_, header_.big_endian,
                          std::span(values).subspan(block.first, block.count));
        },
        options_);
  }

  /// [number of blocks][bytes of a block][bytes of the last one, 0 if it is whole][compressed bytes
  /// of each block][blocks]
  std::vector<Block> find_blocks(std::string& storage) const {
    const std::size_t width = header_.header_bytes;
    std::string_view bytes = first_bytes(3 * width, storage);
    expect_size(3, [](std::string_view numbers, const NumberLayout& layout) {
      const auto number = [&](std::size_t k) {
        return static_cast<double>(header_number(numbers, k, layout));
      };
      return (number(0) - (number(2) > 0 ? 1 : 0)) * number(1) + number(2);
    });
    const std::uint64_t num_blocks = header_number(bytes, 0);
    const std::uint64_t block_bytes = header_number(bytes, 1);
    const std::uint64_t partial_bytes = header_number(bytes, 2);
    if (num_blocks == 0 || block_bytes == 0) fail("has no blocks; expected compressed values");
    const std::uint64_t num_whole = num_blocks - (partial_bytes > 0 ? 1 : 0);
    if (block_bytes % size_of(type_) != 0 || partial_bytes % size_of(type_) != 0) {
      fail(fmt::format("has blocks of {} bytes; expected whole values of {}", block_bytes,
                       size_of(type_)));
    }
    const std::uint64_t table_bytes = (3 + num_blocks) * width;
    const std::vector<std::uint64_t> sizes =
        compressed_sizes(first_bytes(table_bytes, storage), num_blocks);
    const std::uint64_t all = std::accumulate(sizes.begin(), sizes.end(), std::uint64_t{0});
    check_ratio(all);
    bytes = first_bytes(table_bytes + all, storage).substr(table_bytes);
    std::vector<Block> blocks(num_blocks);
    std::uint64_t first = 0;
    for (std::size_t i = 0; i < num_blocks; ++i) {
      const std::uint64_t size = i < num_whole ? block_bytes : partial_bytes;
      blocks[i] = {bytes.substr(0, sizes[i]), first, size / size_of(type_)};
      bytes.remove_prefix(sizes[i]);
      first += blocks[i].count;
    }
    return blocks;
  }

  /// Of each block; in sum no more than what is stored at all.
  std::vector<std::uint64_t> compressed_sizes(std::string_view table,
                                              std::uint64_t num_blocks) const {
    std::vector<std::uint64_t> sizes(num_blocks);
    std::uint64_t left = stored().size();
    for (std::size_t i = 0; i < num_blocks; ++i) {
      sizes[i] = header_number(table, 3 + i);
      if (sizes[i] > left) {
        fail(fmt::format("ends before block {} of {} is whole", i + 1, num_blocks));
      }
      left -= sizes[i];
    }
    return sizes;
  }

  /// Deflate cannot make more than 1032 bytes of one (zlib.net/zlib_tech.html): memory is taken
  /// only for what may be there.
  void check_ratio(std::uint64_t compressed_bytes) const {
    constexpr double most = 1032;
    if (static_cast<double>(value_bytes()) > most * static_cast<double>(compressed_bytes)) {
      fail(fmt::format("has {} compressed bytes, which cannot be {} values", compressed_bytes,
                       num_samples_));
    }
  }

  const std::filesystem::path& path_;
  const VtiHeader& header_;
  const VtiArray& array_;
  ScalarType type_;
  std::array<std::size_t, 3> dims_;
  std::uint64_t num_samples_;
  const ReadOptions& options_;
};

/// The lattice of the middles of the cells between the points. An axis with a single point has flat
/// cells around it.
Grid cell_lattice(Grid points) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (points.dims[axis] == 1) continue;
    --points.dims[axis];
    points.origin = points.origin + 0.5 * points.steps[axis];
  }
  return points;
}

std::vector<Grid> read_vti(const std::filesystem::path& path, const ReadOptions& options) {
  const FileContent content(path, options);
  const VtiHeader header = parse_vti(path, content.bytes());
  check_steps(path, header.points);
  std::vector<Grid> grids;
  for (const VtiArray& array : header.arrays) {
    const auto type = scalar_type(array.type);
    if (!type || array.num_components != 1) {
      if (options.warnings == nullptr) continue;
      options.warnings->add(
          Error(path, array.line,
                fmt::format("array '{}' has {} values of type {} a sample and is left out",
                            printable(array.name), array.num_components, printable(array.type)))
              .what());
      continue;
    }
    Grid grid = array.of_cells ? cell_lattice(header.points) : header.points;
    grid.name = array.name;
    grid.values = ArrayReader(path, header, array, *type, grid.dims, options).read();
    grids.push_back(std::move(grid));
  }
  if (grids.empty()) {
    throw Error(path, "has no array with one number a sample; expected PointData or CellData");
  }
  return grids;
}

bool matches_vti(std::string_view head) {
  const std::size_t begin = head.find("<VTKFile");
  if (begin == std::string_view::npos) return false;
  const std::string_view tag = head.substr(begin, head.find('>', begin) - begin);
  return tag.find("ImageData") != std::string_view::npos;
}

}  // namespace

const GridFormat& vti_format() {
  static const GridFormat format{"VTI", {".vti"}, matches_vti, read_vti};
  return format;
}

}  // namespace motes
