#include "scene/fill_in.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cstdlib>
#include <string>

#include "scene/fit.h"

namespace motes {
namespace {

/// The double with the fewest digits that is `value` in single precision.
double shortest(float value) { return std::strtod(fmt::format("{}", value).c_str(), nullptr); }

/// The one value that all of `values` are.
std::optional<NumberOrProperty> plain_number(const std::vector<float>& values) {
  const bool equal = std::all_of(values.begin(), values.end(),
                                 [&values](float value) { return value == values.front(); });
  return equal ? std::optional(NumberOrProperty(shortest(values.front()))) : std::nullopt;
}

/// By its name, range and extinction where a colour map comes to the same (its extinction rises
/// linearly): more easily changed than dozens of points.
decltype(Field::transfer_function) written_form(const decltype(Field::transfer_function)& wish,
                                                const TransferFunction& function) {
  if (std::holds_alternative<TransferFunction>(wish)) return wish;
  const auto* given = std::get_if<NamedTransferFunction>(&wish);
  if (given != nullptr && given->name == species_colors) return function;
  const TransferFunction::Point &first = function.points.front(), &last = function.points.back();
  for (const std::string& name : color_map_names()) {
    const NamedTransferFunction named{
        name, {{first.value, last.value}}, last.extinction, function.log_scale};
    if (fit_transfer_function(named, {}, {}, 0) == function) return named;
  }
  return function;
}

}  // namespace

Scene fill_in(const Scene& scene, const std::vector<Field>& fields,
              const std::vector<FieldSource>& sources, const ResolvedScene& resolved) {
  assert(sources.size() == resolved.transfer_functions.size());
  Scene filled = scene;
  const Camera& camera = resolved.camera;
  filled.eye = camera.eye;
  filled.target = camera.target;
  filled.up = camera.up;
  filled.orthographic_height = camera.orthographic_height;
  if (!camera.orthographic_height) filled.fov_degrees = camera.fov_degrees;
  filled.render.step_size = resolved.step_size;
  filled.fields = fields;
  std::size_t number = 0;  // among the visible ones
  for (Field& field : filled.fields) {
    if (!field.visible) continue;
    assert(number < sources.size());
    const FieldSource& source = sources[number];
    const TransferFunction& function = resolved.transfer_functions[number++];
    if (field.draws_volume()) {
      field.transfer_function = written_form(field.transfer_function, function);
    }
    if (field.grid) continue;
    if (!field.radius) field.radius = plain_number(source.radius);
    // Weights that differ and that nobody gave are masses.
    if (!field.weight) field.weight = plain_number(source.weight).value_or(std::string("mass"));
    field.normalise = source.normalise;
  }
  return filled;
}

}  // namespace motes
