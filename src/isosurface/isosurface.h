// Isosurfaces of fields, ready to be met by rays (docs/isosurface.md).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "core/aligned.h"
#include "core/color.h"
#include "core/vec.h"
#include "field/kernel_set.h"
#include "grid/grid_sampler.h"
#include "grid/macro_cells.h"
#include "samples/samples.h"
#include "scene/clip_plane.h"
#include "surface/trace.h"

namespace motes {

/// One value at which a field is drawn.
struct IsosurfaceLevel {
  std::uint32_t number = 0;  ///< among all levels of the frame
  float value = 0;           ///< internal (FieldKernels::value_scale)
  float opacity = 1;
  std::vector<Color> colors;  ///< one, or one a species
};

/// A field that is a grid, in index coordinates (GridSampler).
struct IsosurfaceGrid {
  GridView view;
  Point3d origin;             ///< of the kernels
  Vector3d axes[3];           ///< gradients of the index coordinates, per internal length
  double value_scale = 1;     ///< from the grid's values to internal ones
  std::array<int, 3> dims{};  ///< of `crosses`
  std::vector<std::uint8_t>
      crosses;  ///< whether the field may take a level's value in a macro cell

  /// Index coordinate i of a place relative to the kernels' origin, internal lengths.
  double index_of(int i, const Point3d& p) const { return origin[i] + dot(axes[i], p - Point3d{}); }
};

struct FieldIsosurfaces {
  std::size_t field = 0;
  std::vector<IsosurfaceLevel> levels;
  std::optional<IsosurfaceGrid> grid;  ///< what the field is, if it has no kernels
};

/// Everything that a frame's tiles share; made once a frame, then only read. Lengths are internal,
/// relative to the kernels' origin.
struct IsosurfaceFrame {
  const KernelSet* kernels = nullptr;
  /// Species of each kernel, where a level has a colour for each; else may be null.
  const std::uint16_t* species = nullptr;
  std::vector<FieldIsosurfaces> fields;
  SurfaceView view;
  SamplePlanes planes;         ///< on which fields are sampled: `first` is in front of all kernels
  SampleIndex last_plane = 0;  ///< behind all kernels
  Bounds3d box;                ///< beyond which there are no levels
  std::vector<ClipPlane> clip_planes;  ///< unit normals
};

/// Whether a place is cut away.
bool is_clipped(const IsosurfaceFrame& frame, const Point3d& place);

/// Where a ray crosses a level.
struct IsosurfaceHit {
  std::uint32_t ray = 0;    ///< of the grid, counted row by row
  std::uint32_t level = 0;  ///< IsosurfaceLevel::number
  float opacity = 1;
  double depth = 0;  ///< along the view
  Normal3f normal;   ///< unit, world axes, to the side of the surface that the ray comes from
  Color color;       ///< linear, unlit
};

/// Finds where the rays of `grid` cross the frame's levels in front of the eye, up to the first
/// opaque one: ray by ray, from the front. A sign of Phi - value that changes between neighbouring
/// planes is a crossing, found to 1e-4 of the step on the field itself; two crossings between
/// neighbouring planes are found where the field's slopes there point to them. What a ray crosses
/// does not depend on which others the grid has. For one thread. Hot: nothing is checked.
void trace_isosurfaces(const IsosurfaceFrame& frame, const RayGrid& grid,
                       std::vector<IsosurfaceHit>& out);

/// Leaves out the directions, unit vectors, along which an opaque level is nearer than `length`
/// to a place on a surface with that normal. Rays are sampled every 1.5 steps.
/// What clip planes cut away hides nothing.
void prune(const IsosurfaceFrame& frame, const Point3d& place, const Vector3d& normal,
           double length, std::vector<Vector3f>& directions);

}  // namespace motes
