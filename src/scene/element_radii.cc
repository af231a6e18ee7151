#include "scene/element_radii.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "core/error.h"
#include "particles/elements.h"
#include "particles/radii.h"

namespace motes {
namespace {

/// Whether any particle is of a species that is an element.
bool any_element(const ParticleSet& particles) {
  std::vector<bool> is_element(particles.species_names.size());
  std::transform(particles.species_names.begin(), particles.species_names.end(), is_element.begin(),
                 [](const std::string& name) { return find_element(name) != nullptr; });
  return std::any_of(particles.species.begin(), particles.species.end(),
                     [&](std::uint16_t species) { return is_element[species]; });
}

/// One for each species that the particles have. Precondition: one of them is an element.
std::vector<float> radii_of_species(const ParticleSet& particles, ElementRadius table,
                                    Warnings& warnings) {
  std::vector<float> radii;
  double sum = 0;
  int known = 0;
  for (const std::string& name : particles.species_names) {
    const Element* element = find_element(name);
    radii.push_back(std::numeric_limits<float>::quiet_NaN());
    if (element == nullptr) continue;
    radii.back() = table == ElementRadius::covalent ? element->covalent_radius
                                                    : van_der_waals_radius(*element);
    sum += radii.back();
    ++known;
  }
  const auto other = static_cast<float>(sum / known);
  std::string names;
  for (std::size_t s = 0; s < radii.size(); ++s) {
    if (!std::isnan(radii[s])) continue;
    radii[s] = other;
    names += (names.empty() ? "" : ", ") + printable(particles.species_names[s]);
  }
  if (!names.empty()) {
    warnings.add(fmt::format("no elements, and of the radius {:.3g}: the species {}", other,
                             printable(names, 200)));
  }
  return radii;
}

}  // namespace

const std::vector<std::string>& element_radius_names() {
  static const std::vector<std::string> names{"van_der_waals", "covalent"};
  return names;
}

std::optional<ElementRadius> element_radius_from_name(std::string_view name) {
  if (name == "van_der_waals") return ElementRadius::van_der_waals;
  if (name == "covalent") return ElementRadius::covalent;
  return std::nullopt;
}

std::vector<float> radii_by_element(const ParticleSet& particles, ElementRadius table,
                                    const std::vector<bool>& wanted, Warnings& warnings,
                                    Progress* progress) {
  if (!any_element(particles)) {
    DefaultRadii own = default_radii(particles, warnings, wanted, progress);
    warnings.add(
        fmt::format("{} radii: none of the particles is of a chemical element; taken instead: {}",
                    table == ElementRadius::covalent ? "covalent" : "van der Waals", own.source));
    return std::move(own.radius);
  }
  const std::vector<float> of_species = radii_of_species(particles, table, warnings);
  std::vector<float> radii(particles.size());
  std::transform(particles.species.begin(), particles.species.end(), radii.begin(),
                 [&](std::uint16_t species) { return of_species[species]; });
  return radii;
}

}  // namespace motes
