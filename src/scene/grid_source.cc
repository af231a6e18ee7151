#include "scene/grid_source.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cstdint>
#include <iterator>
#include <memory>
#include <utility>

#include "core/error.h"
#include "scene/fit_levels.h"
#include "scene/geometry.h"
#include "scene/transfer_function.h"

namespace motes {
namespace {

std::shared_ptr<const Grid> find_grid(const FieldGrid& field,
                                      const std::vector<LoadedGrid>& grids) {
  const auto it = std::find_if(grids.begin(), grids.end(), [&](const LoadedGrid& loaded) {
    return loaded.path == field.path && loaded.grid->name == field.array;
  });
  assert(it != grids.end());
  return it->grid;
}

std::vector<Isosurface> fit_isosurfaces(const Grid& grid, const FieldColors& colors) {
  const Signs signs = signs_of(grid.values);
  const double level = enclosing_level(grid.values, signs);
  if (signs == Signs::both) return {{level, colors.positive, 1}, {-level, colors.negative, 1}};
  return {{signs == Signs::positive ? level : -level, colors.own, 1}};
}

}  // namespace

FieldColors colors_of_grid(std::size_t number) {
  // Of opposite hues in each pair.
  constexpr std::pair<std::uint32_t, std::uint32_t> pairs[] = {
      {0xe8702a, 0x2f6fe4}, {0x3fae49, 0xa24fd0}, {0xe3c12c, 0x1fa5b8}, {0xe0559c, 0x7d9a2c}};
  const auto [positive, negative] = pairs[number % std::size(pairs)];
  return {color_from_srgb(other_species_color(number + 1)), color_from_srgb(positive),
          color_from_srgb(negative)};
}

void color_grids(std::vector<FieldSource>& sources) {
  const auto is_grid = [](const FieldSource& source) { return source.grid != nullptr; };
  const bool several = std::count_if(sources.begin(), sources.end(), is_grid) > 1;
  std::size_t number = 0;
  for (FieldSource& source : sources) {
    if (!is_grid(source)) continue;
    source.colors = colors_of_grid(number++);
    source.colors.prefers_own = several;
  }
}

void expand_grid_field(const Field& field, std::size_t k, const std::vector<LoadedGrid>& grids,
                       std::vector<Field>& out) {
  const auto* named = std::get_if<NamedTransferFunction>(&field.transfer_function);
  if (named != nullptr && named->name == species_colors) {
    throw Error(fmt::format(
        "fields[{}].transfer_function: the field is a grid, which has no species; expected points "
        "or the name of a colour map",
        k));
  }
  std::vector<std::string> names;
  for (const LoadedGrid& loaded : grids) {
    if (loaded.path == field.grid->path) names.push_back(loaded.grid->name);
  }
  if (!field.grid->array.empty()) {
    if (std::find(names.begin(), names.end(), field.grid->array) == names.end()) {
      throw Error(fmt::format("fields[{}].grid.array: {}", k,
                              unknown_name("grid", field.grid->array, names).what()));
    }
    names = {field.grid->array};
  }
  auto number = static_cast<std::size_t>(
      std::count_if(out.begin(), out.end(), [](const Field& f) { return f.grid.has_value(); }));
  for (const std::string& name : names) {
    Field one = field;
    one.grid->array = name;
    if (field.fitted_isosurfaces) {
      one.isosurfaces = fit_isosurfaces(*find_grid(*one.grid, grids), colors_of_grid(number));
      one.fitted_isosurfaces = false;
    }
    ++number;
    if (field.name.empty()) {
      one.name = name;
    } else if (names.size() > 1) {
      one.name = field.name + "_" + name;
    }
    out.push_back(std::move(one));
  }
}

FieldSource grid_source(const Field& field, const std::vector<LoadedGrid>& grids) {
  FieldSource source;
  source.name = field.name;
  source.grid = find_grid(*field.grid, grids);
  source.interpolation = field.grid->interpolation;
  return source;
}

}  // namespace motes
