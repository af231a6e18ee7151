#include "particles/bonds.h"

#include <fmt/format.h>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <cassert>
#include <tuple>

#include "particles/elements.h"

namespace motes {

BondRule::BondRule(const std::vector<std::string>& species_names) {
  constexpr double tolerance = 0.45;  // angstrom
  constexpr std::uint8_t hydrogen = 1;
  for (const std::string& name : species_names) {
    const Element* element = find_element(name);
    elements_.push_back(element != nullptr ? static_cast<std::uint8_t>(element->number)
                                           : no_element);
  }
  for (const std::uint8_t a : elements_) {
    for (const std::uint8_t b : elements_) {
      if (a == no_element || b == no_element || (a == hydrogen && b == hydrogen)) continue;
      const Element &first = *element_by_number(a), &second = *element_by_number(b);
      if (is_metal(first) && is_metal(second)) continue;
      const double reach = static_cast<double>(first.covalent_radius) +
                           static_cast<double>(second.covalent_radius) + tolerance;
      squares_[index(a, b)] = reach * reach;
      longest_ = std::max(longest_, reach);
    }
  }
}

bool bond_comes_first(const Bond& a, const Bond& b) {
  return std::tie(a.first, a.second, a.image) < std::tie(b.first, b.second, b.image);
}

void sort_bonds(std::vector<Bond>& bonds) {
  // (a lambda, which the sort can inline)
  tbb::parallel_sort(bonds.begin(), bonds.end(),
                     [](const Bond& a, const Bond& b) { return bond_comes_first(a, b); });
}

std::vector<Bond> file_bonds(const ParticleSet& particles, Warnings& warnings) {
  std::vector<Bond> bonds;
  bonds.reserve(particles.bonds.size());
  for (const Bond& bond : particles.bonds) {
    assert(std::max(bond.first, bond.second) < particles.size());
    const auto [first, second] = std::minmax(bond.first, bond.second);
    if (first != second) bonds.push_back({first, second});
  }
  if (const std::size_t lone = particles.bonds.size() - bonds.size(); lone > 0) {
    warnings.add(fmt::format("{} of a particle to itself left out",
                             lone == 1 ? "1 bond" : fmt::format("{} bonds", lone)));
  }
  sort_bonds(bonds);
  bonds.erase(std::unique(bonds.begin(), bonds.end()), bonds.end());
  return bonds;
}

}  // namespace motes
