#include "isosurface/isosurface.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "isosurface/trace_isosurfaces.cc"
#include <hwy/foreach_target.h>
// Included again for each instruction set.
#include <hwy/highway.h>

#include "isosurface/grid_along_rays-inl.h"
#include "isosurface/kernels_along_rays-inl.h"
#include "isosurface/march-inl.h"
#include "isosurface/occlusion-inl.h"

HWY_BEFORE_NAMESPACE();
namespace motes {
namespace HWY_NAMESPACE {

constexpr int tile_side = 16;

/// The rays of columns x to x + width - 1 and rows y to y + height - 1, lanes row by row.
inline RayPacket make_packet(const IsosurfaceFrame& frame, const RayGrid& grid, int x, int y,
                             int width, int height) {
  RayPacket packet{};
  packet.lanes = width * height;
  const bool orthographic = frame.view.orthographic;
  for (int l = 0; l < packet.lanes; ++l) {
    const int column = x + l % width, row = y + l / width;
    const double u = grid.u + column * grid.du, v = grid.v + row * grid.dv;
    (orthographic ? packet.origin_x : packet.direction_x)[l] = u;
    (orthographic ? packet.origin_y : packet.direction_y)[l] = v;
  }
  return packet;
}

RayBounds bounds_of_tile(const IsosurfaceFrame& frame, const RayGrid& grid, int x, int y) {
  constexpr int last = tile_side - 1;
  const double u = grid.u + x * grid.du, v = grid.v + y * grid.dv;
  const Range across{std::min(u, u + last * grid.du), std::max(u, u + last * grid.du)};
  const Range up{std::min(v, v + last * grid.dv), std::max(v, v + last * grid.dv)};
  if (frame.view.orthographic) return {across, up, {}, {}};
  return {{}, {}, across, up};
}

/// The packets of the tile at column x and row y that have rays of the grid.
std::vector<MarchPacket> make_packets(const IsosurfaceFrame& frame, const RayGrid& grid, int x,
                                      int y) {
  constexpr int width = num_lanes >= 8 ? 4 : 2, height = num_lanes / width;
  std::vector<MarchPacket> packets;
  for (int row = y; row < y + tile_side; row += height) {
    for (int column = x; column < x + tile_side; column += width) {
      MarchPacket packet;
      for (int l = 0; l < num_lanes; ++l) {
        const int i = column + l % width - grid.column, j = row + l / width - grid.row;
        if (i < 0 || i >= grid.width || j < 0 || j >= grid.height) continue;
        packet.active |= 1u << l;
        packet.ray[l] = static_cast<std::uint32_t>(j * grid.width + i);
      }
      if (packet.active == 0) continue;
      packet.rays = make_packet(frame, grid, column, row, width, height);
      std::fill_n(packet.value, max_lanes, 0.0f);
      std::fill_n(packet.slope, max_lanes, 0.0f);
      packets.push_back(packet);
    }
  }
  return packets;
}

template <class Field>
void march_tile(const IsosurfaceFrame& frame, const SamplingConstants& constants,
                const FieldIsosurfaces& field, const RayGrid& grid, int x, int y,
                std::vector<IsosurfaceHit>& out) {
  const View view{frame.view.axes, frame.view.eye, frame.planes};
  const RayBounds bounds = bounds_of_tile(frame, grid, x, y);
  std::vector<MarchPacket> packets = make_packets(frame, grid, x, y);
  SlabMarch<Field> march(frame, constants, field, out);
  // Slabs share a plane, so that no interval between planes is left out.
  for (SampleIndex k = 0; k < frame.last_plane; k += max_frame_planes - 1) {
    const Slab slab{k, std::min(frame.last_plane - k + 1, max_frame_planes)};
    const bool any = march.enter(bounds, slab, view);
    bool active = false;
    for (MarchPacket& packet : packets) {
      if (packet.active == 0) continue;
      active = true;
      if (any) {
        march.run(packet, view);
        continue;
      }
      skip<Field>(packet);
    }
    if (!active) break;
  }
}

void trace_grid(const IsosurfaceFrame& frame, const RayGrid& grid,
                std::vector<IsosurfaceHit>& out) {
  const SamplingConstants constants = make_constants(*frame.kernels);
  const auto tile_begin = [](int i) { return i & -tile_side; };
  for (const FieldIsosurfaces& field : frame.fields) {
    for (int y = tile_begin(grid.row); y < grid.row + grid.height; y += tile_side) {
      for (int x = tile_begin(grid.column); x < grid.column + grid.width; x += tile_side) {
        const auto march = field.grid ? &march_tile<GridAlongRays> : &march_tile<KernelsAlongRays>;
        march(frame, constants, field, grid, x, y, out);
      }
    }
  }
}

/// How far the longest of the ways out of a box is that lead from p along `directions`; 0 if p is
/// outside of it.
double way_out(const Bounds3d& box, const Point3d& p, const std::vector<Vector3f>& directions) {
  double farthest = 0;
  for (const Vector3f& direction : directions) {
    double way = std::numeric_limits<double>::infinity();
    for (int i = 0; i < 3; ++i) {
      const double along = static_cast<double>(direction[i]);
      if (along != 0) way = std::min(way, ((along > 0 ? box.max[i] : box.min[i]) - p[i]) / along);
    }
    farthest = std::max(farthest, way);
  }
  return farthest;
}

void prune_directions(const IsosurfaceFrame& frame, const Point3d& place, const Vector3d& normal,
                      double length, std::vector<Vector3f>& directions) {
  const SamplingConstants constants = make_constants(*frame.kernels);
  // Off the surface, so that rounding does not tell on which side of it a ray begins.
  constexpr double steps_off = 0.05;
  const Point3d start = place + steps_off * frame.planes.step * normal;
  const auto reach = static_cast<float>(std::min(length, way_out(frame.box, start, directions)));
  for (const FieldIsosurfaces& field : frame.fields) {
    const bool hides = std::any_of(field.levels.begin(), field.levels.end(),
                                   [](const IsosurfaceLevel& level) { return level.opacity >= 1; });
    if (hides && !directions.empty()) {
      if (field.grid) {
        GridSurroundings surroundings(*field.grid, start);
        prune_by_field(frame, surroundings, field, start, reach, directions);
      } else {
        Surroundings surroundings(*frame.kernels, constants, field.field, start);
        prune_by_field(frame, surroundings, field, start, reach, directions);
      }
    }
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace motes
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include <tuple>

namespace motes {
namespace {

HWY_EXPORT(trace_grid);
HWY_EXPORT(prune_directions);

/// By the levels' numbers: in which order those come that lie at one depth, as where several
/// are closed by a grid's face. What is farther from 0 is within the others, and comes first.
std::vector<std::size_t> ranks_of(const IsosurfaceFrame& frame) {
  std::vector<const IsosurfaceLevel*> levels;
  for (const FieldIsosurfaces& field : frame.fields) {
    const auto first = static_cast<std::ptrdiff_t>(levels.size());
    for (const IsosurfaceLevel& level : field.levels) levels.push_back(&level);
    std::stable_sort(levels.begin() + first, levels.end(),
                     [](const IsosurfaceLevel* a, const IsosurfaceLevel* b) {
                       return std::abs(a->value) > std::abs(b->value);
                     });
  }
  std::vector<std::size_t> ranks;
  for (std::size_t i = 0; i < levels.size(); ++i) {
    ranks.resize(std::max<std::size_t>(ranks.size(), levels[i]->number + 1));
    ranks[levels[i]->number] = i;
  }
  return ranks;
}

/// Sorts hits ray by ray and from the front, and leaves out those behind opaque ones.
void keep_visible(const IsosurfaceFrame& frame, std::vector<IsosurfaceHit>& hits) {
  const std::vector<std::size_t> ranks = ranks_of(frame);
  std::sort(hits.begin(), hits.end(), [&](const IsosurfaceHit& a, const IsosurfaceHit& b) {
    return std::tie(a.ray, a.depth, ranks[a.level]) < std::tie(b.ray, b.depth, ranks[b.level]);
  });
  std::size_t size = 0;
  bool ended = false;
  for (std::size_t i = 0; i < hits.size(); ++i) {
    if (i == 0 || hits[i].ray != hits[i - 1].ray) ended = false;
    const bool opaque = hits[i].opacity >= 1;
    if (!ended) hits[size++] = hits[i];
    ended = ended || opaque;
  }
  hits.resize(size);
}

}  // namespace

bool is_clipped(const IsosurfaceFrame& frame, const Point3d& place) {
  return std::any_of(frame.clip_planes.begin(), frame.clip_planes.end(),
                     [&](const ClipPlane& plane) {
                       return dot(plane.normal, place - Point3d{}) > plane.distance;
                     });
}

void trace_isosurfaces(const IsosurfaceFrame& frame, const RayGrid& grid,
                       std::vector<IsosurfaceHit>& out) {
  out.clear();
  HWY_DYNAMIC_DISPATCH(trace_grid)(frame, grid, out);
  keep_visible(frame, out);
}

void prune(const IsosurfaceFrame& frame, const Point3d& place, const Vector3d& normal,
           double length, std::vector<Vector3f>& directions) {
  HWY_DYNAMIC_DISPATCH(prune_directions)(frame, place, normal, length, directions);
}

}  // namespace motes
#endif
