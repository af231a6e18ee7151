#include "render/grid_fields.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <utility>

namespace motes {
namespace {

/// The largest magnitude of the field, nearly.
double magnitude_of(const MacroCells& cells) {
  double largest = 0;
  for (const MacroCells::Range& range : cells.ranges()) {
    largest = std::max({largest, -double{range.min}, double{range.max}});
  }
  return largest;
}

bool has_both_signs(const MacroCells& cells) {
  bool negative = false, positive = false;
  for (const MacroCells::Range& range : cells.ranges()) {
    negative |= range.min < 0;
    positive |= range.max > 0;
  }
  return negative && positive;
}

/// The shortest edge of a voxel.
double shortest_edge(const GridSampler& sampler) {
  const Point3d origin = sampler.to_world({0, 0, 0});
  return std::min({length(sampler.to_world({1, 0, 0}) - origin),
                   length(sampler.to_world({0, 1, 0}) - origin),
                   length(sampler.to_world({0, 0, 1}) - origin)});
}

}  // namespace

GridFields make_grid_fields(const std::vector<FieldSource>& fields) {
  std::map<std::pair<const Grid*, Reconstruction>, GridField> made;
  GridFields grids;
  for (std::size_t f = 0; f < fields.size(); ++f) {
    if (!fields[f].grid) continue;
    GridField& grid = made[{fields[f].grid.get(), fields[f].interpolation}];
    if (!grid.sampler) {
      grid.sampler = std::make_shared<GridSampler>(*fields[f].grid, fields[f].interpolation);
      grid.cells = std::make_shared<MacroCells>(*grid.sampler);
    }
    grid.field = f;
    grids.push_back(grid);
  }
  return grids;
}

void set_units(const GridFields& grids, KernelSet& kernels) {
  if (grids.empty()) return;
  if (kernels.size() == 0) {
    const Bounds3d box = volume_box(kernels, grids);
    const Vector3d sides = box.diagonal();
    kernels.origin = box.center();
    kernels.length_scale = unit_scale(std::max({sides.x, sides.y, sides.z}));
  }
  for (const GridField& grid : grids) {
    FieldKernels& field = kernels.fields[grid.field];
    field.min_radius = static_cast<float>(shortest_edge(*grid.sampler) * kernels.length_scale);
    field.value_scale = unit_scale(magnitude_of(*grid.cells));
    field.mixed_signs = has_both_signs(*grid.cells);
  }
}

std::size_t num_bytes(const GridFields& grids) {
  std::set<const GridSampler*> counted;
  std::size_t sum = 0;
  for (const GridField& grid : grids) {
    if (!counted.insert(grid.sampler.get()).second) continue;
    sum += grid.sampler->num_bytes() + grid.cells->num_bytes();
  }
  return sum;
}

Bounds3d volume_box(const KernelSet& kernels, const GridFields& grids) {
  Bounds3d box = kernels.box();
  for (const GridField& grid : grids) box.add(grid.sampler->bounds());
  return box;
}

std::vector<FieldSample> probe(const KernelSet& kernels, const GridFields& grids,
                               std::span<const Point3d> points, double outside) {
  std::vector<FieldSample> samples = probe(kernels, points);
  const std::size_t num_fields = kernels.fields.size();
  for (const GridField& grid : grids) {
    for (std::size_t i = 0; i < points.size(); ++i) {
      const std::optional<GridSample> sample = grid.sampler->sample(points[i]);
      FieldSample& out = samples[i * num_fields + grid.field];
      out = sample ? FieldSample{sample->value, sample->gradient}
                   : FieldSample{outside, {outside, outside, outside}};
    }
  }
  return samples;
}

}  // namespace motes
