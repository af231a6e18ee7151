// Fields that are grids: for the .cc files of this room alone.
#pragma once

#include <cstddef>
#include <vector>

#include "scene/scene.h"

namespace motes {

/// Appends to `out` the fields that number `k` of the scene's, which is a grid, comes to: one a
/// grid of its file unless it says which, with the grids' names where it has none, or with them
/// behind its own where there are several. Of several whose values are of both signs, as orbitals,
/// only the first is visible: four colours in one place tell nothing. Isosurfaces are fitted;
/// finish_fitted() is to follow. Throws Error, which names the key.
void expand_grid_field(const Field& field, std::size_t k, const std::vector<LoadedGrid>& grids,
                       std::vector<Field>& out);

/// Makes fitted isosurfaces translucent that would hide those of another field, and forgets that
/// they were fitted.
void finish_fitted(std::vector<Field>& fields, const std::vector<LoadedGrid>& grids);

/// The source of an expanded field that is a grid. Precondition: its grid is there.
FieldSource grid_source(const Field& field, const std::vector<LoadedGrid>& grids);

/// Tells the grids among the sources apart by their colours.
void color_grids(std::vector<FieldSource>& sources);

}  // namespace motes
