// Gaussian's cube files: atoms, and values on a grid around them (gaussian.com/cubegen;
// paulbourke.net/dataformats/cube).
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "io/bytes.h"
#include "io/formats.h"
#include "io/grid_format.h"
#include "io/in_memory.h"
#include "io/move_into_cell.h"
#include "io/number_text.h"
#include "io/scalars.h"
#include "io/table.h"
#include "io/text_head.h"
#include "io/type_names.h"
#include "particles/elements.h"

namespace motes {

namespace {

constexpr double angstrom_per_bohr = 0.529177210903;  // CODATA 2018

/// All that stands before the values.
struct CubeHeader {
  ParticleSet atoms;
  Grid shape;                      ///< of each grid, without values
  std::vector<std::string> names;  ///< of the values of a voxel
};

/// "COUNT x y z", a line of the header, and perhaps one number behind it.
struct CountAndVector {
  std::int64_t count = 0;
  Vector3d vector;
  std::int64_t behind = 1;
};

CountAndVector read_count_and_vector(LineReader& lines, std::string_view expected,
                                     std::size_t most_tokens) {
  constexpr std::int64_t most = 1000000000;
  const std::string_view line = lines.next(expected);
  const auto tokens = split_tokens(line);
  CountAndVector out;
  bool good = tokens.size() >= 4 && tokens.size() <= most_tokens;
  if (good) {
    const auto count = to_integer(tokens[0]);
    good = count && *count >= -most && *count <= most;
    out.count = good ? *count : 0;
    for (int axis = 0; axis < 3; ++axis) {
      const auto value = to_real(tokens[static_cast<std::size_t>(axis) + 1]);
      good = good && value;
      out.vector[axis] = value.value_or(0);
    }
    const auto behind = tokens.size() > 4 ? to_integer(tokens[4]) : out.behind;
    good = good && behind;
    out.behind = behind.value_or(0);
  }
  if (!good) lines.fail(fmt::format("expected {}, found '{}'", expected, printable(trim(line))));
  return out;
}

/// Dimensions and steps, in the unit of the file; returns whether that is the angstrom.
bool read_axes(LineReader& lines, Grid& shape) {
  constexpr std::string_view expected = "a number of voxels and their vector";
  int num_negative = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const CountAndVector row = read_count_and_vector(lines, expected, 4);
    if (row.count == 0) lines.fail("expected a number of voxels other than 0");
    num_negative += row.count < 0 ? 1 : 0;
    shape.dims[axis] = static_cast<std::size_t>(std::abs(row.count));
    shape.steps[axis] = row.vector;
  }
  if (num_negative % 3 != 0) {
    lines.fail("expected numbers of voxels of one sign: positive in bohr, negative in angstrom");
  }
  return num_negative > 0;
}

/// The second column says something where it is not the element's number again: the charge of a
/// pseudopotential's core, or a partial charge.
void take_charges(std::vector<float>& charges, const std::vector<std::int64_t>& numbers,
                  ParticleSet& atoms) {
  const bool zero = std::all_of(charges.begin(), charges.end(), [](float q) { return q == 0; });
  const bool same =
      std::equal(charges.begin(), charges.end(), numbers.begin(),
                 [](float q, std::int64_t number) { return q == static_cast<float>(number); });
  if (!zero && !same) atoms.properties.push_back({"charge", std::move(charges)});
}

/// Into the cell, if there is one.
void read_atoms(const std::filesystem::path& path, LineReader& lines, std::uint64_t count,
                double unit, const std::optional<Cell>& periodic_cell, const ReadOptions& options,
                ParticleSet& atoms) {
  std::vector<Column> columns{{.name = "number", .kind = Column::Kind::integer},
                              {.name = "charge", .kind = Column::Kind::single}};
  for (const char* axis : {"x", "y", "z"}) {
    columns.push_back({.name = axis, .kind = Column::Kind::real});
  }
  parse_table(path, lines.take_rows(count, "atoms"), count, RowWidth::exact, columns, options);
  for (std::size_t axis = 2; axis < 5; ++axis) {
    for (double& v : columns[axis].reals) v *= unit;
  }
  name_elements(columns[0].integers, atoms);
  take_charges(columns[1].singles, columns[0].integers, atoms);
  if (periodic_cell) {
    move_into_cell(*periodic_cell, columns[2].reals, columns[3].reals, columns[4].reals);
  }
  set_positions(atoms, columns[2].reals, columns[3].reals, columns[4].reals);
}

/// "COUNT number number ...", over as many lines as it takes.
std::vector<std::string> read_orbitals(LineReader& lines) {
  constexpr std::string_view expected = "the number of orbitals and which they are";
  std::vector<std::string> names;
  std::uint64_t count = 0;
  do {
    const std::string_view line = lines.next(expected);
    for (const std::string_view token : split_tokens(line)) {
      const std::uint64_t number = lines.parse_count(token, expected);
      if (count == 0) {
        if (number == 0) lines.fail("expected at least 1 orbital, found '0'");
        count = number;
      } else {
        names.push_back(fmt::format("orbital_{}", number));
      }
    }
    if (names.size() > count) {
      lines.fail(fmt::format("expected {} orbitals, found {}", count, names.size()));
    }
  } while (count == 0 || names.size() < count);
  return names;
}

std::vector<std::string> numbered_names(std::int64_t count) {
  if (count == 1) return {"value"};
  std::vector<std::string> names;
  for (std::int64_t i = 1; i <= count; ++i) names.push_back(fmt::format("value_{}", i));
  return names;
}

/// The box that the voxels fill.
Cell cell_of(const Grid& shape) {
  Cell cell{shape.origin, {}, {shape.periodic, shape.periodic, shape.periodic}};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    cell.vectors[axis] = static_cast<double>(shape.dims[axis]) * shape.steps[axis];
  }
  return cell;
}

CubeHeader read_header(const std::filesystem::path& path, LineReader& lines,
                       const ReadOptions& options) {
  const std::string_view title = lines.next("a title line");
  const std::string_view second_title = lines.next("a second title line");
  const CountAndVector first =
      read_count_and_vector(lines, "the number of atoms and the grid's origin", 5);
  constexpr std::int64_t most_values = 1000;
  const bool has_orbitals = first.count < 0;
  if (first.behind < 1 || first.behind > (has_orbitals ? 1 : most_values)) {
    lines.fail(fmt::format("expected a number of values a voxel of 1{}, found {}",
                           has_orbitals ? "" : " to 1000", first.behind));
  }
  CubeHeader header;
  const double unit = read_axes(lines, header.shape) ? 1 : angstrom_per_bohr;
  header.shape.origin = Point3d{} + unit * first.vector;
  for (Vector3d& step : header.shape.steps) step = unit * step;
  header.shape.length_unit = "angstrom";
  // Quantum ESPRESSO's words for one period of a periodic function. Nothing else tells.
  header.shape.periodic = title.find("PWScf") != std::string_view::npos ||
                          second_title.find("FFT grid") != std::string_view::npos;

  check_steps(path, header.shape);
  std::optional<Cell> cell;
  if (header.shape.periodic) cell = cell_of(header.shape);
  read_atoms(path, lines, static_cast<std::uint64_t>(std::abs(first.count)), unit, cell, options,
             header.atoms);
  header.names = has_orbitals ? read_orbitals(lines) : numbered_names(first.behind);
  return header;
}

std::unique_ptr<Trajectory> open_cube(const std::filesystem::path& path,
                                      const ReadOptions& options) {
  CubeHeader header = parse_head(
      path, options, [&](LineReader& lines) { return read_header(path, lines, options); });
  header.atoms.length_unit = header.shape.length_unit;
  header.atoms.cell = cell_of(header.shape);
  std::vector<ParticleSet> frames;
  frames.push_back(std::move(header.atoms));
  return std::make_unique<InMemoryTrajectory>("cube", path, std::move(frames));
}

std::vector<Grid> read_cube_grids(const std::filesystem::path& path, const ReadOptions& options) {
  const FileContent content(path, options);
  LineReader lines(path, {content.bytes(), 1}, true);
  const CubeHeader header = read_header(path, lines, options);
  const auto& dims = header.shape.dims;
  const std::size_t num_fields = header.names.size();
  const std::uint64_t num_samples = count_samples(path, dims, num_fields);
  const NumberText numbers(path, lines.rest(), num_samples * num_fields);
  expect_no_more(path, numbers.rest(), num_samples * num_fields);
  numbers.warn_if_open(options);

  std::vector<Grid> grids;
  for (const std::string& name : header.names) {
    grids.push_back(header.shape);
    grids.back().name = name;
    grids.back().values.resize(num_samples);
  }
  // z runs fastest and x slowest, and a voxel's values lie side by side.
  numbers.parse(options, [&](std::uint64_t n, double value) {
    const std::uint64_t voxel = n / num_fields;
    const std::uint64_t k = voxel % dims[2], j = voxel / dims[2] % dims[1];
    const std::uint64_t i = voxel / dims[2] / dims[1];
    grids[n % num_fields].values[header.shape.index(i, j, k)] = static_cast<float>(value);
  });
  return grids;
}

/// "COUNT x y z" in `line`, with this number of tokens or, on the first of these lines, one more.
bool is_count_and_vector(std::string_view line, std::size_t num_tokens, std::size_t most_tokens) {
  const auto tokens = split_tokens(line);
  if (tokens.size() < num_tokens || tokens.size() > most_tokens || !to_integer(tokens[0])) {
    return false;
  }
  return std::all_of(tokens.begin() + 1, tokens.end(),
                     [](std::string_view token) { return to_real(token).has_value(); });
}

/// Five lines of a count and a vector behind two titles, of which the last, the first atom's, has
/// its charge too. That also tells it from an XYZ file with numbers for names.
bool matches_cube(std::string_view head) {
  std::array<std::string_view, 7> lines;
  for (auto& line : lines) {
    const std::size_t newline = head.find('\n');
    line = head.substr(0, newline);
    head.remove_prefix(newline == std::string_view::npos ? head.size() : newline + 1);
  }
  return is_count_and_vector(lines[2], 4, 5) && is_count_and_vector(lines[3], 4, 4) &&
         is_count_and_vector(lines[4], 4, 4) && is_count_and_vector(lines[5], 4, 4) &&
         is_count_and_vector(lines[6], 5, 5);
}

}  // namespace

const Format& cube_format() {
  static const Format format{"cube", {".cube", ".cub"}, matches_cube, open_cube};
  return format;
}

const GridFormat& cube_grid_format() {
  static const GridFormat format{"cube", {".cube", ".cub"}, matches_cube, read_cube_grids};
  return format;
}

}  // namespace motes
