#include "scene/grid_source.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/vec.h"
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
  Signs signs = signs_of(grid.values);
  double level = enclosing_level(grid.values, signs);
  if (signs == Signs::both) {
    const auto reaches = [&](double wanted) {
      return std::any_of(grid.values.begin(), grid.values.end(), [wanted](float value) {
        return std::isfinite(value) && (wanted > 0 ? value >= wanted : value <= wanted);
      });
    };
    const bool up = reaches(level), down = reaches(-level);
    if (up && down) return {{level, colors.positive, 1}, {-level, colors.negative, 1}};
    // One of them is shallow everywhere, as where the other's spin dominates.
    signs = up ? Signs::positive : Signs::negative;
    level = enclosing_level(grid.values, signs);
  }
  // All of one value, it ends where the grid does.
  const double sign = signs == Signs::positive ? 1 : -1;
  if (std::none_of(grid.values.begin(), grid.values.end(),
                   [&](float value) { return sign * static_cast<double>(value) > level; })) {
    level *= 0.5;
  }
  return {{signs == Signs::positive ? level : -level, colors.own, 1}};
}

// A fitted surface that holds so much of another's body is translucent.
constexpr double hidden_share = 0.9;
constexpr double translucent = 0.35;

/// The number of the sample next to p along each axis, or nullopt where the grid is not there.
std::optional<std::size_t> sample_at(const Grid& grid, const Point3d& p) {
  const auto& [a, b, c] = grid.steps;
  const Vector3d v = p - grid.origin;
  const double volume = dot(a, cross(b, c));
  const double place[3] = {dot(v, cross(b, c)) / volume, dot(v, cross(c, a)) / volume,
                           dot(v, cross(a, b)) / volume};
  std::size_t index[3];
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto n = static_cast<double>(grid.dims[axis]);
    double i = std::round(place[axis]);
    if (grid.periodic) i -= n * std::floor(i / n);
    if (!(i >= 0 && i < n)) return std::nullopt;
    index[axis] = static_cast<std::size_t>(i);
  }
  return grid.index(index[0], index[1], index[2]);
}

/// What the fitted isosurfaces of a field enclose.
struct Body {
  Field* field = nullptr;
  const Grid* grid = nullptr;
  std::vector<Point3d> points;  ///< of some samples, evenly many of the grid's
  double volume = 0;

  Body(Field& of, const Grid& its) : field(&of), grid(&its) {
    constexpr std::size_t looked_at = 1 << 16;
    // (odd, so that not only samples of some columns are looked at)
    const std::size_t stride = (1 + grid->size() / looked_at) | 1;
    for (std::size_t n = 0; n < grid->size(); n += stride) {
      if (!encloses(n)) continue;
      const std::size_t row = n / grid->dims[0], layer = row / grid->dims[1];
      points.push_back(grid->position(static_cast<double>(n % grid->dims[0]),
                                      static_cast<double>(row % grid->dims[1]),
                                      static_cast<double>(layer)));
    }
    const auto& [a, b, c] = grid->steps;
    volume = static_cast<double>(points.size() * stride) * std::abs(dot(a, cross(b, c)));
  }

  bool encloses(std::size_t sample) const {
    const double value = grid->values[sample];
    return std::any_of(
        field->isosurfaces.begin(), field->isosurfaces.end(), [&](const Isosurface& isosurface) {
          return isosurface.value > 0 ? value >= isosurface.value : value <= isosurface.value;
        });
  }

  /// Whether most of `other`, which is smaller, lies within.
  bool hides(const Body& other) const {
    if (!(volume > other.volume)) return false;
    const auto within =
        std::count_if(other.points.begin(), other.points.end(), [&](const Point3d& p) {
          const std::optional<std::size_t> sample = sample_at(*grid, p);
          return sample && encloses(*sample);
        });
    return static_cast<double>(within) >= hidden_share * static_cast<double>(other.points.size()) &&
           within > 0;
  }
};

}  // namespace

void finish_fitted(std::vector<Field>& fields, const std::vector<LoadedGrid>& grids) {
  std::vector<Body> bodies;
  for (Field& field : fields) {
    if (!field.fitted_isosurfaces) continue;
    field.fitted_isosurfaces = false;
    if (field.visible) bodies.emplace_back(field, *find_grid(*field.grid, grids));
  }
  for (const Body& body : bodies) {
    if (std::none_of(bodies.begin(), bodies.end(),
                     [&](const Body& other) { return body.hides(other); })) {
      continue;
    }
    for (Isosurface& isosurface : body.field->isosurfaces) isosurface.opacity = translucent;
  }
}

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
  bool signed_shown = false;
  for (const std::string& name : names) {
    Field one = field;
    one.grid->array = name;
    if (names.size() > 1 && signs_of(find_grid(*one.grid, grids)->values) == Signs::both) {
      one.visible = field.visible && !signed_shown;
      signed_shown = true;
    }
    if (field.fitted_isosurfaces) {
      one.isosurfaces = fit_isosurfaces(*find_grid(*one.grid, grids), colors_of_grid(number));
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
