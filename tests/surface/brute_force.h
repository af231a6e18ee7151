// Rays against balls and sticks one by one, in double precision: what the tree's traces are held
// against.
#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "core/vec.h"
#include "surface/surface.h"
#include "surface/trace.h"

namespace motes {

/// A ball, or a stick from `center` to `center` + half.
struct Solid {
  Point3d center;
  Vector3d half;
  double radius;
  std::uint32_t particle, stick;

  bool is_ball() const { return stick == no_stick; }
};

/// All that is drawn.
std::vector<Solid> solids_of(const Surface& surface);

/// A camera ray or any other.
struct Line {
  Point3d origin;
  Vector3d direction;
  Point3d at(double t) const { return origin + t * direction; }
};

/// The ray of place (u, v) (docs/field.md, "Samples").
Line camera_line(const SurfaceView& view, double u, double v);

/// Where a line enters and leaves a solid, in lengths of its direction; enters > leaves if it does
/// not. The radius is taken `more` larger, and a stick so much longer.
struct Crossing {
  double enters = 1, leaves = 0;
  bool any() const { return enters <= leaves; }
  /// The first of both that lies beyond t, or infinity.
  double first_after(double t) const {
    if (!any()) return std::numeric_limits<double>::infinity();
    return enters > t ? enters : leaves > t ? leaves : std::numeric_limits<double>::infinity();
  }
};
Crossing cross(const Line& line, const Solid& solid, double more);

/// Unit normal at a point of a solid's surface, outwards.
Vector3d normal_at(const Solid& solid, const Point3d& point);

}  // namespace motes
