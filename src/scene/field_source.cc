// From a field of the scene to the particles, radii and weights that its kernels need.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
#include <set>

#include "core/error.h"
#include "particles/elements.h"
#include "particles/radii.h"
#include "particles/selection.h"
#include "scene/element_radii.h"
#include "scene/grid_source.h"
#include "scene/scene.h"

namespace motes {
namespace {

/// Keeps the indices of `index` for which `holds`.
template <class Predicate>
void keep_if(std::vector<std::uint32_t>& index, Predicate&& holds) {
  index.erase(
      std::remove_if(index.begin(), index.end(), [&](std::uint32_t i) { return !holds(i); }),
      index.end());
}

bool is_number(const std::string& name) {
  return !name.empty() && name.find_first_not_of("0123456789") == std::string::npos;
}

Error unknown_species(const std::string& name, const std::vector<std::string>& known) {
  Error error = unknown_name("species", name, known);
  if (is_number(name) || known.empty() || !std::all_of(known.begin(), known.end(), is_number)) {
    return error;
  }
  return Error(fmt::format("{}; numeric types get names by \"types\" in \"data\" or --types {}={}",
                           error.what(), known.front(), printable(name)));
}

/// Which of the species are among `names`. Throws Error for unknown ones.
std::vector<bool> find_species(const ParticleSet& particles,
                               const std::vector<std::string>& names) {
  if (particles.species.empty()) {
    throw Error(
        fmt::format("the particles have no species, so none is '{}'", printable(names.front())));
  }
  std::vector<bool> wanted(particles.species_names.size());
  for (const std::string& name : names) {
    const auto& known = particles.species_names;
    const auto it = std::find(known.begin(), known.end(), name);
    if (it == known.end()) throw unknown_species(name, known);
    wanted[static_cast<std::size_t>(it - known.begin())] = true;
  }
  return wanted;
}

std::vector<std::string> property_names(const ParticleSet& particles) {
  std::vector<std::string> names;
  for (const Property& property : particles.properties) names.push_back(property.name);
  return names;
}

/// Values of all particles, one a particle or one for all. `key` is the field's, for messages.
std::vector<float> values_of(const ParticleSet& particles, const NumberOrProperty& source,
                             std::string_view key) {
  if (const double* number = std::get_if<double>(&source)) return {static_cast<float>(*number)};
  try {
    return property_named(particles, std::get<std::string>(source)).values;
  } catch (const Error& error) {
    throw Error(fmt::format("{}: {}", key, error.what()));
  }
}

/// The table of elements that a field's radius names, unless that is the name of a property.
std::optional<ElementRadius> radius_table(const ParticleSet& particles,
                                          const NumberOrProperty& radius) {
  const auto* name = std::get_if<std::string>(&radius);
  if (name == nullptr || particles.find_property(*name) != nullptr) return std::nullopt;
  return element_radius_from_name(*name);
}

/// The radii that a field gives, one a particle or one for all; those of particles that are not in
/// `index` may be NaN.
std::vector<float> own_radii(const ParticleSet& particles, const NumberOrProperty& radius,
                             const std::vector<std::uint32_t>& index, Warnings& warnings,
                             Progress* progress) {
  const auto table = radius_table(particles, radius);
  if (!table) return values_of(particles, radius, "radius");
  std::vector<bool> wanted(particles.size());
  for (const std::uint32_t i : index) wanted[i] = true;
  return radii_by_element(particles, *table, wanted, warnings, progress);
}

/// Leaves out the particles that have no place or no kernel, with a warning for each reason.
class Filter {
 public:
  Filter(const Field& field, std::vector<std::uint32_t>& index, Warnings& warnings)
      : field_(field), index_(index), selected_(index.size()), warnings_(warnings) {}

  template <class Predicate>
  void require(Predicate&& holds, std::string_view reason) {
    const std::size_t before = index_.size();
    keep_if(index_, holds);
    const std::size_t lost = before - index_.size();
    if (lost == 0) return;
    warnings_.add(fmt::format("field '{}': {} of {} particles left out: {}", printable(field_.name),
                              lost, selected_, reason));
  }

 private:
  const Field& field_;
  std::vector<std::uint32_t>& index_;
  const std::size_t selected_;
  Warnings& warnings_;
};

/// `values` of the particles in `index`; a single value stays single.
std::vector<float> gather(const std::vector<float>& values,
                          const std::vector<std::uint32_t>& index) {
  if (values.size() == 1) return values;
  std::vector<float> gathered(index.size());
  std::transform(index.begin(), index.end(), gathered.begin(),
                 [&values](std::uint32_t i) { return values[i]; });
  return gathered;
}

/// More colours are hard to tell apart, and each field costs time.
constexpr std::size_t max_colored_species = 8;

Color species_color(const ParticleSet& particles, const std::vector<std::uint32_t>& index) {
  if (particles.species.empty()) return {1, 1, 1};
  std::vector<std::size_t> count(particles.species_names.size());
  for (const std::uint32_t i : index) ++count[particles.species[i]];
  const auto most =
      static_cast<std::size_t>(std::max_element(count.begin(), count.end()) - count.begin());
  if (const Element* element = find_element(particles.species_names[most])) {
    const auto& c = element->color;
    return color_from_srgb(std::uint32_t{c[0]} << 16 | std::uint32_t{c[1]} << 8 | c[2]);
  }
  return color_from_srgb(other_species_color(most));
}

}  // namespace

const Property& property_named(const ParticleSet& particles, const std::string& name,
                               const std::vector<std::string>& others) {
  const Property* property = particles.find_property(name);
  if (property == nullptr) {
    std::vector<std::string> names = property_names(particles);
    names.insert(names.end(), others.begin(), others.end());
    throw unknown_name("property", name, names);
  }
  return *property;
}

std::vector<std::uint32_t> select_particles(const ParticleSet& particles, const Selection& select) {
  std::vector<std::uint32_t> index;
  if (select.expression.empty()) {
    index.resize(particles.size());
    std::iota(index.begin(), index.end(), std::uint32_t{0});
  } else {
    index = select_where(particles, select.expression);
  }
  if (select.index) {
    const auto [first, last] = *select.index;
    keep_if(index,
            [first = first, last = last](std::uint32_t i) { return i >= first && i <= last; });
  }
  if (!select.species.empty()) {
    const std::vector<bool> wanted = find_species(particles, select.species);
    keep_if(index, [&](std::uint32_t i) { return wanted[particles.species[i]]; });
  }
  return index;
}

namespace {

/// "; unknown species ..." for the first text of the expression that is none, or "".
std::string unknown_species_in(const Selection& select, const ParticleSet& particles) {
  if (select.expression.empty()) return "";
  const auto& known = particles.species_names;
  for (const std::string& text : texts_of(select.expression)) {
    if (std::find(known.begin(), known.end(), text) != known.end()) continue;
    return std::string("; ") + unknown_species(text, known).what();
  }
  return "";
}

/// A field's particles, not yet checked; radii and weights are left open.
FieldSource select_source(const ParticleSet& particles, const Field& field, const Kernel& kernel) {
  FieldSource source;
  source.name = field.name;
  source.kernel = kernel_of(field, kernel);
  source.index = select_particles(particles, field.select);
  if (source.index.empty()) {
    throw Error(fmt::format("field '{}' selects none of the {} particles{}", printable(field.name),
                            particles.size(), unknown_species_in(field.select, particles)));
  }
  return source;
}

/// The default radii, once for all the fields that give none, for their particles alone; empty
/// where every field gives its own.
std::vector<float> shared_default_radii(const ParticleSet& particles,
                                        const std::vector<Field>& fields,
                                        const std::vector<FieldSource>& sources, Warnings& warnings,
                                        Progress* progress) {
  std::vector<bool> wanted;
  for (std::size_t f = 0; f < fields.size(); ++f) {
    if (fields[f].radius || fields[f].grid) continue;
    wanted.resize(particles.size());
    for (const std::uint32_t i : sources[f].index) wanted[i] = true;
  }
  if (wanted.empty()) return {};
  return default_radii(particles, warnings, wanted, progress).radius;
}

/// Turns default radii, which are standard deviations, into those of the source's kernel. A table's
/// distances are lengths by themselves.
void take_as_widths(FieldSource& source) {
  if (source.kernel.shape.type == KernelType::tabulated) {
    source.radius = {1};
    return;
  }
  const auto factor = static_cast<float>(1 / source.kernel.standard_deviation());
  for (float& radius : source.radius) radius *= factor;
}

/// Adds radii and weights to a selected source, and leaves out the particles without a kernel.
void complete_source(const ParticleSet& particles, const Field& field,
                     const std::vector<float>& default_radius, FieldSource& source,
                     Warnings& warnings, Progress* progress) {
  // Particles with sizes of their own stand for a density: of mass, or else of number.
  const bool density = !field.radius && !field.weight && has_sizes(particles);
  const bool of_mass = density && particles.find_property("mass");
  const std::vector<float> own_radius =
      field.radius ? own_radii(particles, *field.radius, source.index, warnings, progress)
                   : std::vector<float>();
  const std::vector<float>& radius = field.radius ? own_radius : default_radius;
  const NumberOrProperty unit = of_mass ? NumberOrProperty("mass") : NumberOrProperty(1.0);
  const std::vector<float> weight = values_of(particles, field.weight.value_or(unit), "weight");
  source.normalise = field.normalise.value_or(density);
  if (source.normalise && !(source.kernel.integral() > 0)) {
    throw Error(fmt::format(
        "field '{}': its table integrates to {:g} and cannot be normalised; expected more than 0",
        printable(field.name), source.kernel.integral()));
  }

  Filter filter(field, source.index, warnings);
  filter.require(
      [&](std::uint32_t i) {
        return std::isfinite(particles.x[i]) && std::isfinite(particles.y[i]) &&
               std::isfinite(particles.z[i]);
      },
      "their positions are not finite");
  filter.require(
      [&](std::uint32_t i) {
        const float r = radius[radius.size() == 1 ? 0 : i];
        return std::isfinite(r) && r > 0;
      },
      "their radii are not finite numbers greater than 0");
  filter.require([&](std::uint32_t i) { return std::isfinite(weight[weight.size() == 1 ? 0 : i]); },
                 "their weights are not finite");
  if (source.index.empty()) {
    throw Error(
        fmt::format("field '{}': none of its particles has a finite position and weight "
                    "and a radius greater than 0",
                    printable(field.name)));
  }

  source.radius = gather(radius, source.index);
  if (!field.radius) take_as_widths(source);
  source.weight = gather(weight, source.index);
  source.colors.own = species_color(particles, source.index);
  source.colored_by_species = std::any_of(
      field.isosurfaces.begin(), field.isosurfaces.end(), [](const Isosurface& isosurface) {
        return isosurface.color && std::holds_alternative<ColorBy>(*isosurface.color);
      });
}

}  // namespace

std::vector<FieldSource> make_field_sources(const ParticleSet& particles,
                                            const std::vector<Field>& fields, const Kernel& kernel,
                                            Warnings& warnings, Progress* progress,
                                            const std::vector<LoadedGrid>& grids) {
  const auto is_of_particles = [](const Field& field) { return !field.grid; };
  if (particles.size() == 0 && std::any_of(fields.begin(), fields.end(), is_of_particles)) {
    throw Error("the file has no particles to render");
  }
  std::vector<FieldSource> sources;
  sources.reserve(fields.size());
  for (const Field& field : fields) {
    sources.push_back(field.grid ? grid_source(field, grids)
                                 : select_source(particles, field, kernel));
  }
  const std::vector<float> default_radius =
      shared_default_radii(particles, fields, sources, warnings, progress);
  for (std::size_t f = 0; f < fields.size(); ++f) {
    if (fields[f].grid) continue;
    complete_source(particles, fields[f], default_radius, sources[f], warnings, progress);
  }
  color_grids(sources);
  return sources;
}

Kernel kernel_of(const Field& field, const Kernel& kernel) {
  return {field.support_factor.value_or(kernel.support_factor),
          field.kernel_scale.value_or(kernel.kernel_scale),
          field.kernel_shape.value_or(kernel.shape)};
}

std::vector<Field> visible_fields(const std::vector<Field>& fields) {
  std::vector<Field> visible;
  std::copy_if(fields.begin(), fields.end(), std::back_inserter(visible),
               [](const Field& field) { return field.visible; });
  return visible;
}

void color_by_species(Scene& scene, const ParticleSet& particles) {
  if (has_sizes(particles) || (scene.fields.empty() && !scene.geometry.empty())) return;
  std::vector<bool> present(particles.species_names.size());
  for (const std::uint16_t s : particles.species) present[s] = true;
  std::set<const Element*> elements;  // several species may be of one: C, C1, C2
  for (std::size_t s = 0; s < present.size(); ++s) {
    if (!present[s]) continue;
    const Element* element = find_element(particles.species_names[s]);
    if (element == nullptr) return;
    elements.insert(element);
  }
  if (elements.size() < 2 || elements.size() > max_colored_species) return;
  if (scene.fields.empty()) scene.fields.emplace_back().name = "all";
  Field& field = scene.fields.front();
  const bool open = field.transfer_function.index() == 0 && field.isosurfaces.empty() &&
                    field.select == Selection{} && !field.grid;
  if (scene.fields.size() > 1 || !open) return;
  field.transfer_function = NamedTransferFunction{std::string(species_colors), {}, {}, {}};
}

namespace {

/// Throws Error "fields[1].radius: what" for names of species and properties, also in expressions,
/// that the particles do not have.
void check_names(const std::vector<Field>& fields, const ParticleSet& particles) {
  std::string key;
  try {
    for (std::size_t k = 0; k < fields.size(); ++k) {
      const Field& field = fields[k];
      key = fmt::format("fields[{}].select.species", k);
      if (!field.select.species.empty()) find_species(particles, field.select.species);
      key = fmt::format("fields[{}].select.expression", k);
      if (!field.select.expression.empty()) check_expression(field.select.expression, particles);
      for (const auto& [name, value] :
           {std::pair{"radius", &field.radius}, std::pair{"weight", &field.weight}}) {
        key = fmt::format("fields[{}].{}", k, name);
        const auto* property = *value ? std::get_if<std::string>(&**value) : nullptr;
        const bool of_table = value == &field.radius && *value && radius_table(particles, **value);
        if (property == nullptr || of_table) continue;
        property_named(
            particles, *property,
            value == &field.radius ? element_radius_names() : std::vector<std::string>());
      }
    }
  } catch (const Error& error) {
    throw Error(fmt::format("{}: {}", key, error.what()));
  }
}

/// A name that Motes gave may be one that the scene gives to another field: then it gets a number,
/// for columns and messages go by the name.
void number_repeated_names(std::vector<Field>& fields) {
  std::set<std::string> taken;
  for (Field& field : fields) {
    const std::string name = field.name;
    for (int n = 2; !taken.insert(field.name).second; ++n)
      field.name = fmt::format("{}_{}", name, n);
  }
}

}  // namespace

std::vector<Field> expand_fields(const Scene& scene, const ParticleSet& particles,
                                 const std::vector<LoadedGrid>& grids) {
  check_names(scene.fields, particles);
  std::vector<Field> wanted = scene.fields;
  if (wanted.empty()) {
    if (!scene.geometry.empty()) return {};
    wanted.emplace_back().name = "all";
  }
  std::vector<Field> fields;
  for (std::size_t k = 0; k < wanted.size(); ++k) {
    Field& field = wanted[k];
    if (field.grid) {
      expand_grid_field(field, k, grids, fields);
      continue;
    }
    if (field.name.empty()) field.name = fmt::format("field{}", k);
    const auto* named = std::get_if<NamedTransferFunction>(&field.transfer_function);
    if (named == nullptr || named->name != species_colors || particles.species.empty()) {
      fields.push_back(std::move(field));
      continue;
    }
    // One field a species, in the order of the file's species.
    std::vector<bool> present(particles.species_names.size());
    for (const std::uint32_t i : select_particles(particles, field.select)) {
      present[particles.species[i]] = true;
    }
    const auto num_present = std::count(present.begin(), present.end(), true);
    for (std::size_t s = 0; s < present.size(); ++s) {
      if (!present[s]) continue;
      Field one = field;
      one.select.species = {particles.species_names[s]};
      if (num_present > 1) {
        one.name = (wanted.size() == 1 ? "" : field.name + "_") + particles.species_names[s];
      }
      fields.push_back(std::move(one));
    }
    if (num_present == 0) fields.push_back(std::move(field));
  }
  finish_fitted(fields, grids);
  if (fields.size() > max_fields) {
    throw Error(fmt::format("{} fields; expected at most {}", fields.size(), max_fields));
  }
  number_repeated_names(fields);
  return fields;
}

}  // namespace motes
