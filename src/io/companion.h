// Files that a file refers to: the values of an NRRD header, other parts of a snapshot, links of
// HDF5.
#pragma once

#include <filesystem>

namespace motes {

/// For programs that open files for others, such as servers: from now on, in the whole process,
/// files that refer to any that are not beside them, after following links, are refused, and so are
/// links and values of HDF5 that lie in other files. Not to be undone.
void keep_to_own_directories();

/// The same has been asked for.
bool keeps_to_own_directories();

/// The file that `file` calls `name`, relative to its directory. Throws Error if that is to be kept
/// to and it lies elsewhere.
std::filesystem::path companion_of(const std::filesystem::path& file,
                                   const std::filesystem::path& name);

}  // namespace motes
