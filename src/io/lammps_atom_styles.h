// The columns of the Atoms section of a LAMMPS data file.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace motes {

/// Names of the columns up to the position, "id", "type", "mol", "q", ..., "x", "y", "z", of an
/// atom style as the comment behind "Atoms" names it; nothing if the style is not known.
std::optional<std::vector<std::string>> lammps_atom_columns(std::string_view style);

/// The same, guessed from the section's first row: its number of columns, with or without three
/// image flags, and whether the third is one of `num_types` types. Nothing if no style fits.
std::optional<std::vector<std::string>> guess_lammps_atom_columns(std::string_view row,
                                                                  std::uint64_t num_types);

}  // namespace motes
