// GROMACS structures and trajectories in text (manual.gromacs.org, file formats, gro).
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "io/atom_names.h"
#include "io/formats.h"
#include "io/row_loop.h"
#include "io/text_trajectory.h"

namespace motes {

namespace {

constexpr double angstrom_per_nm = 10;
constexpr std::size_t name_width = 5;
constexpr std::size_t first_number_column =
    20;  // after residue number and name, atom name and number

std::uint64_t read_count(LineReader& lines) {
  constexpr std::string_view what = "the number of atoms";
  return lines.parse_count(lines.next(what), what);
}

/// The box line: three lengths, and six more numbers if it is triclinic.
std::vector<double> read_box(LineReader& lines) {
  const std::string_view line = lines.next("the line of the box");
  std::vector<double> values;
  for (const std::string_view token : split_tokens(line)) {
    if (const auto value = to_real(token)) {
      values.push_back(angstrom_per_nm * *value);
    } else {
      values.clear();
      break;
    }
  }
  if (values.size() != 3 && values.size() != 9) {
    lines.fail(
        fmt::format("expected the 3 or 9 numbers of the box, found '{}'", printable(trim(line))));
  }
  values.resize(9);
  return values;
}

/// Nothing for a box without volume, as files have that know none.
std::optional<Cell> make_cell(const std::vector<double>& b) {
  Cell cell;
  cell.vectors = {Vector3d{b[0], b[3], b[4]}, {b[5], b[1], b[6]}, {b[7], b[8], b[2]}};
  const double volume = dot(cell.vectors[0], cross(cell.vectors[1], cell.vectors[2]));
  if (!std::isfinite(volume) || volume <= 0) return std::nullopt;
  return cell;
}

/// The number behind "t=" in a title.
std::optional<double> time_of(std::string_view title) {
  for (std::size_t at = title.find("t="); at != std::string_view::npos;
       at = title.find("t=", at + 1)) {
    if (at > 0 && !is_blank(title[at - 1]) && title[at - 1] != ',') continue;
    std::string_view rest = title.substr(at + 2);
    return to_real(next_token(rest));
  }
  return std::nullopt;
}

/// Width of the columns of numbers: the distance of the first two decimal points; 0 if there are
/// not two.
std::size_t number_width(std::string_view row) {
  const std::size_t first = row.find('.', std::min(first_number_column, row.size()));
  if (first == std::string_view::npos) return 0;
  const std::size_t second = row.find('.', first + 1);
  return second == std::string_view::npos ? 0 : second - first;
}

/// Residue and atom name, five characters each, as they stand in the file.
using AtomName = std::array<char, 2 * name_width>;

struct Rows {
  std::vector<AtomName> names;
  std::vector<std::int64_t> residues, ids;
  std::array<std::vector<double>, 3> positions;
  std::array<std::vector<float>, 3> velocities;  // empty if the file has none

  Rows(std::size_t n, bool has_velocities) : names(n), residues(n), ids(n) {
    for (auto& p : positions) p.resize(n);
    if (has_velocities) {
      for (auto& v : velocities) v.resize(n);
    }
  }
};

class RowParser {
 public:
  RowParser(const std::filesystem::path& path, std::size_t width, Rows& rows)
      : path_(path), width_(width), rows_(rows) {}

  void parse(std::size_t i, std::string_view row, std::uint64_t line) const {
    if (row.size() < first_number_column + 2 * width_ + 1) {
      fail(line, "a row with residue, atom and position", row);
    }
    row.copy(rows_.names[i].data(), 2 * name_width, name_width);
    if (trim(row.substr(2 * name_width, name_width)).empty()) {
      fail(line, "an atom name in columns 11 to 15", row);
    }
    // (numbers of more than five digits are cut by some programs and starred by others)
    rows_.residues[i] = to_integer(trim(row.substr(0, name_width))).value_or(0);
    rows_.ids[i] = to_integer(trim(row.substr(3 * name_width, name_width))).value_or(0);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto value = number(row, axis);
      if (!value) fail(line, "a position of three numbers", row);
      rows_.positions[axis][i] = angstrom_per_nm * *value;
    }
    for (std::size_t axis = 0; axis < 3 && !rows_.velocities[0].empty(); ++axis) {
      const auto value = number(row, axis + 3);
      if (!value) fail(line, "a velocity of three numbers as in the first row", row);
      rows_.velocities[axis][i] = static_cast<float>(angstrom_per_nm * *value);
    }
  }

 private:
  std::optional<double> number(std::string_view row, std::size_t k) const {
    const std::size_t begin = first_number_column + k * width_;
    if (begin >= row.size()) return std::nullopt;
    return to_real(trim(row.substr(begin, width_)));
  }

  [[noreturn]] void fail(std::uint64_t line, std::string_view expected,
                         std::string_view row) const {
    throw Error(path_, line,
                fmt::format("expected {}, found '{}'", expected, printable(trim(row))));
  }

  const std::filesystem::path& path_;
  std::size_t width_;
  Rows& rows_;
};

/// Numbers that start again after 99999, as five digits must, go on instead.
void unwrap(std::vector<std::int64_t>& numbers) {
  std::int64_t offset = 0, last = 0;
  for (std::int64_t& number : numbers) {
    if (last == 99999 && (number == 0 || number == 1)) offset += 100000;
    last = number;
    number += offset;
  }
}

void name_species(const std::vector<AtomName>& names, ParticleSet& particles) {
  const auto part = [](const AtomName& name, std::size_t k) {
    return trim(std::string_view(name.data() + k * name_width, name_width));
  };
  const bool has_beads = std::any_of(names.begin(), names.end(), [&](const AtomName& name) {
    return is_bead_name(part(name, 1));
  });
  std::map<AtomName, std::uint16_t> indices;
  particles.species.reserve(names.size());
  for (const AtomName& name : names) {
    auto it = indices.find(name);
    if (it == indices.end()) {
      const std::string species =
          has_beads ? std::string(part(name, 1)) : guess_element(part(name, 1), part(name, 0));
      it = indices.emplace(name, particles.species_index(species)).first;
    }
    particles.species.push_back(it->second);
  }
}

class Gro : public TextTrajectory {
 public:
  Gro(const std::filesystem::path& path, const ReadOptions& options)
      : TextTrajectory(path, options) {}

  std::string_view format() const override { return "GRO"; }

 protected:
  void skip_frame(LineReader& lines) const override {
    lines.next("a title line");
    lines.skip(read_count(lines), "atoms");
    read_box(lines);
  }

  ParticleSet parse_frame(TextBlock frame) override {
    LineReader lines(path(), frame, true);
    ParticleSet particles;
    particles.length_unit = "angstrom";
    particles.time = time_of(lines.next("a title line"));
    const std::uint64_t count = read_count(lines);
    const std::string_view first_row = lines.peek();
    TextBlock table = lines.rest();
    lines.skip(count, "atoms");
    table.text = table.text.substr(0, table.text.size() - lines.rest().text.size());
    Rows rows = parse_rows(table, count, first_row);
    particles.cell = make_cell(read_box(lines));
    take_rows(rows, particles);
    return particles;
  }

 private:
  Rows parse_rows(TextBlock table, std::uint64_t count, std::string_view first_row) const {
    const std::vector<RowChunk> chunks = split_rows(table);
    const std::size_t found = chunks.empty() ? 0 : chunks.back().first_row + chunks.back().num_rows;
    if (found != count) {
      throw Error(path(), table.first_line,
                  fmt::format("expected {} atoms from here on, found {}", count, found));
    }
    const std::size_t width = number_width(first_row);
    if (count > 0 && width == 0) {
      throw Error(path(), table.first_line,
                  fmt::format("expected a row with residue, atom and position, found '{}'",
                              printable(trim(first_row))));
    }
    const bool has_velocities = first_row.size() > first_number_column + 5 * width;
    Rows rows(count, has_velocities);
    const RowParser parser(path(), width, rows);
    const auto parse = [&](std::size_t row, const char* begin, const char* end,
                           std::uint64_t line) {
      std::string_view text(begin, static_cast<std::size_t>(end - begin));
      if (text.ends_with('\r')) text.remove_suffix(1);
      parser.parse(row, text, line);
    };
    for_each_chunk(
        path(), chunks.size(), [&](std::size_t i) { for_each_row(chunks[i], parse); }, options());
    return rows;
  }

  static void take_rows(Rows& rows, ParticleSet& particles) {
    set_positions(particles, rows.positions[0], rows.positions[1], rows.positions[2]);
    name_species(rows.names, particles);
    unwrap(rows.ids);
    unwrap(rows.residues);
    particles.ids = std::move(rows.ids);
    particles.properties.push_back(
        {"residue", std::vector<float>(rows.residues.begin(), rows.residues.end())});
    if (rows.velocities[0].empty()) return;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      static constexpr std::array<const char*, 3> names{"vx", "vy", "vz"};
      particles.properties.push_back({names[axis], std::move(rows.velocities[axis])});
    }
  }
};

/// A title, a count, and a row with numbers in the right columns.
bool matches(std::string_view head) {
  std::array<std::string_view, 3> lines;
  for (auto& line : lines) {
    const std::size_t newline = head.find('\n');
    line = head.substr(0, newline);
    head.remove_prefix(newline == std::string_view::npos ? head.size() : newline + 1);
  }
  if (!to_count(lines[1])) return false;
  const std::string_view row = lines[2];
  const std::size_t width = number_width(row);
  if (width == 0 || row.size() < first_number_column + 2 * width + 1) return false;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t begin = first_number_column + k * width;
    if (begin >= row.size() || !to_real(trim(row.substr(begin, width)))) return false;
  }
  return to_integer(trim(row.substr(0, name_width))).has_value();
}

}  // namespace

const Format& gro_format() {
  static const Format format{"GRO",
                             {".gro"},
                             matches,
                             [](const std::filesystem::path& path,
                                const ReadOptions& options) -> std::unique_ptr<Trajectory> {
                               return std::make_unique<Gro>(path, options);
                             }};
  return format;
}

}  // namespace motes
