// Depths and normals of hits in double precision. Included once per instruction set.
#if defined(MOTES_SURFACE_FINISH_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MOTES_SURFACE_FINISH_INL_H_
#undef MOTES_SURFACE_FINISH_INL_H_
#else
#define MOTES_SURFACE_FINISH_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "surface/primary-inl.h"
#include "surface/shapes-inl.h"
#include "surface/surface.h"
#include "surface/tile_rays.h"
#include "surface/trace.h"

HWY_BEFORE_NAMESPACE();
namespace motes {
namespace HWY_NAMESPACE {

/// Where a line meets a solid, and the unit normal there, towards where the line comes from.
template <class V>
struct Finished {
  V depth;
  Vector3v<V> normal;
};

/// The end of a chord that is seen from the line's origin, which lies `before` the chord's own: its
/// first, unless that lies behind.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V seen_end(D d, V before, const Chord<D>& chord) {
  const auto in_front = hn::Gt(hn::Add(before, chord.first), hn::Zero(d));
  return hn::IfThenElse(in_front, chord.first, chord.last);
}

/// v with length 1, turned against the direction.
template <class D, class V = hn::Vec<D>>
HWY_INLINE Vector3v<V> turned_back(D d, const Vector3v<V>& v, const Vector3v<V>& direction) {
  const V square = hn::Max(dot(d, v, v), hn::Set(d, 1e-300));
  const V scale = hn::Div(hn::Set(d, 1.0), hn::Sqrt(square));
  const auto along = hn::Gt(dot(d, v, direction), hn::Zero(d));
  const V turned = hn::IfThenElse(along, hn::Neg(scale), scale);
  return {hn::Mul(v.x, turned), hn::Mul(v.y, turned), hn::Mul(v.z, turned)};
}

/// A line from 0 as one from where it passes a centre, relative to that: nothing large is left that
/// would have to cancel.
template <class D>
struct NearLine {
  hn::Vec<D> before;  ///< how far along the line, in its directions
  Vector3v<hn::Vec<D>> origin;
};

template <class D, class V = hn::Vec<D>>
HWY_INLINE NearLine<D> line_near(D d, const Vector3v<V>& direction, V inverse_square,
                                 const Vector3v<V>& center) {
  const V before = hn::Mul(dot(d, center, direction), inverse_square);
  return {before,
          {hn::MulSub(before, direction.x, center.x), hn::MulSub(before, direction.y, center.y),
           hn::MulSub(before, direction.z, center.z)}};
}

/// Lines from 0 against balls that they meet, or miss by rounding.
template <class D, class V = hn::Vec<D>>
HWY_INLINE Finished<V> finish_balls(D d, const Vector3v<V>& direction, const Vector3v<V>& center,
                                    V radius) {
  const V inverse_square = hn::Div(hn::Set(d, 1.0), dot(d, direction, direction));
  const NearLine<D> line = line_near(d, direction, inverse_square, center);
  const V end =
      seen_end(d, line.before, meet_ball(d, line.origin, direction, inverse_square, radius));
  return {hn::Add(line.before, end),
          turned_back(d, add_scaled(d, line.origin, end, direction), direction)};
}

/// The same for sticks from `center`; axis: a unit vector.
template <class D, class V = hn::Vec<D>>
HWY_INLINE Finished<V> finish_sticks(D d, const Vector3v<V>& direction, const Vector3v<V>& center,
                                     const Vector3v<V>& axis, V length, V radius) {
  const V inverse_square = hn::Div(hn::Set(d, 1.0), dot(d, direction, direction));
  const NearLine<D> line = line_near(d, direction, inverse_square, center);
  const StickChord<D> chord = meet_stick(d, line.origin, direction, axis, length, radius);
  const V end = seen_end<D>(d, line.before, chord);
  const Vector3v<V> place = add_scaled(d, line.origin, end, direction);
  const Vector3v<V> outwards = add_scaled(d, place, hn::Neg(dot(d, place, axis)), axis);
  const auto side = hn::Or(hn::Eq(end, chord.first_side), hn::Eq(end, chord.last_side));
  return {hn::Add(line.before, end), turned_back(d,
                                                 {hn::IfThenElse(side, outwards.x, axis.x),
                                                  hn::IfThenElse(side, outwards.y, axis.y),
                                                  hn::IfThenElse(side, outwards.z, axis.z)},
                                                 direction)};
}

/// One line from `origin` against the stick, or ball if that is no_stick, of a particle.
inline SurfaceHit finish_hit(const Surface& surface, const Point3d& origin,
                             const Vector3d& direction, std::uint32_t particle,
                             std::uint32_t stick) {
  const hn::CappedTag<double, 1> d;
  using V = hn::Vec<decltype(d)>;
  const auto set = [&](const Vector3d& v) HWY_ATTR {
    return Vector3v<V>{hn::Set(d, v.x), hn::Set(d, v.y), hn::Set(d, v.z)};
  };
  const KernelSet& kernels = *surface.kernels;
  const Vector3d center =
      Point3d{kernels.x[particle], kernels.y[particle], kernels.z[particle]} - origin;
  Finished<V> finished;
  if (stick == no_stick) {
    finished = finish_balls(d, set(direction), set(center), hn::Set(d, surface.radius[particle]));
  } else {
    const Sticks& sticks = surface.sticks;
    const Vector3d half{sticks.x[stick], sticks.y[stick], sticks.z[stick]};
    const double half_length = length(half);
    finished = finish_sticks(d, set(direction), set(center), set(half / half_length),
                             hn::Set(d, half_length), hn::Set(d, sticks.radius_of(stick)));
  }
  const auto component = [](V v) HWY_ATTR { return static_cast<float>(hn::GetLane(v)); };
  return {
      hn::GetLane(finished.depth),
      particle,
      stick,
      {component(finished.normal.x), component(finished.normal.y), component(finished.normal.z)}};
}

/// The hits of a block's rays, with all that SurfaceHits holds of them.
struct BlockHits {
  alignas(64) double depth[TileRays::lanes];
  alignas(64) float normal[3][TileRays::lanes];
};

/// Works out the hits of a block as if all were of balls; those of rays without a hit are of no
/// meaning.
inline void finish_block_balls(const Surface& surface, const TileRays& rays, std::size_t block,
                               const std::uint32_t* particles, BlockHits& out) {
  const hn::CappedTag<double, max_lanes / 2> d;
  const hn::Rebind<float, decltype(d)> df;
  using V = hn::Vec<decltype(d)>;
  const KernelSet& kernels = *surface.kernels;
  alignas(64) double u[TileRays::lanes], v[TileRays::lanes];
  alignas(64) float x[TileRays::lanes], y[TileRays::lanes], z[TileRays::lanes];
  alignas(64) float radius[TileRays::lanes];
  for (std::size_t l = 0; l < TileRays::lanes; ++l) {
    u[l] = rays.first_place[0] + TileRays::column(block, l) * rays.place_step[0];
    v[l] = rays.first_place[1] + TileRays::row(block, l) * rays.place_step[1];
    const std::size_t p = particles[l] == no_particle ? 0 : particles[l];
    x[l] = kernels.x[p];
    y[l] = kernels.y[p];
    z[l] = kernels.z[p];
    radius[l] = surface.radius[p];
  }
  for (std::size_t l = 0; l < TileRays::lanes; l += hn::Lanes(d)) {
    const V place_u = hn::Load(d, u + l), place_v = hn::Load(d, v + l);
    const auto camera_ray = [&](int i, bool is_direction) HWY_ATTR {
      const V from = hn::Set(d, is_direction ? rays.forward[i] : rays.eye[i]);
      if (is_direction == rays.orthographic) return from;
      return hn::MulAdd(place_u, hn::Set(d, rays.axes[0][i]),
                        hn::MulAdd(place_v, hn::Set(d, rays.axes[1][i]), from));
    };
    const auto center = [&](const float* array, int i) HWY_ATTR {
      return hn::Sub(hn::PromoteTo(d, hn::Load(df, array + l)), camera_ray(i, false));
    };
    const Finished<V> finished =
        finish_balls(d, Vector3v<V>{camera_ray(0, true), camera_ray(1, true), camera_ray(2, true)},
                     Vector3v<V>{center(x, 0), center(y, 1), center(z, 2)},
                     hn::PromoteTo(d, hn::Load(df, radius + l)));
    hn::Store(finished.depth, d, out.depth + l);
    hn::Store(hn::DemoteTo(df, finished.normal.x), df, out.normal[0] + l);
    hn::Store(hn::DemoteTo(df, finished.normal.y), df, out.normal[1] + l);
    hn::Store(hn::DemoteTo(df, finished.normal.z), df, out.normal[2] + l);
  }
}

/// The line of a tile's ray.
struct CameraRay {
  Point3d origin;
  Vector3d direction;
};
inline CameraRay camera_ray(const TileRays& rays, int column, int row) {
  const Vector3d across = (rays.first_place[0] + column * rays.place_step[0]) * rays.axes[0] +
                          (rays.first_place[1] + row * rays.place_step[1]) * rays.axes[1];
  if (rays.orthographic) return {rays.eye + across, rays.forward};
  return {rays.eye, rays.forward + across};
}

/// Works out the hits of a tile whose first ray is that in `column` and `row`.
inline void finish_tile(const Surface& surface, const TileRays& rays, const TileHits& tile,
                        int column, int row, const RayGrid& grid, SurfaceHits& hits) {
  for (std::size_t block = 0; block < TileRays::num_blocks; ++block) {
    const std::uint32_t* const particles = tile.particle + block * TileRays::lanes;
    BlockHits finished;
    const auto is_hit = [](std::uint32_t particle) { return particle != no_particle; };
    if (std::any_of(particles, particles + TileRays::lanes, is_hit)) {
      finish_block_balls(surface, rays, block, particles, finished);
    }
    for (std::size_t l = 0; l < TileRays::lanes; ++l) {
      const int x = TileRays::column(block, l), y = TileRays::row(block, l);
      if (!rays.has(x, y)) continue;
      SurfaceHit hit;
      hit.particle = particles[l];
      hit.stick = tile.stick[block * TileRays::lanes + l];
      if (hit.stick != no_stick) {
        const CameraRay ray = camera_ray(rays, x, y);
        hit = finish_hit(surface, ray.origin, ray.direction, hit.particle, hit.stick);
      } else if (hit.any()) {
        hit.depth = finished.depth[l];
        hit.normal = {finished.normal[0][l], finished.normal[1][l], finished.normal[2][l]};
      }
      const auto at =
          static_cast<std::size_t>(row + y - grid.row) * static_cast<std::size_t>(grid.width) +
          static_cast<std::size_t>(column + x - grid.column);
      hits.set(at, hit);
    }
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace motes
HWY_AFTER_NAMESPACE();

#endif
