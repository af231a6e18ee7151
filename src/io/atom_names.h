// Elements from the names of atoms in biomolecular files, which have no column for them.
#pragma once

#include <string>
#include <string_view>

namespace motes {

/// Symbol of the element that the atom `name` of residue `residue` is: "CA" is carbon but for the
/// calcium ion, the residue CA; "1HB2" is hydrogen. The name itself where there is none: beads.
std::string guess_element(std::string_view name, std::string_view residue);

/// Whether an atom of this name shows that the file is coarse-grained (names of the Martini force
/// field, cgmartini.nl): its beads are no elements, whatever they are called.
bool is_bead_name(std::string_view name);

}  // namespace motes
