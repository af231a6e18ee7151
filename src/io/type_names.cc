// Types to names: what the user says, what the file says, what the masses say.
#include "io/type_names.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <optional>

#include "particles/elements.h"

namespace motes {

namespace {

std::optional<std::string> given_name(const std::string& type, const TypeHints& hints,
                                      const ReadOptions& options) {
  if (const auto number = to_integer(type)) {
    for (const auto& [key, name] : options.types) {
      if (key == *number) return name;
    }
  }
  const auto label = hints.labels.find(type);
  if (label != hints.labels.end()) return label->second;
  return std::nullopt;
}

const Element* element_of_mass(const std::string& type, const TypeHints& hints) {
  const auto mass = hints.masses.find(type);
  return mass == hints.masses.end() ? nullptr : element_by_mass(mass->second);
}

/// Indices of `types` in the order of their numbers; those that are words come last.
std::vector<std::size_t> sorted_types(const std::vector<std::string>& types) {
  std::vector<std::size_t> order(types.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    const auto number_a = to_integer(types[a]), number_b = to_integer(types[b]);
    if (number_a && number_b) return *number_a < *number_b;
    return number_a.has_value() && !number_b.has_value();
  });
  return order;
}

}  // namespace

void name_types(const std::filesystem::path& file, const Column& types, const TypeHints& hints,
                const ReadOptions& options, ParticleSet& particles) {
  std::vector<std::uint16_t> species(types.words.size());
  std::string guesses;
  for (const std::size_t i : sorted_types(types.words)) {
    const std::string& type = types.words[i];
    std::string name = type;
    if (const auto given = given_name(type, hints, options)) {
      name = *given;
    } else if (const Element* element = element_of_mass(type, hints)) {
      name = element->symbol;
      guesses += fmt::format("{}{}={}", guesses.empty() ? "" : ",", printable(type), name);
    }
    species[i] = particles.species_index(name);
  }
  particles.species.resize(types.word_indices.size());
  std::transform(types.word_indices.begin(), types.word_indices.end(), particles.species.begin(),
                 [&](std::uint16_t index) { return species[index]; });
  if (!guesses.empty() && options.warnings != nullptr) {
    options.warnings->add(
        Error(file, fmt::format("types are named after their masses: {}", guesses)).what());
  }
}

}  // namespace motes
