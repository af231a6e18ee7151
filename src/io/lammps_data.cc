// LAMMPS data files, as write_data and many tools write them for read_data.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <map>
#include <utility>

#include "io/formats.h"
#include "io/id_index.h"
#include "io/lammps_atom_styles.h"
#include "io/lammps_units.h"
#include "io/row_loop.h"
#include "io/table.h"
#include "io/text_trajectory.h"
#include "io/type_names.h"

namespace motes {

namespace {

/// A line without its comment, and the comment.
struct SplitLine {
  std::string_view text, comment;
};

SplitLine split_comment(std::string_view line) {
  const std::size_t mark = line.find('#');
  if (mark == std::string_view::npos) return {trim(line), {}};
  return {trim(line.substr(0, mark)), trim(line.substr(mark + 1))};
}

bool is_letter(char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0; }

/// The lines before the first section.
struct Header {
  std::map<std::string, std::uint64_t, std::less<>>
      counts;  ///< "atoms", "bonds", "atom types", ...
  std::array<double, 3> low{}, high{};
  double xy = 0, xz = 0, yz = 0;
  bool has_box = false;
  std::optional<Cell> general_cell;  ///< from avec, bvec, cvec and abc origin

  std::uint64_t count(std::string_view what) const {
    const auto it = counts.find(what);
    return it == counts.end() ? 0 : it->second;
  }
};

/// The numbers at the front of a header line and the words behind them, joined by single spaces.
struct HeaderLine {
  std::vector<double> values;
  std::string first_token, words;
};

HeaderLine parse_header_line(std::string_view text) {
  HeaderLine line;
  for (const std::string_view token : split_tokens(text)) {
    const auto value = to_real(token);
    if (value && line.words.empty()) {
      if (line.values.empty()) line.first_token = token;
      line.values.push_back(*value);
    } else {
      if (!line.words.empty()) line.words += ' ';
      line.words += token;
    }
  }
  return line;
}

void expect_values(const LineReader& lines, const HeaderLine& line, std::size_t count) {
  if (line.values.size() == count) return;
  lines.fail(fmt::format("expected {} numbers before '{}', found {}", count, printable(line.words),
                         line.values.size()));
}

/// Takes a line of the header; those of unknown meaning are passed over.
void take_header_line(const LineReader& lines, const HeaderLine& line, Header& header) {
  static constexpr std::array<std::string_view, 3> bounds{"xlo xhi", "ylo yhi", "zlo zhi"};
  static constexpr std::array<std::string_view, 3> edges{"avec", "bvec", "cvec"};
  const auto& v = line.values;
  if (line.words.empty()) lines.fail("expected a keyword of the header behind the numbers");
  const auto bound = std::find(bounds.begin(), bounds.end(), line.words);
  const auto edge = std::find(edges.begin(), edges.end(), line.words);
  if (bound != bounds.end()) {
    expect_values(lines, line, 2);
    const auto axis = static_cast<std::size_t>(bound - bounds.begin());
    header.low[axis] = v[0];
    header.high[axis] = v[1];
    header.has_box = true;
  } else if (line.words == "xy xz yz") {
    expect_values(lines, line, 3);
    header.xy = v[0];
    header.xz = v[1];
    header.yz = v[2];
  } else if (edge != edges.end() || line.words == "abc origin") {
    expect_values(lines, line, 3);
    if (!header.general_cell) header.general_cell.emplace();
    if (edge != edges.end()) {
      const auto axis = static_cast<std::size_t>(edge - edges.begin());
      header.general_cell->vectors[axis] = {v[0], v[1], v[2]};
    } else {
      header.general_cell->origin = {v[0], v[1], v[2]};
    }
  } else if (v.size() == 1) {
    header.counts[line.words] =
        lines.parse_count(line.first_token, fmt::format("the number of {}", printable(line.words)));
  }
}

std::optional<Cell> cell_of(const Header& header) {
  Cell cell;
  if (header.general_cell) {
    cell = *header.general_cell;
  } else if (header.has_box) {
    const auto& [xlo, ylo, zlo] = header.low;
    const auto& [xhi, yhi, zhi] = header.high;
    cell.origin = {xlo, ylo, zlo};
    cell.vectors = {
        Vector3d{xhi - xlo, 0, 0}, {header.xy, yhi - ylo, 0}, {header.xz, header.yz, zhi - zlo}};
  }
  const auto& v = cell.vectors;
  const double volume = dot(v[0], cross(v[1], v[2]));
  if (!std::isfinite(volume) || volume <= 0) return std::nullopt;
  return cell;
}

/// What follows "KEY = " in the title that write_data writes; "" if it is not there.
std::string_view title_value(std::string_view title, std::string_view key) {
  const std::size_t at = title.find(key);
  if (at == std::string_view::npos) return {};
  title.remove_prefix(at + key.size());
  if (next_token(title) != "=") return {};
  std::string_view value = next_token(title);
  if (value.ends_with(',')) value.remove_suffix(1);
  return value;
}

/// Reads one file, section by section.
class DataReader {
 public:
  DataReader(const std::filesystem::path& path, TextBlock text, const ReadOptions& options)
      : path_(path), options_(options), lines_(path, text, true) {}

  ParticleSet read() {
    const std::string_view title = lines_.next("a title line");
    particles_.length_unit = lammps_length_unit(title_value(title, "units"));
    particles_.time = to_real(title_value(title, "timestep"));
    SplitLine section = read_header();
    while (!section.text.empty()) {
      read_section(section);
      section = next_section();
    }
    return finish();
  }

 private:
  /// Reads up to the first section, whose line it gives.
  SplitLine read_header() {
    while (lines_.skip_blank_lines()) {
      const SplitLine line = split_comment(lines_.next(""));
      if (line.text.empty()) continue;
      if (is_letter(line.text.front())) return line;
      take_header_line(lines_, parse_header_line(line.text), header_);
    }
    return {};
  }

  /// Passes over rows that nothing is known of, up to the next line that begins with a letter.
  SplitLine next_section() {
    while (lines_.skip_blank_lines()) {
      const SplitLine line = split_comment(lines_.next(""));
      if (!line.text.empty() && is_letter(line.text.front())) return line;
    }
    return {};
  }

  void read_section(const SplitLine& section) {
    const std::uint64_t num_atoms = header_.count("atoms");
    if (section.text == "Masses") {
      read_masses();
    } else if (section.text == "Atom Type Labels") {
      for (std::uint64_t i = 0; i < header_.count("atom types"); ++i) {
        std::string_view row = lines_.next_filled("a type and its label");
        const std::string type(next_token(row));
        hints_.labels[type] = next_token(row);
      }
    } else if (section.text == "Atoms") {
      read_atoms(section, num_atoms);
    } else if (section.text == "Velocities") {
      velocities_ = lines_.take_rows(num_atoms, "velocities");
    } else if (section.text == "Bonds") {
      bonds_ = lines_.take_rows(header_.count("bonds"), "bonds");
    } else if (section.text == "Angles" || section.text == "Dihedrals" ||
               section.text == "Impropers") {
      std::string what(section.text);
      what.front() = static_cast<char>(std::tolower(what.front()));
      lines_.take_rows(header_.count(what), what);
    }
  }

  void read_masses() {
    for (std::uint64_t i = 0; i < header_.count("atom types"); ++i) {
      const SplitLine row = split_comment(lines_.next_filled("a type and its mass"));
      const auto tokens = split_tokens(row.text);
      const auto mass = tokens.size() == 2 ? to_real(tokens[1]) : std::nullopt;
      if (!mass) {
        lines_.fail(fmt::format("expected a type and its mass, found '{}'", printable(row.text)));
      }
      const std::string type(tokens[0]);
      hints_.masses[type] = *mass;
      std::string_view comment = row.comment;
      if (const auto label = next_token(comment); !label.empty()) {
        hints_.labels.try_emplace(type, label);
      }
    }
  }

  void read_atoms(const SplitLine& section, std::uint64_t num_atoms) {
    if (has_atoms_) lines_.fail("expected one section Atoms, found a second");
    has_atoms_ = true;
    if (num_atoms == 0) return;
    if (!lines_.skip_blank_lines()) lines_.take_rows(num_atoms, "atoms");  // which says what lacks
    std::string_view style = section.comment;
    auto names = lammps_atom_columns(next_token(style));
    if (!names) {
      const std::string_view row = split_comment(lines_.peek()).text;
      names = guess_lammps_atom_columns(row, header_.count("atom types"));
    }
    if (!names) {
      lines_.next("");
      lines_.fail("expected the columns of an atom style; name it in a comment: 'Atoms # full'");
    }
    for (const std::string& name : *names)
      columns_.push_back({.name = name, .kind = kind_of(name)});
    const TextBlock rows = lines_.take_rows(num_atoms, "atoms");
    parse_table(path_, rows, num_atoms, RowWidth::at_least, columns_, options_);
  }

  static Column::Kind kind_of(std::string_view name) {
    if (name == "id") return Column::Kind::integer;
    if (name == "type") return Column::Kind::word;
    if (name == "x" || name == "y" || name == "z") return Column::Kind::real;
    return Column::Kind::single;
  }

  Column& column(std::string_view name) {
    return *std::find_if(columns_.begin(), columns_.end(),
                         [&](const Column& c) { return c.name == name; });
  }

  ParticleSet finish() {
    if (header_.counts.find("atoms") == header_.counts.end()) {
      throw Error(path_, "expected a header line 'N atoms', found none");
    }
    if (!has_atoms_ && header_.count("atoms") != 0) {
      throw Error(path_, fmt::format("expected a section Atoms with {} atoms, found none",
                                     header_.count("atoms")));
    }
    if (!bonds_ && header_.count("bonds") != 0) {
      throw Error(path_, fmt::format("expected a section Bonds with {} bonds, found none",
                                     header_.count("bonds")));
    }
    particles_.cell = cell_of(header_);
    if (!columns_.empty()) take_columns();
    if (velocities_) take_velocities();
    if (bonds_) take_bonds();
    return std::move(particles_);
  }

  void take_columns() {
    set_positions(particles_, column("x").reals, column("y").reals, column("z").reals);
    particles_.ids = std::move(column("id").integers);
    name_types(path_, column("type"), hints_, options_, particles_);
    for (Column& c : columns_) {
      if (c.kind == Column::Kind::single) {
        particles_.properties.push_back({c.name, std::move(c.singles)});
      }
    }
  }

  void take_velocities() {
    std::vector<Column> columns{{.name = "id", .kind = Column::Kind::integer}};
    for (const char* name : {"vx", "vy", "vz"}) {
      columns.push_back({.name = name, .kind = Column::Kind::single});
    }
    const std::size_t n = particles_.size();
    parse_table(path_, *velocities_, n, RowWidth::at_least, columns, options_);
    const bool same_order = columns[0].integers == particles_.ids;
    if (!same_order) sort_velocities(columns);
    for (std::size_t c = 1; c < columns.size(); ++c) {
      particles_.properties.push_back({columns[c].name, std::move(columns[c].singles)});
    }
  }

  /// Brings rows of velocities into the order of the atoms.
  void sort_velocities(std::vector<Column>& columns) const {
    const IdIndex index(particles_.ids);
    std::vector<Column> sorted = columns;
    for (std::size_t row = 0; row < particles_.size(); ++row) {
      const auto i = index.find(columns[0].integers[row]);
      if (!i) {
        throw Error(path_, line_of_row(*velocities_, row),
                    fmt::format("expected the id of an atom, found {}", columns[0].integers[row]));
      }
      for (std::size_t c = 1; c < columns.size(); ++c) {
        sorted[c].singles[*i] = columns[c].singles[row];
      }
    }
    columns = std::move(sorted);
  }

  void take_bonds() {
    std::vector<Column> columns{{.name = "bond"}, {.name = "type"}};
    for (const char* name : {"atom1", "atom2"}) {
      columns.push_back({.name = name, .kind = Column::Kind::integer});
    }
    const std::uint64_t n = header_.count("bonds");
    const IdIndex index(particles_.ids);
    parse_table(path_, *bonds_, n, RowWidth::at_least, columns, options_);
    std::vector<std::size_t> unknown;  // rows
    for (std::size_t row = 0; row < n; ++row) {
      const auto a = index.find(columns[2].integers[row]), b = index.find(columns[3].integers[row]);
      if (a && b) {
        particles_.bonds.push_back({std::min(*a, *b), std::max(*a, *b)});
      } else {
        unknown.push_back(row);
      }
    }
    if (unknown.empty() || options_.warnings == nullptr) return;
    options_.warnings->add(
        Error(path_, line_of_row(*bonds_, unknown.front()),
              fmt::format("{} to atoms that are not there left out{}",
                          unknown.size() == 1 ? "1 bond" : fmt::format("{} bonds", unknown.size()),
                          unknown.size() == 1 ? "" : ", of which this is the first"))
            .what());
  }

  const std::filesystem::path& path_;
  ReadOptions options_;
  LineReader lines_;
  Header header_;
  TypeHints hints_;
  bool has_atoms_ = false;
  std::vector<Column> columns_;  ///< of the section Atoms
  std::optional<TextBlock> velocities_, bonds_;
  ParticleSet particles_;
};

class LammpsData : public TextTrajectory {
 public:
  LammpsData(const std::filesystem::path& path, const ReadOptions& options)
      : TextTrajectory(path, options) {}

  std::string_view format() const override { return "LAMMPS data"; }

 protected:
  void skip_frame(LineReader& lines) const override { lines.skip_rest(); }
  ParticleSet parse_frame(TextBlock frame) override {
    return DataReader(path(), frame, options()).read();
  }
};

/// A header that counts atoms, and types or the box.
bool matches(std::string_view head) {
  bool has_atoms = false, has_others = false;
  constexpr int max_header_lines = 100;
  for (int i = 0; i < max_header_lines && !head.empty(); ++i) {
    const std::size_t size = std::min(head.find('\n'), head.size());
    const HeaderLine line = parse_header_line(split_comment(head.substr(0, size)).text);
    head.remove_prefix(std::min(size + 1, head.size()));
    // (the first line is a title, whatever it says)
    if (i == 0 || line.values.empty()) continue;
    has_atoms = has_atoms || line.words == "atoms";
    has_others = has_others || line.words == "atom types" || line.words == "xlo xhi";
  }
  return has_atoms && has_others;
}

}  // namespace

const Format& lammps_data_format() {
  static const Format format{"LAMMPS data",
                             {".data", ".lmp"},
                             matches,
                             [](const std::filesystem::path& path,
                                const ReadOptions& options) -> std::unique_ptr<Trajectory> {
                               return std::make_unique<LammpsData>(path, options);
                             }};
  return format;
}

}  // namespace motes
