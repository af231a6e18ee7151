#include "motes/bench/draw_grids.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "motes/bench/draw_grids.cc"
#include <hwy/foreach_target.h>
// Included again for each instruction set.
#include <hwy/highway.h>

#include "core/flush_tiny.h"
#include "grid/sample_grid-inl.h"
#include "integrate/classifier.h"
#include "integrate/integrate-inl.h"
#include "integrate/shading.h"
#include "render/clip.h"
#include "samples/lanes-inl.h"
#include "samples/samples.h"

#ifndef MOTES_BENCH_GRID_FRAME
#define MOTES_BENCH_GRID_FRAME
namespace motes {
namespace {

/// Everything that a frame's rays share.
struct GridFrame {
  const DrawnGrids* fields;
  std::vector<GridView> views;
  Point3d eye;
  CameraAxes axes;
  double half_width, half_height, step;
  bool orthographic, gradients;
  std::vector<Classifier> classifiers;
  ShadingConstants shading;
  /// Gradient in camera axes = to_camera times gradient per index.
  std::array<std::array<float, 3>, 3> to_camera;
};

/// A block of rays in index coordinates: sample k of a lane is at `begin` + (k + 1/2) `step`.
struct IndexRays {
  std::array<Point3d, max_lanes> begin;
  std::array<Vector3d, max_lanes> step;
};

/// Sets up the ray of a pixel as lane `l`.
void start_ray(const GridFrame& frame, const Framebuffer& image, int px, int py, std::size_t l,
               IndexRays& index, RayState& rays) {
  const double u = (2 * (px + 0.5) / image.width - 1) * frame.half_width;
  const double v = (1 - 2 * (py + 0.5) / image.height) * frame.half_height;
  const Vector3d aside = u * frame.axes.x + v * frame.axes.y;
  const Point3d origin = frame.orthographic ? frame.eye + aside : frame.eye;
  const Vector3d direction = frame.orthographic ? frame.axes.forward : frame.axes.forward + aside;
  const GridSampler& sampler = frame.fields->samplers().front();
  index.begin[l] = sampler.to_index(origin);
  index.step[l] = sampler.to_index(origin + frame.step * direction) - index.begin[l];
  rays.first[l] = 0;
  rays.last[l] = -1;
  const DepthRange range = clip(frame.fields->box(), origin, direction);
  if (range.near <= range.far && px < image.width && py < image.height) {
    rays.first[l] = static_cast<float>(std::ceil(range.near / frame.step - 0.5));
    rays.last[l] = static_cast<float>(std::floor(range.far / frame.step - 0.5));
  }
  const double length_of = length(direction);
  const double camera[3] = {frame.orthographic ? 0 : u, frame.orthographic ? 0 : v, 1};
  rays.length[l] = static_cast<float>(length_of);
  for (int a = 0; a < 3; ++a) {
    rays.half_to_eye[a][l] = static_cast<float>(-0.5 * camera[a] / length_of);
  }
  for (float* channel : {rays.r, rays.g, rays.b, rays.a}) channel[l] = 0;
}

/// Which samples any of the rays has.
void set_range(RayState& rays, int lanes) {
  rays.begin = 1 << 30;
  rays.end = -1;
  for (int l = 0; l < lanes; ++l) {
    if (rays.first[l] > rays.last[l]) continue;
    rays.begin = std::min(rays.begin, static_cast<SampleIndex>(rays.first[l]));
    rays.end = std::max(rays.end, static_cast<SampleIndex>(rays.last[l]));
  }
}

/// Whether a field may be seen in the macro cells that samples `first` to `last` of the rays pass.
bool may_be_seen(const GridFrame& frame, const IndexRays& index, std::size_t lanes,
                 SampleIndex first, SampleIndex last) {
  Bounds3d box;
  for (std::size_t l = 0; l < lanes; ++l) {
    box.add(index.begin[l] + (first + 0.5) * index.step[l]);
    box.add(index.begin[l] + (last + 0.5) * index.step[l]);
  }
  for (std::size_t f = 0; f < frame.classifiers.size(); ++f) {
    const Visibility& visibility = frame.classifiers[f].visibility;
    const MacroCells& cells = frame.fields->macro_cells()[f];
    const auto block = [&](double x, int axis) {
      const int n = cells.dims()[static_cast<std::size_t>(axis)];
      return std::clamp(static_cast<int>(std::floor(x / MacroCells::size)), 0, n - 1);
    };
    for (int k = block(box.min.z, 2); k <= block(box.max.z, 2); ++k) {
      for (int j = block(box.min.y, 1); j <= block(box.max.y, 1); ++j) {
        for (int i = block(box.min.x, 0); i <= block(box.max.x, 0); ++i) {
          const MacroCells::Range& range = cells.at(i, j, k);
          const bool hidden = range.min == visibility.hidden && range.max == visibility.hidden;
          if (range.max > visibility.above && !hidden) return true;
        }
      }
    }
  }
  return false;
}

}  // namespace
}  // namespace motes
#endif

HWY_BEFORE_NAMESPACE();
namespace motes {
namespace HWY_NAMESPACE {

constexpr int slab_planes = 8;

/// Fills the buffer with samples of a slab; those outside of the box are 0.
template <bool kCubic, bool kGradient>
void sample_slab(const GridFrame& frame, const IndexRays& index, const RayState& rays,
                 const Slab& slab, SampleBuffer& buffer) {
  const LaneTag d;
  alignas(64) float begin[3][max_lanes], step[3][max_lanes];
  for (std::size_t l = 0; l < num_lanes; ++l) {
    const Point3d at = index.begin[l] + (slab.first + 0.5) * index.step[l];
    for (int a = 0; a < 3; ++a) {
      begin[a][l] = static_cast<float>(at[a]);
      step[a][l] = static_cast<float>(index.step[l][a]);
    }
  }
  const Lanes first = hn::Load(d, rays.first), last = hn::Load(d, rays.last);
  for (int i = 0; i < slab.count; ++i) {
    const Lanes number = hn::Set(d, static_cast<float>(i));
    const Lanes k = hn::Set(d, static_cast<float>(slab.first + i));
    const LaneMask inside = hn::And(hn::Ge(k, first), hn::Le(k, last));
    const auto place = [&](int a) HWY_ATTR {
      return hn::MulAdd(number, hn::Load(d, step[a]), hn::Load(d, begin[a]));
    };
    const GridPoints points{place(0), place(1), place(2)};
    for (std::size_t f = 0; f < frame.views.size(); ++f) {
      const Lanes value = sample_grid<kCubic, false>(d, frame.views[f], points).value;
      const Lanes value_inside = hn::IfThenElseZero(inside, value);
      float* const out = buffer.at(i, static_cast<int>(f));
      hn::Store(value_inside, d, out);
      // Gradients take longer, and only what is seen is lit.
      if constexpr (kGradient) {
        if (!may_be_seen(d, value_inside, frame.classifiers[f].visibility)) continue;
        const GridSamples s = sample_grid<kCubic, true>(d, frame.views[f], points);
        for (std::size_t a = 0; a < 3; ++a) {
          const auto& row = frame.to_camera[a];
          const Lanes sum =
              hn::MulAdd(hn::Set(d, row[0]), s.dx,
                         hn::MulAdd(hn::Set(d, row[1]), s.dy, hn::Mul(hn::Set(d, row[2]), s.dz)));
          hn::Store(hn::IfThenElseZero(inside, sum), d, out + (a + 1) * num_lanes);
        }
      }
    }
  }
}

/// Pixels of a tile.
void draw_tile(const GridFrame& frame, const Tile& tile, Framebuffer& image) {
  const FlushTinyToZero guard;
  const SampleLayout layout{static_cast<int>(frame.views.size()), frame.gradients, false,
                            num_lanes};
  const Integrator integrator(frame.classifiers, frame.shading, layout);
  SampleBuffer buffer(layout, slab_planes);
  const auto sample =
      frame.views[0].cubic
          ? (frame.gradients ? sample_slab<true, true> : sample_slab<true, false>)
          : (frame.gradients ? sample_slab<false, true> : sample_slab<false, false>);
  constexpr int width = num_lanes >= 8 ? 4 : 2;
  IndexRays index;
  RayState rays;
  for (int py = tile.y; py < tile.y + tile.height; py += num_lanes / width) {
    for (int px = tile.x; px < tile.x + tile.width; px += width) {
      for (int l = 0; l < num_lanes; ++l) {
        start_ray(frame, image, px + l % width, py + l / width, static_cast<std::size_t>(l), index,
                  rays);
      }
      set_range(rays, num_lanes);
      for (SampleIndex k = rays.begin; k <= rays.end; k += slab_planes) {
        const Slab slab{k, std::min(rays.end - k + 1, slab_planes)};
        if (!integrator.zero_shows() &&
            !may_be_seen(frame, index, num_lanes, k, k + slab.count - 1)) {
          continue;
        }
        sample(frame, index, rays, slab, buffer);
        integrator.run(slab, buffer, rays);
      }
      for (int l = 0; l < num_lanes; ++l) {
        const int x = px + l % width, y = py + l / width;
        if (x >= image.width || y >= image.height) continue;
        const float rgba[4] = {rays.r[l], rays.g[l], rays.b[l], rays.a[l]};
        std::copy_n(rgba, 4, image.pixel(x, y));
      }
    }
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace motes
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include <tbb/parallel_for.h>

#include <cassert>

namespace motes {
namespace {

HWY_EXPORT(draw_tile);

ShadingConstants make_shading(const ResolvedScene& scene, const GridFrame& frame) {
  const Lighting& lighting = scene.render.lighting;
  ShadingConstants shading;
  shading.termination_opacity = static_cast<float>(scene.render.termination_opacity);
  shading.ambient = static_cast<float>(lighting.ambient);
  shading.diffuse = static_cast<float>(lighting.diffuse);
  shading.specular = static_cast<float>(lighting.specular);
  shading.shininess = static_cast<float>(lighting.shininess);
  shading.headlight = !lighting.direction.has_value();
  if (lighting.direction) {
    const Vector3d l = normalize(*lighting.direction);
    const Vector3d rows[3] = {frame.axes.x, frame.axes.y, frame.axes.forward};
    for (int a = 0; a < 3; ++a) shading.light[a] = static_cast<float>(dot(l, rows[a]));
  }
  if (!frame.orthographic) {
    shading.max_ray_length = static_cast<float>(std::hypot(1, frame.half_width, frame.half_height));
  }
  // In place of a kernel's radius, which says what gradients are none.
  shading.min_radius.assign(frame.views.size(), 1);
  return shading;
}

GridFrame make_frame(const DrawnGrids& fields, const ResolvedScene& scene) {
  GridFrame frame;
  frame.fields = &fields;
  for (const GridSampler& sampler : fields.samplers()) frame.views.push_back(sampler.view());
  frame.eye = scene.camera.eye;
  frame.axes = camera_axes(scene.camera);
  frame.half_height = half_height(scene.camera);
  frame.half_width = frame.half_height * scene.render.width / scene.render.height;
  frame.step = scene.step_size;
  frame.orthographic = scene.camera.orthographic_height.has_value();
  frame.gradients = scene.render.lighting.enabled;
  for (const TransferFunction& function : scene.transfer_functions) {
    frame.classifiers.push_back(compile_transfer_function(function, 1, scene.step_size));
  }
  frame.shading = make_shading(scene, frame);
  const Vector3d rows[3] = {frame.axes.x, frame.axes.y, frame.axes.forward};
  const Vector3d units[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  for (std::size_t a = 0; a < 3; ++a) {
    for (std::size_t b = 0; b < 3; ++b) {
      const Vector3d world = fields.samplers().front().to_world_gradient(units[b]);
      frame.to_camera[a][b] = static_cast<float>(dot(rows[a], world));
    }
  }
  return frame;
}

}  // namespace

DrawnGrids::DrawnGrids(const std::vector<Grid>& grids, Reconstruction reconstruction,
                       const Bounds3d& box)
    : box_(box) {
  assert(!grids.empty());
  for (const Grid& grid : grids) samplers_.emplace_back(grid, reconstruction);
  for (const GridSampler& sampler : samplers_) macro_cells_.emplace_back(sampler);
}

std::size_t DrawnGrids::num_bytes() const {
  std::size_t bytes = 0;
  for (const GridSampler& sampler : samplers_) bytes += sampler.num_bytes();
  return bytes;
}

void draw_grids(const DrawnGrids& fields, const ResolvedScene& scene, Framebuffer& image) {
  assert(scene.transfer_functions.size() == fields.samplers().size());
  const GridFrame frame = make_frame(fields, scene);
  image = Framebuffer(scene.render.width, scene.render.height);
  constexpr int tile = 32;
  const int columns = (image.width + tile - 1) / tile, rows = (image.height + tile - 1) / tile;
  tbb::parallel_for(0, columns * rows, [&](int i) {
    const int x = i % columns * tile, y = i / columns * tile;
    HWY_DYNAMIC_DISPATCH(draw_tile)
    (frame, {x, y, std::min(tile, image.width - x), std::min(tile, image.height - y)}, image);
  });
}

}  // namespace motes
#endif
