// Bonds between atoms: those of a file, and the rule for those by distance.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/report.h"
#include "particles/particle_set.h"

namespace motes {

/// Which atoms are bonded by distance: two where the distance d of the one to an image of the other
/// is
///
///     0.4 A < d <= r_i + r_j + 0.45 A
///
/// with the covalent radii of their elements (Cordero et al. 2008), but never two hydrogens: the
/// rule of OpenEye's OEDetermineConnectivity and of Open Babel. Nor two metals, whose bonds have no
/// directions: each atom would have a dozen. The file's length unit is taken for angstrom. Species
/// that are no elements have no bonds.
class BondRule {
 public:
  static constexpr std::uint8_t no_element = 0;

  explicit BondRule(const std::vector<std::string>& species_names);

  /// Atomic numbers of the species, or no_element.
  const std::vector<std::uint8_t>& elements() const { return elements_; }
  /// For two atoms that far apart, squared; any of them may be no_element.
  bool holds(std::uint8_t a, std::uint8_t b, double square) const {
    return square <= squares_[index(a, b)] && square > shortest * shortest;
  }
  /// The longest bond that there may be; 0: none.
  double longest() const { return longest_; }

 private:
  static constexpr double shortest = 0.4;  // angstrom
  static constexpr std::size_t max_elements = 97;
  static std::size_t index(std::uint8_t a, std::uint8_t b) { return max_elements * a + b; }

  std::vector<std::uint8_t> elements_;
  std::array<double, max_elements * max_elements> squares_{};
  double longest_ = 0;
};

/// The order of bonds: by first, then second, then image.
bool bond_comes_first(const Bond& a, const Bond& b);
/// In parallel.
void sort_bonds(std::vector<Bond>& bonds);

/// The bonds that the particles came with, each once, sorted. Those of a particle to itself are
/// left out, with a warning that counts them.
std::vector<Bond> file_bonds(const ParticleSet& particles, Warnings& warnings);

}  // namespace motes
