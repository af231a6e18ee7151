// Conventions of PDB, GROMACS and CHARMM for atom names.
#include "io/atom_names.h"

#include <algorithm>
#include <array>
#include <cctype>

#include "particles/elements.h"

namespace motes {

namespace {

/// The letters that `text` has after any digits, up to the next other character, in upper case.
std::string leading_letters(std::string_view text) {
  std::string letters;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (std::isalpha(byte) != 0) {
      letters += static_cast<char>(std::toupper(byte));
    } else if (!letters.empty() || std::isdigit(byte) == 0) {
      break;
    }
  }
  return letters;
}

template <std::size_t N>
bool contains(const std::array<std::string_view, N>& list, std::string_view word) {
  return std::find(list.begin(), list.end(), word) != list.end();
}

}  // namespace

std::string guess_element(std::string_view name, std::string_view residue) {
  // Elements of organic molecules: a second letter tells the place in the residue.
  static constexpr std::string_view organic = "HCNOSP";
  static constexpr std::array<std::string_view, 2> two_letters{"CL", "SI"};
  const std::string letters = leading_letters(name);
  if (letters.empty()) return std::string(name);
  // An ion is a residue of its own name.
  const bool is_ion = letters == leading_letters(residue);
  std::string first = letters.substr(0, 1);
  if (!is_ion && organic.find(first) != std::string_view::npos &&
      !contains(two_letters, std::string_view(letters).substr(0, 2))) {
    return first;
  }
  for (const std::size_t length : {std::size_t{2}, std::size_t{1}}) {
    const Element* element = find_element(letters.substr(0, length));
    if (element != nullptr) return std::string(element->symbol);
  }
  return std::string(name);
}

bool is_bead_name(std::string_view name) {
  static constexpr std::array<std::string_view, 12> beads{"BB",  "SC1", "SC2", "NC3", "NH3", "PO4",
                                                          "GL0", "GL1", "GL2", "ROH", "W",   "WF"};
  return contains(beads, name);
}

}  // namespace motes
