// Types to names: what the user says, what the file says, what the masses say.
#include "io/type_names.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <optional>

#include "particles/elements.h"

namespace motes {

namespace {

std::optional<std::string> name_of_user(const std::string& type, const ReadOptions& options) {
  const auto number = to_integer(type);
  if (!number) return std::nullopt;
  for (const auto& [key, name] : options.types) {
    if (key == *number) return name;
  }
  return std::nullopt;
}

const std::string* label_of(const std::string& type, const TypeHints& hints) {
  const auto label = hints.labels.find(type);
  return label == hints.labels.end() ? nullptr : &label->second;
}

/// Whether the masses are those of elements: in reduced units they are mostly 1, but nowhere near
/// another element's.
bool in_atomic_units(const TypeHints& hints) {
  return std::any_of(hints.masses.begin(), hints.masses.end(), [](const auto& mass) {
    return mass.second != 1 && element_by_mass(mass.second) != nullptr;
  });
}

const Element* element_of_mass(const std::string& type, const TypeHints& hints) {
  const auto mass = hints.masses.find(type);
  if (mass == hints.masses.end() || !in_atomic_units(hints)) return nullptr;
  return element_by_mass(mass->second);
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

void warn_of_absent_types(const std::filesystem::path& file, const std::vector<std::string>& types,
                          const ReadOptions& options) {
  if (options.warnings == nullptr) return;
  std::string present;
  for (const std::size_t i : sorted_types(types)) {
    present += (present.empty() ? "" : ", ") + printable(types[i]);
  }
  for (const auto& [number, name] : options.types) {
    const bool found = std::any_of(types.begin(), types.end(), [n = number](const auto& type) {
      return to_integer(type) == n;
    });
    if (found) continue;
    options.warnings->add(
        Error(file,
              fmt::format("has no type {} to be named {}; there are: {}", number, printable(name),
                          present.empty() ? "none" : printable(present, 200)))
            .what());
  }
}

void name_types(const std::filesystem::path& file, const Column& types, const TypeHints& hints,
                const ReadOptions& options, ParticleSet& particles) {
  warn_of_absent_types(file, types.words, options);
  std::vector<std::uint16_t> species(types.words.size());
  std::string guesses;
  for (const std::size_t i : sorted_types(types.words)) {
    const std::string& type = types.words[i];
    std::string name = type;
    const std::string* label = label_of(type, hints);
    const Element* element = element_of_mass(type, hints);
    // (a carbon that the file calls CA must not become calcium)
    const bool agree = label != nullptr && (element == nullptr || find_element(*label) == element);
    if (const auto given = name_of_user(type, options)) {
      name = *given;
    } else if (agree) {
      name = *label;
    } else if (element != nullptr) {
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

void name_elements(const std::vector<std::int64_t>& numbers, ParticleSet& particles) {
  std::map<std::int64_t, std::uint16_t> indices;
  particles.species.reserve(numbers.size());
  for (const std::int64_t number : numbers) {
    auto it = indices.find(number);
    if (it == indices.end()) {
      const bool small = number > 0 && number < 1000;
      const Element* element = small ? element_by_number(static_cast<int>(number)) : nullptr;
      const std::uint16_t index = particles.species_index(
          element != nullptr ? std::string(element->symbol) : std::to_string(number));
      it = indices.emplace(number, index).first;
    }
    particles.species.push_back(it->second);
  }
}

}  // namespace motes
