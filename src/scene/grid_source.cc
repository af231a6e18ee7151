#include "scene/grid_source.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>

#include "core/error.h"

namespace motes {

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
  for (const std::string& name : names) {
    Field one = field;
    one.grid->array = name;
    if (field.name.empty()) {
      one.name = name;
    } else if (names.size() > 1) {
      one.name = field.name + "_" + name;
    }
    out.push_back(std::move(one));
  }
}

FieldSource grid_source(const Field& field, const std::vector<LoadedGrid>& grids) {
  const auto it = std::find_if(grids.begin(), grids.end(), [&](const LoadedGrid& loaded) {
    return loaded.path == field.grid->path && loaded.grid->name == field.grid->array;
  });
  assert(it != grids.end());
  FieldSource source;
  source.name = field.name;
  source.grid = it->grid;
  source.interpolation = field.grid->interpolation;
  return source;
}

}  // namespace motes
