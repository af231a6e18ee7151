// The comment line of an extended XYZ frame.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "particles/cell.h"

namespace motes {

/// One entry of Properties=NAME:TYPE:COUNT:...
struct ExtxyzProperty {
  std::string name;
  char type = 'R';  ///< R real, I integer, S string, L logical
  int count = 1;    ///< columns
};

struct ExtxyzComment {
  std::vector<ExtxyzProperty> properties;  ///< empty: a plain XYZ file
  std::optional<Cell> cell;                ///< from Lattice, Origin and pbc
  std::optional<double> time;
};

/// Reads the keys Properties, Lattice, Origin, pbc and Time, in any case. A line that is no list of
/// keys and values is a plain comment. Throws Error, without file and line, for a value of a known
/// key that is not as it must be.
ExtxyzComment parse_extxyz_comment(std::string_view line);

}  // namespace motes
