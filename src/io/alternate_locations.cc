// Remembers which atoms have come, by residue and name.
#include "io/alternate_locations.h"

#include <fmt/format.h>

#include "core/error.h"

namespace motes {

bool AlternateLocations::skip(std::string_view label, std::string_view name,
                              std::string_view residue) {
  if (label.empty()) return false;
  const auto [it, is_first] =
      first_labels_.try_emplace(fmt::format("{}\n{}", residue, name), label);
  // The same label again: not an alternate, but numbers of residues that began anew.
  if (is_first || it->second == label) return false;
  ++num_skipped_;
  return true;
}

void AlternateLocations::warn(const std::filesystem::path& path, Warnings* warnings) const {
  if (num_skipped_ == 0 || warnings == nullptr) return;
  warnings->add(fmt::format("{}: left out {} alternate locations of atoms",
                            printable(path.string()), num_skipped_));
}

}  // namespace motes
