// mmCIF (macromolecules: Cartesian atoms, models) and CIF of small molecules and crystals
// (fractional sites, symmetry), through gemmi's parser.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <gemmi/cif.hpp>
#include <gemmi/numb.hpp>
#include <gemmi/symmetry.hpp>
#include <optional>

#include "io/alternate_locations.h"
#include "io/atom_names.h"
#include "io/bytes.h"
#include "io/cell_angles.h"
#include "io/formats.h"
#include "io/in_memory.h"
#include "io/text.h"
#include "particles/elements.h"

namespace motes {

namespace {

namespace cif = gemmi::cif;

/// Throws the Error of a message of gemmi's, "content:LINE:COLUMN: what".
[[noreturn]] void throw_parse_error(const std::filesystem::path& path, std::string_view message) {
  const auto cut_number = [&]() -> std::optional<std::int64_t> {
    const std::size_t colon = message.find(':');
    const auto number = to_integer(message.substr(0, colon));
    if (number && colon != std::string_view::npos) message.remove_prefix(colon + 1);
    return number;
  };
  const std::string_view source = "content:";
  if (message.substr(0, source.size()) != source) throw Error(path, printable(message, 200));
  message.remove_prefix(source.size());
  const auto line = cut_number();
  cut_number();
  std::string what = printable(trim(message), 200);
  if (what.rfind("Wrong number of values", 0) == 0) {
    what += "; expected whole rows, with a value for each of its tags";
  }
  if (line && *line > 0) throw Error(path, static_cast<std::uint64_t>(*line), what);
  throw Error(path, what);
}

cif::Document parse(const std::filesystem::path& path, const std::string& content) {
  try {
    return cif::read_memory(content.data(), content.size(), "content");
  } catch (const std::runtime_error& error) {
    throw_parse_error(path, error.what());
  }
}

/// The atoms of one frame as they are collected.
struct Atoms {
  std::vector<double> x, y, z;
  std::vector<float> occupancy, b_factor;
  std::vector<std::int64_t> ids;
  AlternateLocations alternates;
  ParticleSet particles;  ///< species and cell

  void add(const std::array<double, 3>& position, const std::string& element) {
    x.push_back(position[0]);
    y.push_back(position[1]);
    z.push_back(position[2]);
    particles.species.push_back(particles.species_index(element));
  }
  ParticleSet finish() {
    set_positions(particles, x, y, z);
    particles.length_unit = "angstrom";
    if (ids.size() == x.size()) particles.ids = std::move(ids);
    for (auto& [name, values] :
         {std::pair{"occupancy", &occupancy}, std::pair{"b_factor", &b_factor}}) {
      if (values->size() == x.size() && !x.empty()) {
        particles.properties.push_back({name, std::move(*values)});
      }
    }
    return std::move(particles);
  }
};

void add_if_number(const cif::Table::Row& row, int column, std::vector<float>& values) {
  if (!row.has2(static_cast<std::size_t>(column))) return;
  const double value = cif::as_number(row[column]);
  if (!std::isnan(value)) values.push_back(static_cast<float>(value));
}

std::optional<Cell> read_cell(cif::Block& block, const std::string& prefix) {
  const auto number = [&](const char* tag) {
    const std::string* value = block.find_value(prefix + tag);
    return value == nullptr ? NAN : cif::as_number(*value);
  };
  return cell_from_angles({number("length_a"), number("length_b"), number("length_c")},
                          {number("angle_alpha"), number("angle_beta"), number("angle_gamma")});
}

std::string element_symbol(const std::string& type, const std::string& name) {
  const Element* element = find_element(type);
  return element != nullptr ? std::string(element->symbol) : guess_element(name, "");
}

/// Frames of the models of an mmCIF block.
std::vector<ParticleSet> read_models(const std::filesystem::path& path, cif::Block& block,
                                     cif::Table& table, const ReadOptions& options) {
  enum { x, y, z, symbol, name, id, model, occupancy, b_factor, alternate, chain, residue };
  std::vector<ParticleSet> frames;
  Atoms atoms;
  std::string current_model;
  const auto finish = [&] {
    if (atoms.x.empty()) return;
    atoms.alternates.warn(path, options.warnings);
    atoms.particles.cell = read_cell(block, "_cell.");
    frames.push_back(atoms.finish());
    atoms = {};
  };
  for (const auto row : table) {
    const std::string number = row.has(model) ? row[model] : "";
    if (number != current_model) finish();
    current_model = number;
    const auto text = [&](int column) {
      return row.has2(static_cast<std::size_t>(column)) ? row.str(column) : std::string();
    };
    if (atoms.alternates.skip(text(alternate), text(name), text(chain) + ' ' + text(residue))) {
      continue;
    }
    std::array<double, 3> position{};
    for (const int axis : {x, y, z}) {
      position[static_cast<std::size_t>(axis)] = cif::as_number(row[axis]);
      if (std::isnan(position[static_cast<std::size_t>(axis)])) {
        throw Error(path, fmt::format("atom {} of _atom_site has Cartn_{} '{}'; expected a number",
                                      row.row_index + 1, "xyz"[axis], printable(row[axis])));
      }
    }
    atoms.add(position, element_symbol(text(symbol), text(name)));
    if (row.has(id)) {
      if (const auto value = to_integer(row[id])) atoms.ids.push_back(*value);
    }
    add_if_number(row, occupancy, atoms.occupancy);
    add_if_number(row, b_factor, atoms.b_factor);
  }
  finish();
  return frames;
}

/// The symmetry operations of a crystal: those listed, else those of the group that is named, else
/// none but the identity, with a warning.
std::vector<gemmi::Op> read_symmetry(const std::filesystem::path& path, cif::Block& block,
                                     const ReadOptions& options) {
  std::vector<gemmi::Op> operations;
  for (const char* tag : {"_space_group_symop_operation_xyz", "_symmetry_equiv_pos_as_xyz",
                          "_space_group_symop.operation_xyz"}) {
    for (const std::string& value : block.find_values(tag)) {
      try {
        operations.push_back(gemmi::parse_triplet(cif::as_string(value)));
      } catch (const std::runtime_error&) {
        throw Error(path, fmt::format("has the symmetry operation {}; expected one such as x,y,z",
                                      printable(value)));
      }
    }
    if (!operations.empty()) return operations;
  }
  for (const char* tag : {"_space_group_name_H-M_alt", "_symmetry_space_group_name_H-M",
                          "_space_group_IT_number", "_symmetry_Int_Tables_number"}) {
    const std::string* value = block.find_value(tag);
    const gemmi::SpaceGroup* group =
        value == nullptr ? nullptr : gemmi::find_spacegroup_by_name(cif::as_string(*value));
    if (group == nullptr) continue;
    for (const gemmi::Op operation : group->operations()) operations.push_back(operation);
    return operations;
  }
  if (options.warnings != nullptr) {
    options.warnings->add(fmt::format("{}: no symmetry is given; only the listed atoms are shown",
                                      printable(path.string())));
  }
  return {gemmi::Op::identity()};
}

using Fractional = std::array<double, 3>;

Vector3d to_cartesian(const Cell& cell, const Fractional& f) {
  return f[0] * cell.vectors[0] + f[1] * cell.vectors[1] + f[2] * cell.vectors[2];
}

/// Whether two sites of one crystal are the same, through its periodic boundaries.
bool same_site(const Cell& cell, const Fractional& a, const Fractional& b) {
  // Files round coordinates such as 1/3; distinct atoms are never so near.
  constexpr double tolerance = 0.1;  // angstrom
  Fractional d{};
  for (std::size_t k = 0; k < 3; ++k) d[k] = a[k] - b[k] - std::round(a[k] - b[k]);
  return length(to_cartesian(cell, d)) < tolerance;
}

/// All images of a site in the cell, each once although the site may lie on a symmetry element.
std::vector<Fractional> images(const Cell& cell, const Fractional& site,
                               const std::vector<gemmi::Op>& operations) {
  std::vector<Fractional> sites;
  for (const gemmi::Op& operation : operations) {
    Fractional image = operation.apply_to_xyz(site);
    for (double& f : image) {
      f -= std::floor(f);
      if (f > 1 - 1e-6) f = 0;
    }
    const bool known = std::any_of(sites.begin(), sites.end(), [&](const Fractional& other) {
      return same_site(cell, image, other);
    });
    if (!known) sites.push_back(image);
  }
  return sites;
}

/// The crystal of a block: its sites and all their images, once each, in the cell.
ParticleSet read_crystal(const std::filesystem::path& path, cif::Block& block, cif::Table& table,
                         const ReadOptions& options) {
  enum { x, y, z, label, symbol, occupancy };
  const auto cell = read_cell(block, "_cell_");
  if (!cell) {
    throw Error(path, fmt::format("block {} has no cell; expected _cell_length_a and the others",
                                  printable(block.name)));
  }
  const std::vector<gemmi::Op> operations = read_symmetry(path, block, options);
  Atoms atoms;
  atoms.particles.cell = cell;
  std::size_t num_unknown = 0;
  for (const auto row : table) {
    Fractional site{};
    bool placed = true;
    for (const int axis : {x, y, z}) {
      double& f = site[static_cast<std::size_t>(axis)];
      f = cif::as_number(row[axis]);
      placed = placed && !cif::is_null(row[axis]);
      if (std::isnan(f) && !cif::is_null(row[axis])) {
        throw Error(path, fmt::format("site {} has fract_{} '{}'; expected a number",
                                      row.row_index + 1, "xyz"[axis], printable(row[axis])));
      }
    }
    if (!placed) {
      ++num_unknown;
      continue;
    }
    const std::string name = row.has(label) ? row.str(label) : "";
    const std::string element = element_symbol(row.has(symbol) ? row.str(symbol) : "", name);
    for (const Fractional& image : images(*cell, site, operations)) {
      const Vector3d p = to_cartesian(*cell, image);
      atoms.add({p.x, p.y, p.z}, element);
      add_if_number(row, occupancy, atoms.occupancy);
    }
  }
  if (num_unknown > 0 && options.warnings != nullptr) {
    options.warnings->add(fmt::format("{}: left out {} sites without coordinates",
                                      printable(path.string()), num_unknown));
  }
  return atoms.finish();
}

/// The last line that is not blank, without blanks around it.
std::string_view last_line(std::string_view content) {
  content = trim(content);
  return trim(content.substr(content.rfind('\n') + 1));
}

std::unique_ptr<Trajectory> open_cif(const std::filesystem::path& path,
                                     const ReadOptions& options) {
  const std::string content = read_decompressed(path, options);
  const auto warn = [&](std::string_view what) {
    if (options.warnings == nullptr) return;
    options.warnings->add(fmt::format("{}: {}", printable(path.string()), what));
  };
  cif::Document document = parse(path, content);
  std::vector<ParticleSet> frames;
  bool macromolecule = false;
  for (cif::Block& block : document.blocks) {
    cif::Table atoms = block.find(
        "_atom_site.", {"Cartn_x", "Cartn_y", "Cartn_z", "?type_symbol", "?label_atom_id", "?id",
                        "?pdbx_PDB_model_num", "?occupancy", "?B_iso_or_equiv", "?label_alt_id",
                        "?auth_asym_id", "?auth_seq_id"});
    if (atoms.length() > 0) {
      macromolecule = true;
      for (ParticleSet& model : read_models(path, block, atoms, options))
        frames.push_back(std::move(model));
      continue;
    }
    cif::Table sites = block.find(
        "_atom_site_", {"fract_x", "fract_y", "fract_z", "?label", "?type_symbol", "?occupancy"});
    if (sites.length() > 0) {
      frames.push_back(read_crystal(path, block, sites, options));
    } else if (block.find_value("_cell_length_a") != nullptr) {
      warn(fmt::format("data_{} has a cell but no atoms; left out", printable(block.name)));
    }
  }
  // Programs close every category of an mmCIF file with '#'; a cut at the end of a line shows only
  // there.
  if (macromolecule && content.find("\n#") != std::string::npos && last_line(content) != "#") {
    warn("does not end with '#' as its other categories do; it may be cut short");
  }
  if (frames.empty()) {
    throw Error(path, "has no atoms; expected _atom_site with Cartn_x or fract_x, y and z");
  }
  // Only now: where reading fails, its error says more.
  if (content.back() != '\n') warn("the last line has no end; it may be cut short");
  return std::make_unique<InMemoryTrajectory>(macromolecule ? "mmCIF" : "CIF", path,
                                              std::move(frames));
}

/// The first line that is no comment opens a block.
bool matches_cif(std::string_view head) {
  while (!head.empty()) {
    const std::string_view line = trim(head.substr(0, head.find('\n')));
    if (!line.empty() && line.front() != '#') {
      const std::string_view start = line.substr(0, 5);
      return start == "data_" || start == "DATA_";
    }
    head.remove_prefix(std::min(head.find('\n'), head.size() - 1) + 1);
  }
  return false;
}

}  // namespace

const Format& cif_format() {
  static const Format format{"mmCIF and CIF", {".cif", ".mmcif", ".mcif"}, matches_cif, open_cif};
  return format;
}

}  // namespace motes
