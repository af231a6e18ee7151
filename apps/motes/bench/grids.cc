#include "motes/bench/grids.h"

#include <utility>

#include "grid/resample.h"

namespace motes {

std::vector<std::shared_ptr<const Grid>> resample_all(const KernelSet& kernels,
                                                      const Lattice& lattice) {
  std::vector<std::shared_ptr<const Grid>> grids;
  for (Grid& grid : resample(kernels, lattice)) {
    grids.push_back(std::make_shared<const Grid>(std::move(grid)));
  }
  return grids;
}

Renderer make_grid_renderer(const std::vector<std::shared_ptr<const Grid>>& grids,
                            Reconstruction interpolation) {
  std::vector<FieldSource> fields;
  for (const auto& grid : grids) {
    FieldSource& field = fields.emplace_back();
    field.name = grid->name;
    field.grid = grid;
    field.interpolation = interpolation;
  }
  return Renderer(ParticleSet{}, fields);
}

std::size_t grid_bytes(const Renderer& renderer) {
  std::size_t bytes = 0;
  for (const GridField& field : renderer.grids()) bytes += field.sampler->num_bytes();
  return bytes;
}

}  // namespace motes
