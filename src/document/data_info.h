// What there is to know about a document's data: what a page shows beside the picture.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/vec.h"
#include "particles/cell.h"
#include "particles/particle_set.h"
#include "scene/scene.h"

namespace motes {

struct SpeciesInfo {
  std::string name;
  std::size_t count = 0;   ///< particles of it, at least one
  std::uint32_t srgb = 0;  ///< display colour, 0xrrggbb
};

struct PropertyInfo {
  std::string name;
  std::optional<double> min, max;  ///< of the finite values; nullopt where there are none
};

struct GridInfo {
  std::string name;
  std::array<std::size_t, 3> dims{};
};

/// Of one field of the filled-in scene, at the same place.
struct FieldInfo {
  std::string name;
  std::size_t particles = 0;     ///< 0: a grid, or not visible
  std::optional<double> radius;  ///< the one that all of its particles have
};

struct DataInfo {
  std::filesystem::path path;  ///< empty: no particles, grids in files of their own
  std::string format;
  std::size_t particles = 0;
  std::optional<std::size_t> frames;  ///< nullopt: not counted yet
  std::optional<double> time;         ///< the file's own unit
  std::string length_unit;
  Bounds3d bounds;  ///< of the particles' centres and of the grids drawn
  std::vector<SpeciesInfo> species;
  std::vector<PropertyInfo> properties;
  std::optional<Cell> cell;
  std::vector<GridInfo> grids;
  std::vector<FieldInfo> fields;
};

/// Those that the particles have.
std::vector<SpeciesInfo> species_info(const ParticleSet& particles);
std::vector<PropertyInfo> property_info(const ParticleSet& particles);
/// `sources` are those of the visible fields.
std::vector<FieldInfo> field_info(const std::vector<Field>& fields,
                                  const std::vector<FieldSource>& sources);

}  // namespace motes
