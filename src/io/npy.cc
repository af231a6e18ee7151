// NumPy's arrays, format versions 1 to 3:
// numpy.org/doc/stable/reference/generated/numpy.lib.format.html
#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <optional>

#include "io/bytes.h"
#include "io/formats.h"
#include "io/in_memory.h"
#include "io/npy_header.h"
#include "io/scalars.h"
#include "io/table.h"
#include "io/type_names.h"

namespace motes {

namespace {

/// One number of an array as a double.
double load_number(const NpyField& field, const char* bytes) {
  const bool swap = field.big_endian;
  switch (field.kind) {
    case 'f':
      return field.size == 4 ? load_scalar<float>(bytes, swap) : load_scalar<double>(bytes, swap);
    case 'i':
      switch (field.size) {
        case 1:
          return load_scalar<std::int8_t>(bytes, swap);
        case 2:
          return load_scalar<std::int16_t>(bytes, swap);
        case 4:
          return load_scalar<std::int32_t>(bytes, swap);
        default:
          return static_cast<double>(load_scalar<std::int64_t>(bytes, swap));
      }
    default:  // 'u' and 'b'
      switch (field.size) {
        case 1:
          return load_scalar<std::uint8_t>(bytes, swap);
        case 2:
          return load_scalar<std::uint16_t>(bytes, swap);
        case 4:
          return load_scalar<std::uint32_t>(bytes, swap);
        default:
          return static_cast<double>(load_scalar<std::uint64_t>(bytes, swap));
      }
  }
}

/// Text of an 'S' field, or of a 'U' field whose characters are ASCII ('?' stands for others).
std::string load_text(const NpyField& field, const char* bytes) {
  std::string text;
  const std::size_t width = field.kind == 'U' ? 4 : 1;
  for (std::size_t i = 0; i < field.size; i += width) {
    const std::uint32_t c = width == 4 ? load_scalar<std::uint32_t>(bytes + i, field.big_endian)
                                       : static_cast<unsigned char>(bytes[i]);
    if (c == 0) break;
    text += c < 128 ? static_cast<char>(c) : '?';
  }
  return text;
}

/// Where the values of one column lie: `stride` bytes from one particle to the next.
struct NpyColumn {
  std::string name;
  NpyField field;
  const char* first;
  std::size_t stride;
};

/// The columns of an array N x (3 + k): x, y, z and properties column4, column5, ...
std::vector<NpyColumn> plain_columns(const std::filesystem::path& path, const NpyHeader& header,
                                     const char* data) {
  if (header.shape.size() != 2 || header.shape[1] < 3) {
    throw Error(path, fmt::format("has the shape {}; expected N x 3, or more columns",
                                  header.shape_text()));
  }
  constexpr std::size_t most_columns = 1024;
  const std::size_t num_columns = header.shape[1], num_rows = header.shape[0];
  if (num_columns > most_columns) {
    throw Error(path,
                fmt::format("has {} columns; expected at most {}", num_columns, most_columns));
  }
  const NpyField& field = header.fields[0];
  const std::size_t row_stride = header.fortran_order ? field.size : field.size * num_columns;
  const std::size_t column_stride = header.fortran_order ? field.size * num_rows : field.size;
  std::vector<NpyColumn> columns;
  for (std::size_t k = 0; k < num_columns; ++k) {
    columns.push_back({k < 3 ? std::string(1, "xyz"[k]) : fmt::format("column{}", k + 1), field,
                       data + k * column_stride, row_stride});
  }
  return columns;
}

bool is_position_name(const std::string& name) {
  return name == "pos" || name == "position" || name == "positions" || name == "coordinates" ||
         name == "Coordinates";
}

/// The columns of a structured array: one a field, or three for a field of three values.
std::vector<NpyColumn> structured_columns(const std::filesystem::path& path,
                                          const NpyHeader& header, const char* data) {
  if (header.shape.size() != 1) {
    throw Error(path, fmt::format("has the shape {}; expected one dimension, for it has fields",
                                  header.shape_text()));
  }
  std::vector<NpyColumn> columns;
  for (const NpyField& field : header.fields) {
    for (std::size_t k = 0; k < field.count; ++k) {
      std::string name = field.name;
      if (field.count == 3) {
        const std::string axis(1, "xyz"[k]);
        name = is_position_name(field.name) ? axis : fmt::format("{}_{}", field.name, axis);
      } else if (field.count > 1) {
        name = fmt::format("{}_{}", field.name, k + 1);
      }
      columns.push_back({name, field, data + field.offset + k * field.size, header.item_size});
    }
  }
  return columns;
}

template <class T>
std::vector<T> load_column(const NpyColumn& column, std::size_t num_rows) {
  std::vector<T> values(num_rows);
  for (std::size_t i = 0; i < num_rows; ++i) {
    values[i] = static_cast<T>(load_number(column.field, column.first + i * column.stride));
  }
  return values;
}

/// Names of species, or numbers of types.
Column load_species(const std::filesystem::path& path, const NpyColumn& column,
                    std::size_t num_rows) {
  Column types{.name = column.name, .kind = Column::Kind::word};
  types.word_indices.reserve(num_rows);
  for (std::size_t i = 0; i < num_rows; ++i) {
    const char* bytes = column.first + i * column.stride;
    const std::string word = column.field.is_text()
                                 ? load_text(column.field, bytes)
                                 : fmt::format("{}", load_number(column.field, bytes));
    // Nearly always the same as the one before.
    std::size_t index = types.word_indices.empty() ? 0 : types.word_indices.back();
    if (index >= types.words.size() || types.words[index] != word) {
      index = static_cast<std::size_t>(std::find(types.words.begin(), types.words.end(), word) -
                                       types.words.begin());
    }
    if (index == types.words.size()) {
      if (index == 4096) throw Error(path, "has more than 4096 different species; expected fewer");
      types.words.push_back(word);
    }
    types.word_indices.push_back(static_cast<std::uint16_t>(index));
  }
  return types;
}

bool is_species_name(const std::string& name) {
  return name == "species" || name == "element" || name == "symbol" || name == "type";
}

ParticleSet make_particles(const std::filesystem::path& path, const std::vector<NpyColumn>& columns,
                           std::size_t num_rows, const ReadOptions& options) {
  const auto find = [&](std::string_view name) -> const NpyColumn& {
    for (const NpyColumn& column : columns) {
      if (column.name == name && !column.field.is_text()) return column;
    }
    throw Error(path, fmt::format("has no field {}; expected numbers x, y and z", name));
  };
  ParticleSet particles;
  particles.length_unit = "unknown";
  set_positions(particles, load_column<double>(find("x"), num_rows),
                load_column<double>(find("y"), num_rows), load_column<double>(find("z"), num_rows));
  for (const NpyColumn& column : columns) {
    if (column.name == "x" || column.name == "y" || column.name == "z") continue;
    if (is_species_name(column.name)) {
      name_types(path, load_species(path, column, num_rows), {}, options, particles);
    } else if (!column.field.is_text()) {
      particles.properties.push_back({column.name, load_column<float>(column, num_rows)});
    }
  }
  return particles;
}

std::unique_ptr<Trajectory> open_npy(const std::filesystem::path& path,
                                     const ReadOptions& options) {
  const std::string content = read_decompressed(path, options);
  const NpyHeader header = parse_npy_header(path, content);
  const char* data = content.data() + header.data_offset;
  const std::vector<NpyColumn> columns = header.structured ? structured_columns(path, header, data)
                                                           : plain_columns(path, header, data);
  std::vector<ParticleSet> frames;
  frames.push_back(make_particles(path, columns, header.shape[0], options));
  return std::make_unique<InMemoryTrajectory>("NPY", path, std::move(frames));
}

bool matches_npy(std::string_view head) { return head.starts_with("\x93NUMPY"); }

}  // namespace

const Format& npy_format() {
  static const Format format{"NPY", {".npy"}, matches_npy, open_npy};
  return format;
}

}  // namespace motes
