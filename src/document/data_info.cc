#include "document/data_info.h"

#include <algorithm>
#include <cmath>

#include "scene/geometry.h"

namespace motes {

std::vector<SpeciesInfo> species_info(const ParticleSet& particles) {
  std::vector<SpeciesInfo> all;
  if (particles.species.empty()) return all;
  const std::vector<std::uint32_t> colors = colors_of_species(particles, ColorBy::element);
  for (std::size_t s = 0; s < particles.species_names.size(); ++s) {
    all.push_back({particles.species_names[s], 0, colors[s]});
  }
  for (const std::uint16_t s : particles.species) ++all[s].count;
  std::erase_if(all, [](const SpeciesInfo& species) { return species.count == 0; });
  return all;
}

std::vector<PropertyInfo> property_info(const ParticleSet& particles) {
  std::vector<PropertyInfo> all;
  for (const Property& property : particles.properties) {
    PropertyInfo& info = all.emplace_back();
    info.name = property.name;
    for (const float value : property.values) {
      if (!std::isfinite(value)) continue;
      info.min = std::min(info.min.value_or(value), double{value});
      info.max = std::max(info.max.value_or(value), double{value});
    }
  }
  return all;
}

std::vector<FieldInfo> field_info(const std::vector<Field>& fields,
                                  const std::vector<FieldSource>& sources) {
  std::vector<FieldInfo> all;
  auto source = sources.begin();
  for (const Field& field : fields) {
    FieldInfo& info = all.emplace_back();
    info.name = field.name;
    if (!field.visible) continue;
    info.particles = source->index.size();
    const std::vector<float>& radius = source->radius;
    if (!radius.empty() &&
        std::all_of(radius.begin(), radius.end(), [&](float r) { return r == radius.front(); })) {
      info.radius = radius.front();
    }
    ++source;
  }
  return all;
}

}  // namespace motes
