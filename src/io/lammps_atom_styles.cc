// Atom styles, from docs.lammps.org/read_data.html.
#include "io/lammps_atom_styles.h"

#include <algorithm>
#include <array>

#include "io/text.h"

namespace motes {

namespace {

struct AtomStyle {
  std::string_view name, columns;
};

constexpr std::array<AtomStyle, 26> styles{{
    {"amoeba", "id mol type q x y z"},
    {"angle", "id mol type x y z"},
    {"atomic", "id type x y z"},
    {"body", "id type bodyflag mass x y z"},
    {"bond", "id mol type x y z"},
    {"bpm/sphere", "id mol type diameter density x y z"},
    {"charge", "id type q x y z"},
    {"dielectric", "id mol type q x y z"},
    {"dipole", "id type q x y z"},
    {"dpd", "id type theta x y z"},
    {"edpd", "id type edpd_temp edpd_cv x y z"},
    {"electron", "id type q spin eradius x y z"},
    {"ellipsoid", "id type ellipsoidflag density x y z"},
    {"full", "id mol type q x y z"},
    {"hybrid", "id type x y z"},
    {"line", "id mol type lineflag density x y z"},
    {"mdpd", "id type rho x y z"},
    {"meso", "id type rho esph cv x y z"},
    {"molecular", "id mol type x y z"},
    {"peri", "id type volume density x y z"},
    {"smd", "id type mol volume mass kradius cradius x0 y0 z0 x y z"},
    {"sph", "id type rho esph cv x y z"},
    {"sphere", "id type diameter density x y z"},
    {"spin", "id type x y z"},
    {"tdpd", "id type x y z"},
    {"tri", "id mol type triangleflag density x y z"},
}};

std::vector<std::string> split_names(std::string_view names) {
  const auto tokens = split_tokens(names);
  return {tokens.begin(), tokens.end()};
}

}  // namespace

std::optional<std::vector<std::string>> lammps_atom_columns(std::string_view style) {
  const auto it = std::find_if(styles.begin(), styles.end(),
                               [&](const AtomStyle& s) { return s.name == style; });
  if (it == styles.end()) return std::nullopt;
  return split_names(it->columns);
}

std::optional<std::vector<std::string>> guess_lammps_atom_columns(std::string_view row,
                                                                  std::uint64_t num_types) {
  const auto tokens = split_tokens(row);
  const auto is_integer = [](std::string_view token) { return to_integer(token).has_value(); };
  const bool images = tokens.size() >= 8 && std::all_of(tokens.end() - 3, tokens.end(), is_integer);
  const std::size_t num_columns = images ? tokens.size() - 3 : tokens.size();
  if (num_columns < 5) return std::nullopt;
  const auto third = to_integer(tokens[2]);
  const bool has_molecule =
      third && *third >= 1 && static_cast<std::uint64_t>(*third) <= std::max(num_types, {1});
  if (num_columns == 5) return lammps_atom_columns("atomic");
  if (num_columns == 6) return lammps_atom_columns(has_molecule ? "molecular" : "charge");
  if (num_columns == 7) return lammps_atom_columns(has_molecule ? "full" : "sphere");
  return std::nullopt;
}

}  // namespace motes
