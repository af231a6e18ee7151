#include "surface/brute_force.h"

#include <algorithm>
#include <cmath>

namespace motes {

std::vector<Solid> solids_of(const Surface& surface) {
  std::vector<Solid> solids;
  const KernelSet& kernels = *surface.kernels;
  const Sticks& sticks = surface.sticks;
  for (std::uint32_t p = 0; p < kernels.size(); ++p) {
    const Point3d center{kernels.x[p], kernels.y[p], kernels.z[p]};
    if (surface.radius[p] > 0) solids.push_back({center, {}, surface.radius[p], p, no_stick});
    if (sticks.begin.empty()) continue;
    for (std::uint32_t s = sticks.begin[p]; s < sticks.begin[p + 1]; ++s) {
      solids.push_back(
          {center, {sticks.x[s], sticks.y[s], sticks.z[s]}, sticks.radius_of(s), p, s});
    }
  }
  return solids;
}

Line camera_line(const SurfaceView& view, double u, double v) {
  const Vector3d across = u * view.axes.x + v * view.axes.y;
  if (view.orthographic) return {view.eye + across, view.axes.forward};
  return {view.eye, view.axes.forward + across};
}

namespace {

Crossing cross_ball(const Line& line, const Solid& ball, double radius) {
  const Vector3d to_center = ball.center - line.origin;
  const double square = dot(line.direction, line.direction);
  const double middle = dot(to_center, line.direction) / square;
  const Vector3d moment = cross(to_center, line.direction);
  const double half_square = (radius * radius - dot(moment, moment) / square) / square;
  if (half_square < 0) return {};
  return {middle - std::sqrt(half_square), middle + std::sqrt(half_square)};
}

/// All the line's crossings of the mantle and of both ends, of which there are two or none.
Crossing cross_stick(const Line& line, const Solid& stick, double more) {
  const double radius = stick.radius + more;
  // As docs/surface.md says: a little beyond the middle of the bond.
  const double end = length(stick.half) * (1 + 1e-5) + more;
  const Vector3d axis = normalize(stick.half);
  const double shift =
      dot(stick.center - line.origin, line.direction) / dot(line.direction, line.direction);
  const Vector3d from = line.at(shift) - stick.center;
  std::vector<double> crossings;
  const auto add = [&](double t) {
    if (std::isfinite(t)) crossings.push_back(t);
  };
  // |(from + t direction) x axis|^2 = radius^2
  const Vector3d d = cross(line.direction, axis), f = cross(from, axis);
  const double a = dot(d, d), b = dot(d, f), c = dot(f, f) - radius * radius;
  if (b * b - a * c >= 0) {
    for (const double sign : {-1., 1.}) {
      const double t = (-b + sign * std::sqrt(b * b - a * c)) / a;
      const double along = dot(from + t * line.direction, axis);
      if (along >= -more && along <= end) add(t);
    }
  }
  for (const double plane : {-more, end}) {
    const double t = (plane - dot(from, axis)) / dot(line.direction, axis);
    const Vector3d off = cross(from + t * line.direction, axis);
    if (dot(off, off) <= radius * radius) add(t);
  }
  if (crossings.empty()) return {};
  const auto [first, last] = std::minmax_element(crossings.begin(), crossings.end());
  return {shift + *first, shift + *last};
}

}  // namespace

Crossing cross(const Line& line, const Solid& solid, double more) {
  if (solid.radius + more <= 0) return {};
  return solid.is_ball() ? cross_ball(line, solid, solid.radius + more)
                         : cross_stick(line, solid, more);
}

Vector3d normal_at(const Solid& solid, const Point3d& point) {
  const Vector3d from = point - solid.center;
  if (solid.is_ball()) return normalize(from);
  const Vector3d axis = normalize(solid.half);
  const double along = dot(from, axis);
  const Vector3d off = from - along * axis;
  // The nearest of the mantle and the two ends.
  const double to_side = std::abs(length(off) - solid.radius), to_begin = std::abs(along);
  const double to_end = std::abs(along - length(solid.half) * (1 + 1e-5));
  if (to_side <= std::min(to_begin, to_end)) return normalize(off);
  return to_end < to_begin ? axis : -axis;
}

}  // namespace motes
