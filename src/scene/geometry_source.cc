// From what a scene draws to balls and bonds.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <string_view>
#include <utility>

#include "core/error.h"
#include "particles/bonds.h"
#include "particles/elements.h"
#include "scene/element_radii.h"
#include "scene/geometry.h"
#include "scene/transfer_function.h"

namespace motes {
namespace {

std::uint32_t element_color(const Element& element) {
  const auto& c = element.color;
  return std::uint32_t{c[0]} << 16 | std::uint32_t{c[1]} << 8 | c[2];
}

/// Whether each of `count` particles is in `index`.
std::vector<bool> flags_of(const std::vector<std::uint32_t>& index, std::size_t count) {
  std::vector<bool> flags(count);
  for (const std::uint32_t i : index) flags[i] = true;
  return flags;
}

/// Radii of the particles in `index`.
std::vector<float> radii_of(const ParticleSet& particles, const Geometry& item,
                            const std::vector<std::uint32_t>& index, Warnings& warnings,
                            Progress* progress) {
  std::vector<float> radii(index.size());
  if (const double* number = std::get_if<double>(&item.radius)) {
    std::fill(radii.begin(), radii.end(), static_cast<float>(*number));
  } else if (const auto* name = std::get_if<std::string>(&item.radius)) {
    const Property& property = property_named(particles, *name, element_radius_names());
    std::transform(index.begin(), index.end(), radii.begin(),
                   [&](std::uint32_t i) { return property.values[i]; });
  } else {
    const auto by_element = radii_by_element(particles, std::get<ElementRadius>(item.radius),
                                             flags_of(index, particles.size()), warnings, progress);
    std::transform(index.begin(), index.end(), radii.begin(),
                   [&](std::uint32_t i) { return by_element[by_element.size() == 1 ? 0 : i]; });
  }
  for (float& radius : radii) radius *= static_cast<float>(item.scale);
  return radii;
}

/// All particles' values of what a colour goes by: a property, or a coordinate unless a property
/// has its name; coordinates are in `storage`.
const std::vector<float>& color_values(const ParticleSet& particles, const std::string& name,
                                       std::vector<float>& storage) {
  static const std::vector<std::string> coordinates{"x", "y", "z"};
  const auto at = std::find(coordinates.begin(), coordinates.end(), name);
  if (particles.find_property(name) != nullptr || at == coordinates.end()) {
    return property_named(particles, name, coordinates).values;
  }
  const auto axis = static_cast<int>(at - coordinates.begin());
  storage.resize(particles.size());
  for (std::size_t i = 0; i < storage.size(); ++i) {
    storage[i] = static_cast<float>(particles.position(i)[axis]);
  }
  return storage;
}

/// Of those of the particles in `index` that are finite.
std::pair<double, double> range_of(const std::vector<float>& values,
                                   const std::vector<std::uint32_t>& index) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const std::uint32_t i : index) {
    if (!std::isfinite(values[i])) continue;
    low = std::min(low, static_cast<double>(values[i]));
    high = std::max(high, static_cast<double>(values[i]));
  }
  return {low, high};
}

std::vector<std::uint32_t> colors_by_property(const ParticleSet& particles,
                                              const ColorByProperty& color,
                                              const std::vector<std::uint32_t>& index) {
  std::vector<float> storage;
  const std::vector<float>& values = color_values(particles, color.property, storage);
  const auto [low, high] = color.range.value_or(range_of(values, index));
  constexpr std::size_t steps = 256;
  std::vector<std::uint32_t> table(steps);
  const TransferFunction map = named_transfer_function(color.map, 0, 1, 1);
  for (std::size_t i = 0; i < steps; ++i) {
    const double place = static_cast<double>(i) / (steps - 1);
    table[i] = color_to_srgb(color_at(map, place));
  }
  std::vector<std::uint32_t> colors;
  colors.reserve(index.size());
  constexpr std::uint32_t none = 0x808080;  // of values that are no numbers
  for (const std::uint32_t i : index) {
    const double place = high > low ? (values[i] - low) / (high - low) : 0.5;
    colors.push_back(std::isnan(place) ? none
                                       : table[static_cast<std::size_t>(std::lround(
                                             std::clamp(place, 0.0, 1.0) * (steps - 1)))]);
  }
  return colors;
}

/// Colours of the particles in `index`.
std::vector<std::uint32_t> colors_of(const ParticleSet& particles, const Geometry& item,
                                     const std::vector<std::uint32_t>& index) {
  if (const auto* property = std::get_if<ColorByProperty>(&item.color)) {
    return colors_by_property(particles, *property, index);
  }
  if (const Color* color = std::get_if<Color>(&item.color)) {
    return std::vector<std::uint32_t>(index.size(), color_to_srgb(*color));
  }
  const auto of_species = colors_of_species(particles, std::get<ColorBy>(item.color));
  const bool of_field = std::get<ColorBy>(item.color) == ColorBy::field;
  std::vector<std::uint32_t> colors(index.size(), 0xcccccc);
  if (!particles.species.empty()) {
    std::transform(index.begin(), index.end(), colors.begin(),
                   [&](std::uint32_t i) { return of_species[particles.species[i]]; });
  }
  for (std::uint32_t& color : colors) color |= of_field ? for_want_of_field : 0;
  return colors;
}

/// Takes the bonds of a sticks' item from the file, or leaves them to be found by distance.
void take_bonds(const ParticleSet& particles, BondSource from,
                const std::vector<std::uint32_t>& index, GeometrySource& source,
                Warnings& warnings) {
  if (from == BondSource::file && particles.bonds.empty()) {
    throw Error("the file has none; expected \"distance\", or a file with bonds");
  }
  std::vector<bool> selected = flags_of(index, particles.size());
  const bool by_distance = from == BondSource::distance || particles.bonds.empty();
  const bool both = from == BondSource::automatic && particles.bonds_are_partial;
  if (by_distance || both) source.bonds_among = selected;
  if (by_distance) return;
  const std::vector<Bond> bonds = file_bonds(particles, warnings);
  std::copy_if(bonds.begin(), bonds.end(), std::back_inserter(source.bonds),
               [&](const Bond& bond) { return selected[bond.first] && selected[bond.second]; });
  if (source.bonds.empty() && !both) {
    warnings.add(
        fmt::format("sticks: none of the {} bonds is between two particles that are both selected",
                    bonds.size()));
  }
}

/// What is drawn of each particle, while the items are gone through.
struct Drawn {
  std::vector<bool> any;
  std::vector<float> radius;
  std::vector<std::uint32_t> srgb;

  explicit Drawn(std::size_t n) : any(n), radius(n), srgb(n) {}
};

/// What `get` gives; what it throws is of that key.
template <class Get>
auto with_key(std::string_view key, Get&& get) {
  try {
    return get();
  } catch (const Error& error) {
    throw Error(fmt::format("{}: {}", key, error.what()));
  }
}

/// The values of the particles in `index`, or one where they are all the same: memory for millions
/// of balls. Precondition: there are any.
template <class T>
std::vector<T> gather_or_share(const std::vector<T>& values,
                               const std::vector<std::uint32_t>& index) {
  const T first = values[index.front()];
  const bool same =
      std::all_of(index.begin(), index.end(), [&](std::uint32_t i) { return values[i] == first; });
  std::vector<T> gathered(same ? 1 : index.size(), first);
  if (same) return gathered;
  std::transform(index.begin(), index.end(), gathered.begin(),
                 [&](std::uint32_t i) { return values[i]; });
  return gathered;
}

void add_item(const ParticleSet& particles, const Geometry& item, Drawn& drawn,
              GeometrySource& source, Warnings& warnings, Progress* progress) {
  const auto index = with_key("select", [&] { return select_particles(particles, item.select); });
  if (index.empty()) throw Error("select: takes none of the particles");
  const auto colors = with_key("color", [&] { return colors_of(particles, item, index); });
  std::vector<float> radii;
  if (item.type == Geometry::Type::spheres) {
    radii =
        with_key("radius", [&] { return radii_of(particles, item, index, warnings, progress); });
  } else {
    source.stick_radius = static_cast<float>(std::get<double>(item.radius));
    radii.assign(index.size(), source.stick_radius);
    with_key("bonds", [&] { take_bonds(particles, item.bonds, index, source, warnings); });
  }
  std::size_t bad = 0;
  for (std::size_t k = 0; k < index.size(); ++k) {
    const std::uint32_t i = index[k];
    const bool finite = std::isfinite(particles.x[i]) && std::isfinite(particles.y[i]) &&
                        std::isfinite(particles.z[i]) && std::isfinite(radii[k]);
    if (!finite) {
      ++bad;
      continue;
    }
    const bool joint = item.type == Geometry::Type::sticks;
    if (joint && drawn.any[i]) {
      drawn.radius[i] = std::max(drawn.radius[i], radii[k]);
      continue;
    }
    drawn.radius[i] = drawn.any[i] ? std::max(radii[k], source.stick_radius) : radii[k];
    drawn.any[i] = true;
    drawn.srgb[i] = colors[k];
  }
  if (bad != 0) {
    warnings.add(
        fmt::format("{} of {} particles are not drawn: their positions or radii are not "
                    "finite",
                    bad, index.size()));
  }
}

}  // namespace

std::uint32_t other_species_color(std::size_t species) {
  // Easily told apart, also by colour-blind people (Okabe and Ito 2008).
  constexpr std::uint32_t colors[] = {0xe69f00, 0x56b4e9, 0x009e73, 0xf0e442,
                                      0x0072b2, 0xd55e00, 0xcc79a7};
  return colors[species % std::size(colors)];
}

std::vector<std::uint32_t> colors_of_species(const ParticleSet& particles, ColorBy by) {
  std::vector<std::uint32_t> colors;
  for (std::size_t s = 0; s < particles.species_names.size(); ++s) {
    const Element* element = find_element(particles.species_names[s]);
    colors.push_back(by != ColorBy::species && element != nullptr ? element_color(*element)
                                                                  : other_species_color(s));
  }
  return colors;
}

GeometrySource make_geometry_source(const ParticleSet& particles,
                                    const std::vector<Geometry>& geometry, Warnings& warnings,
                                    Progress* progress) {
  GeometrySource source;
  if (geometry.empty()) return source;
  Drawn drawn(particles.size());
  for (std::size_t k = 0; k < geometry.size(); ++k) {
    try {
      add_item(particles, geometry[k], drawn, source, warnings, progress);
    } catch (const Error& error) {
      throw Error(fmt::format("geometry[{}].{}", k, error.what()));
    }
  }
  const auto count = static_cast<std::size_t>(std::count(drawn.any.begin(), drawn.any.end(), true));
  if (count == 0) throw Error("geometry: none of its particles has a finite position and radius");
  source.index.reserve(count);
  for (std::uint32_t i = 0; i < particles.size(); ++i) {
    if (drawn.any[i]) source.index.push_back(i);
  }
  source.radius = gather_or_share(drawn.radius, source.index);
  source.srgb = gather_or_share(drawn.srgb, source.index);
  return source;
}

void fill_in_colors(const ParticleSet& particles, std::vector<Geometry>& geometry) {
  for (Geometry& item : geometry) {
    auto* const color = std::get_if<ColorByProperty>(&item.color);
    if (color == nullptr || color->range) continue;
    std::vector<float> storage;
    const auto range = range_of(color_values(particles, color->property, storage),
                                select_particles(particles, item.select));
    if (range.first < range.second) color->range = range;
  }
}

}  // namespace motes
