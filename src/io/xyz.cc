// XYZ and extended XYZ, with any number of frames.
// The extended form: github.com/libAtoms/extxyz and
// wiki.fysik.dtu.dk/ase/ase/io/formatoptions.html.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "io/extxyz_comment.h"
#include "io/formats.h"
#include "io/table.h"
#include "io/text_trajectory.h"
#include "io/type_names.h"

namespace motes {

namespace {

std::uint64_t read_count(LineReader& lines) {
  constexpr std::string_view what = "the number of atoms";
  return lines.parse_count(lines.next_filled(what), what);
}

/// What a column of Properties=... is for.
enum class Role { species, atomic_number, position, id, property, none };

struct XyzColumns {
  std::vector<Column> columns;
  std::vector<Role> roles;

  void add(std::string name, Column::Kind kind, Role role) {
    columns.push_back({.name = std::move(name), .kind = kind});
    roles.push_back(role);
  }
};

XyzColumns plain_columns(bool numbers) {
  XyzColumns plain;
  plain.add("species", numbers ? Column::Kind::integer : Column::Kind::word,
            numbers ? Role::atomic_number : Role::species);
  for (const char* axis : {"x", "y", "z"}) plain.add(axis, Column::Kind::real, Role::position);
  return plain;
}

/// Name of component `k` of `count` of the property `name`: velocities are vx, vy, vz.
std::string component_name(const ExtxyzProperty& property, int k) {
  static constexpr std::array<std::string_view, 3> axes{"x", "y", "z"};
  const std::string& name = property.name;
  if (property.count == 1) return name == "masses" ? "mass" : name;
  if (property.count != 3) return fmt::format("{}_{}", name, k + 1);
  const std::string_view axis = axes[static_cast<std::size_t>(k)];
  const bool velocity = name == "velo" || name == "vel" || name == "velocities" || name == "v";
  return velocity ? fmt::format("v{}", axis) : fmt::format("{}_{}", name, axis);
}

Role role_of(const ExtxyzProperty& property) {
  if (property.name == "pos" && property.count == 3) return Role::position;
  if (property.count == 1) {
    if (property.name == "species" || property.name == "element") return Role::species;
    if (property.type == 'I' && (property.name == "Z" || property.name == "numbers")) {
      return Role::atomic_number;
    }
    if (property.type == 'I' && property.name == "id") return Role::id;
  }
  return property.type == 'S' ? Role::none : Role::property;
}

XyzColumns extended_columns(const std::vector<ExtxyzProperty>& properties) {
  XyzColumns out;
  for (const ExtxyzProperty& property : properties) {
    const Role role = role_of(property);
    Column::Kind kind = Column::Kind::single;
    if (role == Role::position) kind = Column::Kind::real;
    if (role == Role::species) kind = Column::Kind::word;
    if (role == Role::atomic_number || role == Role::id) kind = Column::Kind::integer;
    if (role == Role::none) kind = Column::Kind::ignored;
    if (role == Role::property && property.type == 'L') kind = Column::Kind::logical;
    for (int k = 0; k < property.count; ++k) out.add(component_name(property, k), kind, role);
  }
  return out;
}

class Xyz : public TextTrajectory {
 public:
  Xyz(const std::filesystem::path& path, const ReadOptions& options)
      : TextTrajectory(path, options) {}

  std::string_view format() const override { return "XYZ"; }

 protected:
  void skip_frame(LineReader& lines) const override {
    const std::uint64_t count = read_count(lines);
    lines.next("the comment line");
    lines.skip(count, "atoms");
    // More rows than the count says must not be lost.
    if (!lines.skip_blank_lines() || to_count(lines.peek())) return;
    const std::string_view next = lines.next("");
    lines.fail(fmt::format("expected the number of atoms of a new frame after {} atoms, found '{}'",
                           count, printable(trim(next))));
  }

  ParticleSet parse_frame(TextBlock frame) override {
    LineReader lines(path(), frame, true);
    const std::uint64_t count = read_count(lines);
    const std::string_view comment_line = lines.next("the comment line");
    ExtxyzComment comment;
    try {
      comment = parse_extxyz_comment(comment_line);
    } catch (const Error& error) {
      lines.fail(error.what());
    }
    std::string_view first_row = lines.peek();
    const bool numbers = to_integer(next_token(first_row)).has_value();
    const bool extended = !comment.properties.empty();
    XyzColumns xyz = extended ? extended_columns(comment.properties) : plain_columns(numbers);
    check_positions(xyz, lines);
    parse_table(path(), lines.rest(), count, extended ? RowWidth::exact : RowWidth::at_least,
                xyz.columns, options());

    ParticleSet particles;
    particles.length_unit = "angstrom";
    particles.time = comment.time;
    particles.cell = comment.cell;
    take_columns(xyz, particles);
    return particles;
  }

 private:
  static void check_positions(const XyzColumns& xyz, const LineReader& lines) {
    if (std::count(xyz.roles.begin(), xyz.roles.end(), Role::position) != 3) {
      lines.fail("expected pos:R:3 among the Properties");
    }
  }

  void take_columns(XyzColumns& xyz, ParticleSet& particles) const {
    std::vector<std::vector<double>*> positions;
    for (std::size_t c = 0; c < xyz.columns.size(); ++c) {
      Column& column = xyz.columns[c];
      switch (xyz.roles[c]) {
        case Role::species:
          name_types(path(), column, {}, options(), particles);
          break;
        case Role::atomic_number:
          if (particles.species.empty()) name_elements(column.integers, particles);
          break;
        case Role::position:
          positions.push_back(&column.reals);
          break;
        case Role::id:
          particles.ids = std::move(column.integers);
          break;
        case Role::property:
          if (particles.find_property(column.name) == nullptr) {
            particles.properties.push_back({column.name, std::move(column.singles)});
          }
          break;
        case Role::none:
          break;
      }
    }
    set_positions(particles, *positions[0], *positions[1], *positions[2]);
  }
};

/// A count, any line, and a row of a name and three numbers (or a comment that says its columns).
bool matches(std::string_view head) {
  std::array<std::string_view, 3> lines;
  for (auto& line : lines) {
    const std::size_t newline = head.find('\n');
    line = head.substr(0, newline);
    head.remove_prefix(newline == std::string_view::npos ? head.size() : newline + 1);
  }
  const auto count = to_count(lines[0]);
  if (!count) return false;
  if (lines[1].find("Properties=") != std::string_view::npos) return true;
  const auto row = split_tokens(lines[2]);
  return row.size() >= 4 && to_real(row[1]) && to_real(row[2]) && to_real(row[3]);
}

}  // namespace

const Format& xyz_format() {
  static const Format format{"XYZ",
                             {".xyz", ".extxyz"},
                             matches,
                             [](const std::filesystem::path& path,
                                const ReadOptions& options) -> std::unique_ptr<Trajectory> {
                               return std::make_unique<Xyz>(path, options);
                             }};
  return format;
}

}  // namespace motes
