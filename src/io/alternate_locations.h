// Alternate locations of one atom in structures of macromolecules.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <unordered_map>

#include "core/report.h"

namespace motes {

/// Keeps the first location of an atom that a model lists more than once: together they are one
/// atom, not several.
class AlternateLocations {
 public:
  /// Whether this is a further location of an atom that came before. `label` tells the alternates
  /// apart ("A", "B"; "" for an atom that has one place); `residue` tells the chain too.
  bool skip(std::string_view label, std::string_view name, std::string_view residue);

  /// Warns of what was left out.
  void warn(const std::filesystem::path& path, Warnings* warnings) const;

 private:
  std::unordered_map<std::string, std::string> first_labels_;  ///< by atom
  std::size_t num_skipped_ = 0;
};

}  // namespace motes
