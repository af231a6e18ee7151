// PDB files (wwPDB format 3.3), read column by column: gemmi's reader takes stars for zeros and
// regroups atoms, and does not say where.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <unordered_map>

#include "io/alternate_locations.h"
#include "io/atom_names.h"
#include "io/bytes.h"
#include "io/cell_angles.h"
#include "io/formats.h"
#include "io/text_trajectory.h"
#include "particles/elements.h"

namespace motes {

namespace {

/// The name of a record: its first six columns.
std::string_view record_of(std::string_view line) { return trim(line.substr(0, 6)); }

bool is_atom(std::string_view record) { return record == "ATOM" || record == "HETATM"; }

/// Columns `first` to `last`, counted from 1 as the format's description does; shorter where the
/// line is.
std::string_view columns(std::string_view line, std::size_t first, std::size_t last) {
  return line.size() < first ? std::string_view() : line.substr(first - 1, last - first + 1);
}

/// What the ATOM lines of a frame hold, a value a particle.
struct Atoms {
  AlternateLocations alternates;
  std::array<std::vector<double>, 3> position;
  std::vector<std::int64_t> serials;
  std::vector<float> occupancy, b_factor;
  std::vector<std::string> elements;  ///< distinct
  std::vector<std::uint16_t> element_indices;

  void add_element(const std::string& symbol) {
    if (element_indices.empty() || elements[element_indices.back()] != symbol) {
      const auto it = std::find(elements.begin(), elements.end(), symbol);
      element_indices.push_back(static_cast<std::uint16_t>(it - elements.begin()));
      if (it == elements.end()) elements.push_back(symbol);
    } else {
      element_indices.push_back(element_indices.back());
    }
  }
};

std::string element_of(std::string_view line) {
  if (const Element* element = find_element(trim(columns(line, 77, 78)))) {
    return std::string(element->symbol);
  }
  const std::string_view name = columns(line, 13, 16), residue = trim(columns(line, 18, 20));
  // Symbols of two letters begin in column 13, those of one in column 14; but names of four letters
  // begin in column 13 too, and some programs write all names there.
  const bool shifted = !name.starts_with(' ') && trim(name).size() <= 2 && residue == trim(name);
  if (const Element* element = shifted ? find_element(trim(name)) : nullptr) {
    return std::string(element->symbol);
  }
  return guess_element(trim(name), residue);
}

/// A value that may be missing.
float optional_value(std::string_view text) {
  const auto value = to_real(trim(text));
  return value ? static_cast<float>(*value) : std::numeric_limits<float>::quiet_NaN();
}

void read_atom(const LineReader& lines, std::string_view line, Atoms& atoms) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::size_t first = 31 + 8 * axis, last = first + 7;
    const std::string_view text = columns(line, first, last);
    const auto value = to_real(trim(text));
    // A line that ends inside of a number has lost digits.
    if (!value || text.size() < 8) {
      lines.fail(fmt::format("expected the coordinate {} in columns {} to {}, found '{}'",
                             "xyz"[axis], first, last, printable(trim(text))));
    }
    atoms.position[axis].push_back(*value);
  }
  // Numbers beyond 99999 are written as stars, in base 36, or start again.
  const auto serial = to_integer(trim(columns(line, 7, 11)));
  atoms.serials.push_back(serial ? *serial : atoms.serials.empty() ? 1 : atoms.serials.back() + 1);
  atoms.occupancy.push_back(optional_value(columns(line, 55, 60)));
  atoms.b_factor.push_back(optional_value(columns(line, 61, 66)));
  atoms.add_element(element_of(line));
}

/// The cell of a CRYST1 line; nothing for the placeholders of structures without one.
std::optional<Cell> read_cell(const LineReader& lines, std::string_view line) {
  std::array<double, 6> values{};
  constexpr std::array<std::array<std::size_t, 2>, 6> places{
      {{7, 15}, {16, 24}, {25, 33}, {34, 40}, {41, 47}, {48, 54}}};
  for (std::size_t i = 0; i < values.size(); ++i) {
    const auto value = to_real(trim(columns(line, places[i][0], places[i][1])));
    if (!value) lines.fail("expected three edges and three angles of the cell (CRYST1)");
    values[i] = *value;
  }
  return cell_from_angles({values[0], values[1], values[2]}, {values[3], values[4], values[5]});
}

struct Connection {
  std::int64_t from, to;
};

void read_connections(std::string_view line, std::vector<Connection>& connections) {
  const auto from = to_integer(trim(columns(line, 7, 11)));
  for (std::size_t first = 12; first <= 27; first += 5) {
    const auto to = to_integer(trim(columns(line, first, first + 4)));
    if (from && to) connections.push_back({*from, *to});
  }
}

class Pdb : public TextTrajectory {
 public:
  Pdb(const std::filesystem::path& path, const ReadOptions& options)
      : TextTrajectory(path, options), cell_(find_cell(path)) {}

  std::string_view format() const override { return "PDB"; }

 protected:
  void skip_frame(LineReader& lines) const override;
  ParticleSet parse_frame(TextBlock frame) override;

 private:
  static std::optional<Cell> find_cell(const std::filesystem::path& path);
  void add_bonds(const std::vector<Connection>& connections, ParticleSet& particles) const;

  std::optional<Cell> cell_;  ///< of the file, for frames that have none of their own
};

/// The cell above the first atom. Models after the first seldom repeat it.
std::optional<Cell> Pdb::find_cell(const std::filesystem::path& path) {
  const std::string head = read_head(path);
  LineReader lines(path, {head, 1}, true);
  while (lines.skip_blank_lines()) {
    const std::string_view line = lines.next("a record");
    if (is_atom(record_of(line))) break;
    if (record_of(line) == "CRYST1" && !lines.rest().text.empty()) return read_cell(lines, line);
  }
  return std::nullopt;
}

/// A frame reaches from one MODEL to the next, or, in files of programs that write none, from one
/// END to the next.
void Pdb::skip_frame(LineReader& lines) const {
  bool has_atoms = false, in_model = false, ended = false;
  while (lines.skip_blank_lines()) {
    const std::string_view next = record_of(lines.peek());
    if (ended && (is_atom(next) || next == "MODEL" || next == "CRYST1")) return;
    const std::string_view record = record_of(lines.next("a record"));
    if (record == "MODEL") {
      if (in_model) lines.fail("expected ENDMDL before the next MODEL");
      in_model = true;
    } else if (is_atom(record)) {
      has_atoms = true;
    } else if (record == "ENDMDL" || (record == "END" && has_atoms)) {
      in_model = false;
      ended = true;
    }
  }
  if (in_model) lines.fail("ends within a model; expected ENDMDL");
  if (!has_atoms) lines.fail("ends here; expected ATOM or HETATM records");
}

ParticleSet Pdb::parse_frame(TextBlock frame) {
  LineReader lines(path(), frame, true);
  Atoms atoms;
  std::vector<Connection> connections;
  ParticleSet particles;
  particles.cell = cell_;
  bool ends_with_atom = false;
  while (lines.skip_blank_lines()) {
    const std::string_view line = lines.next("a record"), record = record_of(line);
    ends_with_atom = is_atom(record);
    if (is_atom(record)) {
      // Column 17 tells alternates of one atom: chain, residue and name are the same.
      const std::string_view label = trim(columns(line, 17, 17));
      if (atoms.alternates.skip(label, columns(line, 13, 16), columns(line, 22, 27))) continue;
      read_atom(lines, line, atoms);
    } else if (record == "CRYST1") {
      particles.cell = read_cell(lines, line);
    } else if (record == "CONECT") {
      read_connections(line, connections);
    }
  }
  // A file cut at the end of a line reads as a whole one; only what should follow tells.
  if (ends_with_atom) {
    warn(fmt::format("{}: ends with an atom, without TER or END; it may be cut short",
                     printable(path().string())));
  }
  set_positions(particles, atoms.position[0], atoms.position[1], atoms.position[2]);
  particles.length_unit = "angstrom";
  particles.species_names = std::move(atoms.elements);
  particles.species = std::move(atoms.element_indices);
  particles.ids = std::move(atoms.serials);
  for (auto& [name, values] :
       {std::pair{"occupancy", &atoms.occupancy}, std::pair{"b_factor", &atoms.b_factor}}) {
    if (std::none_of(values->begin(), values->end(), [](float v) { return std::isnan(v); })) {
      particles.properties.push_back({name, std::move(*values)});
    }
  }
  add_bonds(connections, particles);
  atoms.alternates.warn(path(), options().warnings);
  return particles;
}

void Pdb::add_bonds(const std::vector<Connection>& connections, ParticleSet& particles) const {
  particles.bonds_are_partial = true;
  if (connections.empty()) return;
  std::unordered_map<std::int64_t, std::uint32_t> indices;
  for (std::size_t i = 0; i < particles.size(); ++i) {
    if (!indices.emplace(particles.ids[i], static_cast<std::uint32_t>(i)).second) {
      warn(fmt::format("{}: bonds are left out, for numbers of atoms are not unique",
                       printable(path().string())));
      return;
    }
  }
  std::size_t num_unknown = 0;
  for (const auto& [from, to] : connections) {
    const auto first = indices.find(from), second = indices.find(to);
    if (first == indices.end() || second == indices.end()) {
      ++num_unknown;
      continue;
    }
    particles.bonds.push_back(
        {std::min(first->second, second->second), std::max(first->second, second->second)});
  }
  if (num_unknown > 0) {
    warn(fmt::format("{}: {} to atoms that are not there left out", printable(path().string()),
                     num_unknown == 1 ? "1 bond" : fmt::format("{} bonds", num_unknown)));
  }
  // Most bonds are listed from both their ends.
  const auto order = [](const Bond& a, const Bond& b) {
    return std::pair(a.first, a.second) < std::pair(b.first, b.second);
  };
  std::sort(particles.bonds.begin(), particles.bonds.end(), order);
  particles.bonds.erase(std::unique(particles.bonds.begin(), particles.bonds.end()),
                        particles.bonds.end());
}

/// Every line of the beginning is a record of PDB's, and some are atoms or announce them.
bool matches_pdb(std::string_view head) {
  static constexpr std::array<std::string_view, 24> first_records{
      "HEADER", "OBSLTE", "TITLE",  "SPLIT",  "CAVEAT", "COMPND", "SOURCE", "KEYWDS",
      "EXPDTA", "NUMMDL", "MDLTYP", "AUTHOR", "REVDAT", "SPRSDE", "JRNL",   "REMARK",
      "SEQRES", "CRYST1", "MODEL",  "ATOM",   "HETATM", "USER",   "DBREF",  "CRYST"};
  std::size_t num_lines = 0;
  while (!head.empty() && num_lines < 50) {
    const std::string_view line = head.substr(0, head.find('\n'));
    head.remove_prefix(std::min(line.size() + 1, head.size()));
    if (trim(line).empty()) continue;
    const std::string_view record = record_of(line);
    ++num_lines;
    // An atom's line is proof; other records are until the first words that are none.
    if (is_atom(record)) return to_real(trim(columns(line, 31, 38))) || num_lines > 1;
    if (std::find(first_records.begin(), first_records.end(), record) == first_records.end()) {
      return num_lines > 5;
    }
  }
  return num_lines > 5;
}

std::unique_ptr<Trajectory> open_pdb(const std::filesystem::path& path,
                                     const ReadOptions& options) {
  return std::make_unique<Pdb>(path, options);
}

}  // namespace

const Format& pdb_format() {
  static const Format format{"PDB", {".pdb", ".ent"}, matches_pdb, open_pdb};
  return format;
}

}  // namespace motes
