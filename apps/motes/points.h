// Points of a CSV file or the standard input.
#pragma once

#include <string>
#include <vector>

#include "core/vec.h"

namespace motes {

/// Reads points from `path`, or from the standard input where it is "-": values between commas,
/// semicolons, tabs or blanks; the columns x, y and z of a first line of names, or the first three.
/// Empty lines and those that begin with # are left out. Throws Error that names the line.
std::vector<Point3d> read_points(const std::string& path);

}  // namespace motes
