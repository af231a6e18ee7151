// LAMMPS dump files in text, as `dump atom` and `dump custom` write them.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <unordered_set>
#include <utility>

#include "io/bytes.h"
#include "io/formats.h"
#include "io/lammps_units.h"
#include "io/table.h"
#include "io/text_trajectory.h"
#include "io/type_names.h"

namespace motes {

namespace {

/// All that stands before a frame's rows.
struct FrameHeader {
  std::optional<double> timestep, time;
  std::uint64_t num_atoms = 0;
  std::uint64_t box_line = 0;  ///< where the box is; 0 if there is none
  std::optional<Cell> cell;    ///< nothing if the box has no volume
  std::vector<std::string> columns;
};

double parse_number(const LineReader& lines, std::string_view token, std::string_view expected) {
  const auto value = to_real(token);
  if (!value) {
    lines.fail(fmt::format("expected {}, found '{}'", expected, printable(token)));
  }
  return *value;
}

/// One line of the box: exactly `num_values` numbers.
std::vector<double> parse_box_line(LineReader& lines, std::size_t num_values) {
  const std::string_view line = lines.next("a line of the box");
  std::vector<double> values;
  for (const std::string_view token : split_tokens(line)) {
    values.push_back(parse_number(lines, token, "a number of the box"));
  }
  if (values.size() != num_values) {
    lines.fail(fmt::format("expected {} numbers of the box, found {}", num_values, values.size()));
  }
  return values;
}

/// "abc origin": each line an edge vector and a coordinate of the origin.
std::optional<Cell> parse_general_box(LineReader& lines) {
  Cell cell;
  for (int axis = 0; axis < 3; ++axis) {
    const auto v = parse_box_line(lines, 4);
    cell.vectors[static_cast<std::size_t>(axis)] = {v[0], v[1], v[2]};
    cell.origin[axis] = v[3];
  }
  const auto& v = cell.vectors;
  const double volume = dot(v[0], cross(v[1], v[2]));
  if (!std::isfinite(volume) || volume <= 0) return std::nullopt;
  return cell;
}

/// Three lines of bounds, with a tilt factor each (xy, xz, yz) if the box is triclinic; the bounds
/// are then those of the tilted box, and the box's own follow from them
/// (docs.lammps.org/Howto_triclinic.html).
std::optional<Cell> parse_bounds(LineReader& lines, bool triclinic) {
  std::array<std::vector<double>, 3> v;
  for (auto& values : v) values = parse_box_line(lines, triclinic ? 3 : 2);
  const double xy = triclinic ? v[0][2] : 0, xz = triclinic ? v[1][2] : 0;
  const double yz = triclinic ? v[2][2] : 0;
  const double xlo = v[0][0] - std::min({0.0, xy, xz, xy + xz});
  const double xhi = v[0][1] - std::max({0.0, xy, xz, xy + xz});
  const double ylo = v[1][0] - std::min(0.0, yz), yhi = v[1][1] - std::max(0.0, yz);
  const double zlo = v[2][0], zhi = v[2][1];
  for (const double extent : {xhi - xlo, yhi - ylo, zhi - zlo}) {
    if (!std::isfinite(extent) || extent <= 0) return std::nullopt;
  }
  Cell cell;
  cell.origin = {xlo, ylo, zlo};
  cell.vectors = {Vector3d{xhi - xlo, 0, 0}, {xy, yhi - ylo, 0}, {xz, yz, zhi - zlo}};
  return cell;
}

/// `words` follow "ITEM: BOX BOUNDS". Old files do not name the boundaries: they are periodic.
std::optional<Cell> parse_box(LineReader& lines, const std::vector<std::string_view>& words) {
  const auto has = [&](std::string_view word) {
    return std::find(words.begin(), words.end(), word) != words.end();
  };
  auto cell = has("abc") ? parse_general_box(lines) : parse_bounds(lines, has("xy"));
  if (!cell) return std::nullopt;
  std::size_t axis = 0;
  for (const std::string_view word : words) {
    const bool is_boundary =
        word.size() == 2 && word.find_first_not_of("pfsm") == std::string_view::npos;
    if (is_boundary && axis < 3) cell->periodic[axis++] = word == "pp";
  }
  return cell;
}

FrameHeader parse_header(LineReader& lines) {
  FrameHeader header;
  std::optional<std::uint64_t> num_atoms;
  for (;;) {
    std::string_view line = lines.next_filled("'ITEM: ATOMS'");
    if (!line.starts_with("ITEM:")) {
      lines.fail(fmt::format("expected a line that begins with 'ITEM:', found '{}'",
                             printable(trim(line))));
    }
    line = trim(line.substr(5));
    if (line == "UNITS") {
      lines.next("the name of the units");
    } else if (line == "TIME") {
      header.time = parse_number(lines, trim(lines.next("the time")), "the time");
    } else if (line == "TIMESTEP") {
      header.timestep = parse_number(lines, trim(lines.next("the timestep")), "the timestep");
    } else if (line == "NUMBER OF ATOMS") {
      num_atoms = lines.parse_count(lines.next("the number of atoms"), "the number of atoms");
    } else if (line.starts_with("BOX BOUNDS")) {
      header.box_line = lines.line();
      header.cell = parse_box(lines, split_tokens(line.substr(10)));
    } else if (line == "ATOMS" || line.starts_with("ATOMS ")) {
      if (!num_atoms) lines.fail("expected 'ITEM: NUMBER OF ATOMS' before 'ITEM: ATOMS'");
      header.num_atoms = *num_atoms;
      for (const auto name : split_tokens(line.substr(5))) header.columns.emplace_back(name);
      return header;
    } else {
      lines.fail(
          fmt::format("expected ITEM: TIMESTEP, TIME, UNITS, NUMBER OF ATOMS, BOX BOUNDS "
                      "or ATOMS, found '{}'",
                      printable(line)));
    }
  }
}

/// Which columns hold the positions, and whether as fractions of the cell.
struct PositionColumns {
  std::array<std::size_t, 3> index{};
  bool scaled = false;
};

struct Representation {
  std::array<std::string_view, 3> names;
  bool scaled;
};

/// The better one first: wrapped before unwrapped, lengths before fractions.
constexpr std::array<Representation, 4> representations{{{{"x", "y", "z"}, false},
                                                         {{"xs", "ys", "zs"}, true},
                                                         {{"xu", "yu", "zu"}, false},
                                                         {{"xsu", "ysu", "zsu"}, true}}};

bool is_position_name(std::string_view name) {
  return std::any_of(representations.begin(), representations.end(), [&](const auto& r) {
    return std::find(r.names.begin(), r.names.end(), name) != r.names.end();
  });
}

std::optional<PositionColumns> find_positions(const std::vector<std::string>& columns) {
  for (const Representation& representation : representations) {
    PositionColumns found{{}, representation.scaled};
    int num_found = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto it = std::find(columns.begin(), columns.end(), representation.names[axis]);
      num_found += it != columns.end() ? 1 : 0;
      found.index[axis] = static_cast<std::size_t>(it - columns.begin());
    }
    if (num_found == 3) return found;
  }
  return std::nullopt;
}

/// Fractions of the cell to lengths, in place.
void unscale(const Cell& cell, std::vector<double>& x, std::vector<double>& y,
             std::vector<double>& z) {
  const auto& v = cell.vectors;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const Point3d p = cell.origin + (x[i] * v[0] + y[i] * v[1] + z[i] * v[2]);
    x[i] = p.x;
    y[i] = p.y;
    z[i] = p.z;
  }
}

/// The mass of each numeric type, if there is a column of masses: that of its first particle.
TypeHints hints_from_masses(const Column& types, const ParticleSet& particles) {
  TypeHints hints;
  const Property* mass = particles.find_property("mass");
  if (mass == nullptr || types.name != "type") return hints;
  std::vector<bool> seen(types.words.size());
  for (std::size_t i = 0; i < types.word_indices.size(); ++i) {
    const std::uint16_t type = types.word_indices[i];
    if (seen[type]) continue;
    seen[type] = true;
    hints.masses[types.words[type]] = mass->values[i];
  }
  return hints;
}

class LammpsDump : public TextTrajectory {
 public:
  LammpsDump(const std::filesystem::path& path, const ReadOptions& options)
      : TextTrajectory(path, options), length_unit_(find_length_unit(read_head(path))) {}

  std::string_view format() const override { return "LAMMPS dump"; }

 protected:
  void skip_frame(LineReader& lines) const override {
    const FrameHeader header = parse_header(lines);
    lines.skip(header.num_atoms, "atoms");
    // More rows than the header says must not be lost.
    if (!lines.skip_blank_lines()) return;
    const std::string_view next = lines.peek();
    if (next.starts_with("ITEM:") || std::string_view("ITEM:").starts_with(next)) return;
    lines.next("");
    lines.fail(fmt::format("expected a new frame ('ITEM: TIMESTEP') after {} atoms, found '{}'",
                           header.num_atoms, printable(trim(next))));
  }

  ParticleSet parse_frame(TextBlock frame) override {
    LineReader lines(path(), frame, true);
    const FrameHeader header = parse_header(lines);
    const auto positions = find_positions(header.columns);
    if (!positions) {
      lines.fail("expected columns with positions (x y z, xs ys zs, xu yu zu or xsu ysu zsu)");
    }
    check_cell(header, positions->scaled);
    std::vector<Column> columns = choose_columns(header, *positions, lines.peek());
    parse_table(path(), lines.rest(), header.num_atoms, RowWidth::exact, columns, options());

    ParticleSet particles;
    particles.length_unit = length_unit_;
    particles.time = header.time ? header.time : header.timestep;
    particles.cell = header.cell;
    const auto& [x, y, z] = positions->index;
    if (positions->scaled) {
      unscale(*particles.cell, columns[x].reals, columns[y].reals, columns[z].reals);
    }
    set_positions(particles, columns[x].reals, columns[y].reals, columns[z].reals);
    take_columns(columns, particles);
    return particles;
  }

 private:
  /// The unit is named once, if at all, at the beginning of the file.
  static std::string find_length_unit(std::string_view head) {
    constexpr std::string_view mark = "ITEM: UNITS";
    if (!head.starts_with(mark)) return "unknown";
    head.remove_prefix(mark.size());
    return lammps_length_unit(next_token(head));
  }

  void check_cell(const FrameHeader& header, bool scaled) const {
    if (header.cell) return;
    const std::uint64_t line = std::max<std::uint64_t>(header.box_line, 1);
    if (scaled) {
      throw Error(path(), line, "expected a box with a volume: the positions are fractions of it");
    }
    if (header.box_line != 0) warn(Error(path(), line, "the box has no volume; ignored").what());
  }

  /// What to take: the best positions, ids, types, and all other numbers as properties.
  std::vector<Column> choose_columns(const FrameHeader& header, const PositionColumns& positions,
                                     std::string_view first_row) const {
    const std::string_view species = species_column(header.columns);
    std::unordered_set<std::string_view> seen;
    std::vector<Column> columns;
    for (const std::string& name : header.columns) {
      const std::string_view token = next_token(first_row);
      const bool repeated = !seen.insert(name).second;
      Column column{.name = name};
      if (repeated || is_position_name(name)) {
        column.kind = Column::Kind::ignored;
      } else if (name == "id") {
        column.kind = Column::Kind::integer;
      } else if (name == species) {
        column.kind = Column::Kind::word;
      } else if (token.empty() || to_real(token)) {
        column.kind = Column::Kind::single;
      }
      columns.push_back(std::move(column));
    }
    for (const std::size_t i : positions.index) columns[i].kind = Column::Kind::real;
    return columns;
  }

  /// The column that names the species. Names that the user gives to types come first.
  std::string_view species_column(const std::vector<std::string>& columns) const {
    const auto has = [&](std::string_view name) {
      return std::find(columns.begin(), columns.end(), name) != columns.end();
    };
    if (has("type") && (!options().types.empty() || !has("element"))) return "type";
    return has("element") ? "element" : "";
  }

  void take_columns(std::vector<Column>& columns, ParticleSet& particles) const {
    const Column* types = nullptr;
    for (Column& column : columns) {
      if (column.kind == Column::Kind::integer) particles.ids = std::move(column.integers);
      if (column.kind == Column::Kind::word) types = &column;
      if (column.kind == Column::Kind::single) {
        particles.properties.push_back({column.name, std::move(column.singles)});
      }
    }
    if (types != nullptr) {
      name_types(path(), *types, hints_from_masses(*types, particles), options(), particles);
    }
  }

  std::string length_unit_;
};

bool matches(std::string_view head) { return trim(head).starts_with("ITEM:"); }

}  // namespace

const Format& lammps_dump_format() {
  static const Format format{"LAMMPS dump",
                             {".lammpstrj", ".dump", ".lammpsdump"},
                             matches,
                             [](const std::filesystem::path& path,
                                const ReadOptions& options) -> std::unique_ptr<Trajectory> {
                               return std::make_unique<LammpsDump>(path, options);
                             }};
  return format;
}

}  // namespace motes
