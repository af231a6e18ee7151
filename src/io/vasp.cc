// VASP's structures (POSCAR, CONTCAR) and the volumes that begin with one: CHGCAR, AECCAR, PARCHG,
// LOCPOT, ELFCAR (www.vasp.at/wiki/index.php/POSCAR and /CHGCAR).
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
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

/// The numbers that `line` begins with, up to a comment.
std::vector<double> leading_reals(std::string_view line) {
  std::vector<double> values;
  for (std::string_view token = next_token(line); !token.empty(); token = next_token(line)) {
    const auto value = to_real(token);
    if (!value) break;
    values.push_back(*value);
  }
  return values;
}

Vector3d scaled(const Vector3d& v, const Vector3d& scale) {
  return {v.x * scale.x, v.y * scale.y, v.z * scale.z};
}

double volume_of(const std::array<Vector3d, 3>& vectors) {
  return std::abs(dot(vectors[0], cross(vectors[1], vectors[2])));
}

/// What all coordinates are multiplied with: one factor, or, where it is negative, the one that
/// makes the volume its amount; or one along each axis.
Vector3d find_scale(LineReader& lines, const std::vector<double>& factors,
                    const std::array<Vector3d, 3>& vectors) {
  const double volume = volume_of(vectors);
  if (!(volume > 0) || !std::isfinite(volume)) {
    lines.fail("expected three vectors that span a cell with a volume");
  }
  if (factors.size() >= 3) return {factors[0], factors[1], factors[2]};
  const double factor = factors[0] > 0 ? factors[0] : std::cbrt(-factors[0] / volume);
  return {factor, factor, factor};
}

/// The scale and the three vectors of the cell.
Vector3d read_cell(LineReader& lines, std::array<Vector3d, 3>& vectors) {
  constexpr std::string_view expected_scale = "the scale of the cell, one number or three";
  const std::string_view scale_line = lines.next(expected_scale);
  const std::vector<double> factors = leading_reals(scale_line);
  const bool good = factors.size() == 1
                        ? factors[0] != 0 && std::isfinite(factors[0])
                        : factors.size() >= 3 && factors[0] > 0 && factors[1] > 0 && factors[2] > 0;
  if (!good) {
    lines.fail(fmt::format("expected {}, found '{}'", expected_scale, printable(trim(scale_line))));
  }
  for (Vector3d& v : vectors) {
    constexpr std::string_view expected = "a vector of the cell";
    const std::string_view line = lines.next(expected);
    const std::vector<double> values = leading_reals(line);
    if (values.size() < 3) {
      lines.fail(fmt::format("expected {}, found '{}'", expected, printable(trim(line))));
    }
    v = {values[0], values[1], values[2]};
  }
  const Vector3d scale = find_scale(lines, factors, vectors);
  for (Vector3d& v : vectors) v = scaled(v, scale);
  return scale;
}

/// "Fe_pv/3a9c" of a pseudopotential -> "Fe"; a word that is no element stays.
std::string species_name(std::string_view word) {
  const std::string_view name = word.substr(0, word.find('/'));
  const Element* element = find_element(name);
  return std::string(element != nullptr ? element->symbol : name);
}

/// Species and how many of each there are: a line of names, absent in VASP 4, whose users write
/// them in the title, and a line of counts.
struct Species {
  std::vector<std::string> names;  ///< empty if there are none
  std::vector<std::uint64_t> counts;
  std::uint64_t total = 0;
};

Species read_species(LineReader& lines, std::string_view title) {
  constexpr std::string_view expected = "the number of atoms of each species";
  Species species;
  if (title.starts_with('#')) title.remove_prefix(1);
  std::vector<std::string_view> names = split_tokens(title);
  const bool title_names_elements =
      std::all_of(names.begin(), names.end(),
                  [](std::string_view name) { return find_element(name) != nullptr; });
  std::string_view line = lines.next("the names of the species, or their numbers of atoms");
  std::vector<std::string_view> counts = split_tokens(line);
  const bool named = !counts.empty() && !to_integer(counts[0]);
  if (named) {
    names = counts;
    line = lines.next(expected);
    counts = split_tokens(line);
  }
  for (const std::string_view token : counts) {
    if (!to_count(token) && !species.counts.empty()) break;  // a comment
    species.counts.push_back(lines.parse_count(token, expected));
    constexpr std::uint64_t most_atoms = 1000000000, most_species = 1000;
    if (species.counts.back() > most_atoms || species.counts.size() > most_species) {
      lines.fail("expected at most 1000 species of at most 10^9 atoms");
    }
    species.total += species.counts.back();
  }
  if (species.total == 0) lines.fail(fmt::format("expected {}, at least 1", expected));
  if (named && names.size() != species.counts.size()) {
    lines.fail(fmt::format("expected {} numbers of atoms, one a species, found {}", names.size(),
                           species.counts.size()));
  }
  if (named || (title_names_elements && names.size() == species.counts.size())) {
    for (const std::string_view name : names) species.names.push_back(species_name(name));
  }
  return species;
}

/// Species are types: what the user says goes before what the file says.
void name_species(const std::filesystem::path& path, const Species& species,
                  const ReadOptions& options, ParticleSet& atoms) {
  Column types{.name = "species", .kind = Column::Kind::word};
  TypeHints hints;
  types.word_indices.reserve(species.total);
  for (std::size_t s = 0; s < species.counts.size(); ++s) {
    types.words.push_back(std::to_string(s + 1));
    if (!species.names.empty()) hints.labels[types.words.back()] = species.names[s];
    types.word_indices.insert(types.word_indices.end(), species.counts[s],
                              static_cast<std::uint16_t>(s));
  }
  name_types(path, types, hints, options, atoms);
}

/// The three numbers of a grid, if that is what the line is.
std::optional<std::array<std::size_t, 3>> dims_in(std::string_view line) {
  const auto tokens = split_tokens(line);
  if (tokens.size() != 3) return std::nullopt;
  std::array<std::size_t, 3> dims{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto n = to_count(tokens[axis]);
    if (!n || *n == 0) return std::nullopt;
    dims[axis] = *n;
  }
  return dims;
}

/// The structure: of a file of nothing else all that is read. What follows it, such as velocities,
/// is left in `lines`.
ParticleSet read_structure(const std::filesystem::path& path, LineReader& lines,
                           const ReadOptions& options) {
  const std::string_view title = lines.next("a title line");
  Cell cell;
  const Vector3d scale = read_cell(lines, cell.vectors);
  const Species species = read_species(lines, title);
  constexpr std::string_view expected = "Direct or Cartesian";
  const auto first_letter = [](std::string_view line) {
    const std::string_view word = trim(line);
    return word.empty() ? ' '
                        : static_cast<char>(std::toupper(static_cast<unsigned char>(word[0])));
  };
  std::string_view line = lines.next(expected);
  if (first_letter(line) == 'S') line = lines.next(expected);  // Selective dynamics
  const bool cartesian = first_letter(line) == 'C' || first_letter(line) == 'K';
  if (!cartesian && first_letter(line) != 'D') {
    lines.fail(fmt::format("expected {}, found '{}'", expected, printable(trim(line))));
  }

  std::vector<Column> columns;
  for (const char* axis : {"x", "y", "z"}) {
    columns.push_back({.name = axis, .kind = Column::Kind::real});
  }
  const TextBlock rows = lines.take_rows(species.total, "atoms");
  parse_table(path, rows, species.total, RowWidth::at_least, columns, options);
  if (!rows.text.ends_with('\n')) warn_of_open_end(path, lines.line(), options.warnings);
  const auto& [a, b, c] = cell.vectors;
  auto &x = columns[0].reals, &y = columns[1].reals, &z = columns[2].reals;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const Vector3d p =
        cartesian ? scaled({x[i], y[i], z[i]}, scale) : x[i] * a + y[i] * b + z[i] * c;
    x[i] = p.x;
    y[i] = p.y;
    z[i] = p.z;
  }
  // With a grid they belong to the cell that it fills; structures alone stay as they are.
  if (lines.skip_blank_lines() && dims_in(lines.peek())) move_into_cell(cell, x, y, z);
  ParticleSet atoms;
  atoms.length_unit = "angstrom";
  atoms.cell = cell;
  set_positions(atoms, x, y, z);
  name_species(path, species, options, atoms);
  return atoms;
}

std::unique_ptr<Trajectory> open_vasp(const std::filesystem::path& path,
                                      const ReadOptions& options) {
  std::vector<ParticleSet> frames;
  frames.push_back(parse_head(
      path, options, [&](LineReader& lines) { return read_structure(path, lines, options); }));
  return std::make_unique<InMemoryTrajectory>("VASP", path, std::move(frames));
}

bool is_named_as_grid(const std::filesystem::path& path) {
  const std::string file = bare_name(path);
  constexpr std::string_view names[] = {"chgcar", "aeccar", "parchg", "locpot", "elfcar"};
  return std::any_of(std::begin(names), std::end(names), [&file](std::string_view name) {
    return file.find(name) != std::string::npos;
  });
}

bool has_grid(const std::filesystem::path& path) {
  // (of a volume without a grid, or a bad one, its reader says what is wrong)
  if (is_named_as_grid(path)) return true;
  try {
    return parse_head(path, {}, [&](LineReader& lines) {
      read_structure(path, lines, {});
      return lines.skip_blank_lines() && dims_in(lines.next("")).has_value();
    });
  } catch (const Error&) {
    return false;  // whoever reads it as particles says what is wrong
  }
}

/// Reads the blocks of values, all of one size, with what stands between them.
class BlockReader {
 public:
  /// `text` is what follows the structure.
  BlockReader(const std::filesystem::path& path, TextBlock text, std::size_t num_atoms,
              const ReadOptions& options)
      : path_(path), options_(options), num_atoms_(num_atoms) {
    LineReader lines(path_, text, true);
    if (!lines.skip_blank_lines()) {
      throw Error(path_, "has no grid behind its atoms; expected the three numbers of one");
    }
    const std::string_view line = lines.next("");
    const auto dims = dims_in(line);
    if (!dims) {
      lines.fail(fmt::format("expected the three numbers of a grid behind {} atoms, found '{}'",
                             num_atoms_, printable(trim(line))));
    }
    dims_ = *dims;
    dims_line_ = lines.line();
    num_samples_ = count_samples(path_, dims_);
    rest_ = lines.rest();
  }

  const std::array<std::size_t, 3>& dims() const { return dims_; }

  /// The next block, each value times `factor`.
  UninitializedVector<float> read(double factor) {
    const NumberText numbers(path_, rest_, num_samples_);
    numbers.warn_if_open(options_);
    UninitializedVector<float> values(num_samples_);
    numbers.parse(options_, [&](std::uint64_t n, double value) {
      values[n] = static_cast<float>(factor * value);
    });
    LineReader lines(path_, numbers.rest(), true);
    if (const std::string_view left = trim(lines.peek()); !left.empty()) {
      lines.next("");
      lines.fail(fmt::format("expected the end of the line after {}, found '{}'", values_of_grid(),
                             printable(left)));
    }
    rest_ = lines.rest();
    return values;
  }

  /// Moves behind the numbers of another block's grid; false at the end of the file. Between blocks
  /// are the occupancies of each atom's augmentation and, in runs with spin, a number for each
  /// atom.
  bool find_next() {
    LineReader lines(path_, rest_, true);
    bool moments_read = false;
    while (lines.skip_blank_lines()) {
      const std::string_view line = lines.peek();
      const auto tokens = split_tokens(line);
      if (const auto dims = dims_in(line)) {
        lines.next("");
        if (*dims != dims_) {
          lines.fail(fmt::format("expected {} again, found '{}'", grid(), printable(trim(line))));
        }
        rest_ = lines.rest();
        return true;
      }
      if (tokens[0].starts_with("augmentation")) {
        lines.next("");
        skip_numbers(lines,
                     lines.parse_count(tokens.back(), "the number of augmentation occupancies"));
      } else if (!moments_read && to_real(tokens[0])) {
        skip_numbers(lines, num_atoms_,
                     fmt::format(" of atoms or the end of the file after {}", values_of_grid()));
        moments_read = true;
      } else {
        lines.next("");
        lines.fail(fmt::format(
            "expected augmentation occupancies, {} again or the end of the file, found '{}'",
            grid(), printable(trim(line))));
      }
    }
    // (numbers that nothing follows are values too many)
    if (moments_read) {
      lines.fail(
          fmt::format("expected {} again behind the numbers after {}", grid(), values_of_grid()));
    }
    return false;
  }

 private:
  std::string grid() const {
    return fmt::format("the grid's {} {} {}", dims_[0], dims_[1], dims_[2]);
  }
  std::string values_of_grid() const {
    return fmt::format("{} values ({} x {} x {} by line {})", num_samples_, dims_[0], dims_[1],
                       dims_[2], dims_line_);
  }

  /// `count` numbers, which end a line; `of` says which and what else may be there.
  static void skip_numbers(LineReader& lines, std::uint64_t count, std::string_view of = "") {
    for (std::uint64_t found = 0; found < count;) {
      for (const std::string_view token : split_tokens(lines.next("the numbers of the atoms"))) {
        double value = 0;
        const char* const end = token.data() + token.size();
        if (parse_fortran_real(token.data(), end, value) != end || ++found > count) {
          lines.fail(fmt::format("expected {} numbers{}, found '{}' behind {} of them", count, of,
                                 printable(token), std::min(found, count)));
        }
      }
    }
  }

  const std::filesystem::path& path_;
  const ReadOptions& options_;
  std::size_t num_atoms_;
  TextBlock rest_;
  std::array<std::size_t, 3> dims_{};
  std::uint64_t dims_line_ = 0;
  std::uint64_t num_samples_ = 0;
};

/// Names of the blocks: one without spin, two with, four where spins have directions; nothing for
/// other numbers of them.
std::vector<std::string> names_of(const std::filesystem::path& path, std::size_t num_blocks) {
  const std::string file = bare_name(path);
  std::string name = "density";
  if (file.find("locpot") != std::string::npos) name = "potential";
  if (file.find("elfcar") != std::string::npos) name = "elf";
  if (num_blocks == 1) return {name};
  if (num_blocks == 2) return {name, "spin"};
  if (num_blocks == 4) return {name, "spin_x", "spin_y", "spin_z"};
  return {};
}

std::vector<Grid> read_vasp_grids(const std::filesystem::path& path, const ReadOptions& options) {
  const FileContent content(path, options);
  LineReader lines(path, {content.bytes(), 1}, true);
  const ParticleSet atoms = read_structure(path, lines, options);
  BlockReader blocks(path, lines.rest(), atoms.size(), options);

  Grid shape;
  shape.dims = blocks.dims();
  shape.periodic = true;
  shape.length_unit = atoms.length_unit;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    shape.steps[axis] = atoms.cell->vectors[axis] / static_cast<double>(shape.dims[axis]);
  }
  check_steps(path, shape);
  // Densities are stored times the volume of the cell; potentials and localisation are as they are.
  const bool density = names_of(path, 1)[0] == "density";
  const double factor = density ? 1 / volume_of(atoms.cell->vectors) : 1;
  std::vector<Grid> grids;
  do {
    grids.push_back(shape);
    grids.back().values = blocks.read(factor);
  } while (blocks.find_next());
  const std::vector<std::string> names = names_of(path, grids.size());
  if (names.empty()) {
    throw Error(path, fmt::format("has {} blocks of values; expected 1, 2 or 4", grids.size()));
  }
  for (std::size_t i = 0; i < grids.size(); ++i) grids[i].name = names[i];
  return grids;
}

/// A scale, three vectors, names or counts, counts, and how positions are given.
bool matches_vasp(std::string_view head) {
  std::array<std::string_view, 8> lines;
  for (auto& line : lines) {
    const std::size_t newline = head.find('\n');
    line = trim(head.substr(0, newline));
    head.remove_prefix(newline == std::string_view::npos ? head.size() : newline + 1);
  }
  const auto is_counts = [](std::string_view line) {
    const auto tokens = split_tokens(line);
    return !tokens.empty() && to_integer(tokens[0]).has_value();  // (the reader refuses negative)
  };
  if (leading_reals(lines[1]).empty()) return false;
  for (std::size_t i = 2; i < 5; ++i) {
    if (leading_reals(lines[i]).size() < 3) return false;
  }
  const std::size_t counts_at = is_counts(lines[5]) ? 5 : 6;
  if (!is_counts(lines[counts_at])) return false;
  const std::string_view mode = lines[counts_at + 1];
  return !mode.empty() && std::string_view("SsDdCcKk").find(mode[0]) != std::string_view::npos;
}

}  // namespace

const Format& vasp_format() {
  static const Format format{
      "VASP", {"poscar", "contcar", "chgcar", ".vasp"}, matches_vasp, open_vasp};
  return format;
}

const GridFormat& vasp_grid_format() {
  static const GridFormat format{"VASP", {"chgcar"}, matches_vasp, read_vasp_grids, has_grid};
  return format;
}

}  // namespace motes
