// Names for numeric particle types.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "io/reader.h"
#include "io/table.h"

namespace motes {

/// What a file says of its types, by the type as it is written there.
struct TypeHints {
  std::map<std::string, std::string> labels;  ///< names that the file itself gives
  std::map<std::string, double> masses;       ///< u
};

/// Fills species and species_names of `particles` from a column of words, types sorted by number.
/// A type is named by the first of: options.types; the file's label, if it names the element that
/// the mass says, or the mass says none; the element of its mass, with a warning; its own number.
void name_types(const std::filesystem::path& file, const Column& types, const TypeHints& hints,
                const ReadOptions& options, ParticleSet& particles);

/// Fills species and species_names of `particles` from atomic numbers, which become symbols; a
/// number that is no element's stays a number.
void name_elements(const std::vector<std::int64_t>& numbers, ParticleSet& particles);

/// Warns of each type that options.types names but that is not among the file's `types`: the user
/// may have made a slip. Part of name_types().
void warn_of_absent_types(const std::filesystem::path& file, const std::vector<std::string>& types,
                          const ReadOptions& options);

}  // namespace motes
