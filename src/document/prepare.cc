// Puts the library's steps in their order.
#include "document/prepare.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <utility>
#include <vector>

#include "core/error.h"
#include "particles/bonds.h"
#include "render/resolve.h"
#include "scene/fill_in.h"

namespace motes {
namespace {

/// Says how many balls want the colour of their field but are in none.
void warn_of_want_of_fields(const ParticleSet& particles, const GatheredScene& gathered,
                            Warnings& warnings) {
  const GeometrySource& geometry = gathered.geometry;
  if (std::none_of(geometry.srgb.begin(), geometry.srgb.end(), &by_field)) return;
  std::vector<bool> has_field(particles.size());
  for (const FieldSource& source : gathered.sources) {
    for (const std::uint32_t i : source.index) has_field[i] = true;
  }
  std::size_t wanting = 0, without = 0;
  for (std::size_t k = 0; k < geometry.index.size(); ++k) {
    if (!by_field(geometry.srgb_of(k))) continue;
    ++wanting;
    without += has_field[geometry.index[k]] ? 0 : 1;
  }
  if (without == 0) return;
  warnings.add(fmt::format(
      "geometry: {} of {} particles that are coloured by their field are in none that is shown; "
      "they have the colours of their elements or species",
      without, wanting));
}

void warn_of_missing_bonds(const ParticleSet& particles, const GeometrySource& geometry,
                           Warnings& warnings) {
  if (geometry.bonds_among.empty() || !geometry.bonds.empty()) return;
  const BondRule rule(particles.species_names);
  const auto& elements = rule.elements();
  if (std::count(elements.begin(), elements.end(), BondRule::no_element) == std::ssize(elements)) {
    warnings.add(
        "sticks: there are no bonds to draw, for none of the species is a chemical element; what "
        "numbered types are is for --types or data.types to say");
  } else if (particles.size() > 1 && rule.longest() > 0) {
    warnings.add(fmt::format(
        "sticks: there are no bonds to draw: none by distance, which are as long as covalent radii "
        "in angstrom tell; the data's unit of length: {}",
        particles.length_unit.empty() ? "unknown" : printable(particles.length_unit)));
  }
}

void warn_of_holes(const GridField& field, const FieldSource& source, Warnings& warnings) {
  const std::size_t holes = field.sampler->num_not_finite(), all = source.grid->size();
  if (holes == 0) return;
  warnings.add(
      holes == all
          ? fmt::format("the grid '{}' has no finite value", printable(source.name))
          : fmt::format("{} of {} samples of the grid '{}' are not finite: they count as 0", holes,
                        all, printable(source.name)));
}

/// Names the grids that are hidden though the scene does not say so.
void tell_of_hidden_grids(const std::vector<Field>& wanted, const std::vector<Field>& fields,
                          Warnings& warnings) {
  for (const Field& field : fields) {
    const auto says_so = [&field](const Field& of_scene) {
      return of_scene.grid && of_scene.grid->path == field.grid->path &&
             (of_scene.grid->array == field.grid->array || !of_scene.visible);
    };
    if (field.visible || !field.grid) continue;
    if (std::any_of(wanted.begin(), wanted.end(), says_so)) continue;
    warnings.add(
        fmt::format("the grid '{0}' is not shown: of several of both signs only the first is; a "
                    "scene that asks for it (\"array\": \"{0}\") shows it",
                    printable(field.grid->array)));
  }
}

}  // namespace

GatheredScene gather_scene(const Scene& scene, const std::vector<Field>& fields,
                           const ParticleSet& particles, const std::vector<LoadedGrid>& grids,
                           Progress* progress, Warnings& warnings) {
  GatheredScene gathered;
  gathered.sources = make_field_sources(particles, visible_fields(fields), scene.kernel, warnings,
                                        progress, grids);
  gathered.geometry = make_geometry_source(particles, scene.geometry, warnings, progress);
  warn_of_want_of_fields(particles, gathered, warnings);
  return gathered;
}

void warn_of_what_is_missing(const ParticleSet& particles, const std::vector<FieldSource>& sources,
                             const GeometrySource& geometry, const Renderer& renderer,
                             Warnings& warnings) {
  warn_of_missing_bonds(particles, geometry, warnings);
  for (const GridField& field : renderer.grids()) {
    warn_of_holes(field, sources[field.field], warnings);
  }
}

DataExtent data_extent(const ParticleSet& particles, const Renderer& renderer,
                       const std::vector<FieldSource>& sources) {
  DataExtent extent{particles.bounds(), particles.length_unit};
  for (const GridField& grid : renderer.grids()) {
    extent.bounds.add(grid.sampler->bounds());
    if (particles.size() == 0) extent.length_unit = sources[grid.field].grid->length_unit;
  }
  return extent;
}

PreparedScene prepare_scene(Scene scene, const ParticleSet& particles,
                            const std::vector<LoadedGrid>& grids, Progress* progress,
                            Warnings& warnings) {
  color_by_species(scene, particles);
  const auto fields = expand_fields(scene, particles, grids);
  tell_of_hidden_grids(scene.fields, fields, warnings);
  auto [sources, geometry] = gather_scene(scene, fields, particles, grids, progress, warnings);
  if (progress != nullptr) progress->update("building the tree", 0);
  Renderer renderer(particles, sources, geometry);
  warn_of_what_is_missing(particles, sources, geometry, renderer, warnings);
  ResolvedScene resolved = resolve(scene, particles, visible_fields(fields), sources, geometry,
                                   renderer.kernels(), progress, renderer.grids());
  renderer.prepare(resolved.render.engine);
  Scene filled_in = fill_in(scene, fields, sources, resolved);
  fill_in_colors(particles, filled_in.geometry);
  DataExtent extent = data_extent(particles, renderer, sources);
  return {std::move(renderer), std::move(resolved), std::move(filled_in), std::move(extent)};
}

}  // namespace motes
