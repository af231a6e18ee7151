// Isosurfaces of fields, ready to be met by rays (docs/isosurface.md).
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "core/aligned.h"
#include "core/color.h"
#include "core/vec.h"
#include "field/kernel_set.h"
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

struct FieldIsosurfaces {
  std::size_t field = 0;
  std::vector<IsosurfaceLevel> levels;
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
  double reach = 0;            ///< how far opaque levels hide the light of a place
  std::vector<ClipPlane> clip_planes;  ///< unit normals
};

/// Where a ray crosses a level.
struct IsosurfaceHit {
  std::uint32_t ray = 0;    ///< of the grid, counted row by row
  std::uint32_t level = 0;  ///< IsosurfaceLevel::number
  float opacity = 1;
  double depth = 0;  ///< along the view
  Normal3f normal;   ///< unit, world axes, towards where the ray comes from
  Color color;       ///< linear, unlit
};

/// Finds where the rays of `grid` cross the frame's levels in front of the eye, up to the first
/// opaque one: ray by ray, from the front. A sign of Phi - value that changes between neighbouring
/// planes is a crossing, found to 1e-4 of the step on the field itself; two crossings between
/// neighbouring planes are found where the field's slopes there point to them. What a ray crosses
/// does not depend on which others the grid has. For one thread. Hot: nothing is checked.
void trace_isosurfaces(const IsosurfaceFrame& frame, const RayGrid& grid,
                       std::vector<IsosurfaceHit>& out);

/// Leaves out the directions, unit vectors, along which an opaque level is nearer than `length` and
/// the frame's reach to a place on a surface with that normal. Rays are sampled every 1.5 steps.
/// Clip planes are not looked at.
void prune(const IsosurfaceFrame& frame, const Point3d& place, const Vector3d& normal,
           double length, std::vector<Vector3f>& directions);

}  // namespace motes
