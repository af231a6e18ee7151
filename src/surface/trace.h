// Rays against balls and sticks: the nearest hits of a tile of camera rays, and single rays.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

#include "core/aligned.h"
#include "core/vec.h"
#include "scene/camera.h"
#include "surface/surface.h"

namespace motes {

/// The camera in internal lengths, relative to the origin of the kernels' positions.
struct SurfaceView {
  CameraAxes axes;
  Point3d eye;
  bool orthographic = false;
};

/// Some of the rays through places in the image that are evenly apart: that of column i and row j
/// has the u and v of docs/field.md, "Samples", u + i du and v + j dv. (They are tangents, or
/// internal lengths if the camera is orthographic.) Steps are not 0.
struct RayGrid {
  double u = 0, v = 0, du = 0, dv = 0;
  int column = 0, row = 0, width = 0, height = 0;  ///< columns from `column` on; may be negative

  std::size_t size() const {
    return static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  }
};

inline constexpr std::uint32_t no_particle = std::numeric_limits<std::uint32_t>::max();
inline constexpr std::uint32_t no_stick = std::numeric_limits<std::uint32_t>::max();

/// What a ray meets first.
struct SurfaceHit {
  /// Along the ray, in lengths of its direction: of a camera ray the depth.
  double depth = std::numeric_limits<double>::infinity();
  std::uint32_t particle = no_particle;  ///< in leaf order
  std::uint32_t stick = no_stick;        ///< that of the particle's sticks, unless it is the ball
  Normal3f normal;                       ///< unit, world axes, towards where the ray comes from

  bool any() const { return particle != no_particle; }
};

/// The hits of a RayGrid, row by row.
struct SurfaceHits {
  UninitializedVector<double> depth;  ///< along the view; infinity where nothing is hit
  UninitializedVector<std::uint32_t> particle, stick;       ///< as in SurfaceHit
  UninitializedVector<float> normal_x, normal_y, normal_z;  ///< 0 where nothing is hit

  void resize(std::size_t n);
  SurfaceHit operator[](std::size_t i) const {
    return {depth[i], particle[i], stick[i], {normal_x[i], normal_y[i], normal_z[i]}};
  }
  void set(std::size_t i, const SurfaceHit& hit) {
    depth[i] = hit.depth;
    particle[i] = hit.particle;
    stick[i] = hit.stick;
    normal_x[i] = hit.normal.x;
    normal_y[i] = hit.normal.y;
    normal_z[i] = hit.normal.z;
  }
};

/// Finds the first hit of each ray in front of the eye (or, orthographic, of the plane through it):
/// from within a ball or stick that is its inside. Depths and normals of a hit are right to double
/// and single precision; which of two solids is hit first, or whether one is grazed, is decided to
/// 1e-6 of their radius, of the width of a tile of 16 x 16 rays there and 1e-7 of the depth. What a
/// ray hits does not depend on which others the grid has. For one thread; grids of some thousand
/// rays do best, with begins and sizes that are multiples of 16. Hot: nothing is checked.
void trace(const Surface& surface, const SurfaceView& view, const RayGrid& grid, SurfaceHits& hits);

/// The first hit of origin + t direction with 0 < t, in internal lengths relative to the kernels'
/// origin. Precondition: direction is not zero.
SurfaceHit trace(const Surface& surface, const Point3d& origin, const Vector3d& direction);

/// A point of a ball or stick, from which further rays start.
struct SurfacePoint {
  Point3d place;  ///< internal length, relative to the kernels' origin
  std::uint32_t particle = no_particle, stick = no_stick;  ///< as in SurfaceHit; or no_particle
};

/// How many of the rays from a point along `directions`, unit vectors, meet nothing before
/// `length`. They leave what the point lies on without meeting that; hits within a thousandth of a
/// radius from the point count as such.
int num_unoccluded(const Surface& surface, const SurfacePoint& from,
                   std::span<const Vector3f> directions, double length);

}  // namespace motes
