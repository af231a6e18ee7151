#include "surface/shade.h"

#include <span>

#include "surface/directions.h"
#include "surface/light.h"
#include "surface/phong.h"
#include "surface/spots.h"

namespace motes {
namespace {

/// One tile on its way.
class TileShader {
 public:
  TileShader(const SurfaceFrame& frame, const Tile& tile)
      : frame_(frame),
        shading_(frame.shading),
        n_(frame.plane.samples),
        margin_(has_spots(shading_) ? pattern_side / 2 : 0),
        tile_(tile) {}

  void run(SurfaceSamples& out) {
    // With a margin over which light is evened out.
    grid_ = rays_of(frame_.plane, tile_, margin_);
    trace(*frame_.surface, frame_.view, grid_, hits_);
    if (has_spots(shading_)) light_spots();
    const auto rays_per_pixel = static_cast<std::size_t>(n_) * static_cast<std::size_t>(n_);
    const std::size_t size = static_cast<std::size_t>(tile_.width) *
                             static_cast<std::size_t>(tile_.height) * rays_per_pixel;
    out.depth.resize(size);
    out.color.resize(size);
    for (int y = 0; y < tile_.height; ++y) {
      for (int x = 0; x < tile_.width; ++x) shade_pixel(x, y, out);
    }
  }

 private:
  /// A ray of the grid, and what it hits.
  struct Ray {
    Point3d origin;
    Vector3d direction;
    SurfaceHit hit;
    SurfacePoint point() const { return {origin + hit.depth * direction, hit.particle, hit.stick}; }
  };
  /// Ray i of pixel (x, y), counted from the tile's first.
  Ray ray_of(int x, int y, int i) const {
    const int column = n_ * (x + margin_) + i % n_, row = n_ * (y + margin_) + i / n_;
    const CameraAxes& axes = frame_.view.axes;
    const Vector3d across = (grid_.u + (grid_.column + column) * grid_.du) * axes.x +
                            (grid_.v + (grid_.row + row) * grid_.dv) * axes.y;
    const SurfaceHit hit =
        hits_[static_cast<std::size_t>(row) * static_cast<std::size_t>(grid_.width) +
              static_cast<std::size_t>(column)];
    if (frame_.view.orthographic) return {frame_.view.eye + across, axes.forward, hit};
    return {frame_.view.eye, axes.forward + across, hit};
  }

  /// Finds the spots and their light.
  void light_spots() {
    spots_.reset(tile_.width + 2 * margin_);
    for (int y = -margin_; y < tile_.height + margin_; ++y) {
      for (int x = -margin_; x < tile_.width + margin_; ++x) {
        const int number = pattern_number(tile_.x + x, tile_.y + y);
        for (int i = 0; i < n_ * n_; ++i) {
          const Ray ray = ray_of(x, y, i);
          if (!ray.hit.any()) continue;
          spots_.add({ray.point(), Vector3d(ray.hit.normal), {}}, rank_of(number, i));
        }
        look_for_light(frame_, spots_.end_pixel(), number, directions_);
      }
    }
  }

  void shade_pixel(int x, int y, SurfaceSamples& out) {
    std::span<const Spot> spots;
    lights_.clear();
    if (has_spots(shading_)) {
      spots = spots_.of(x + margin_, y + margin_);
      for (const Spot& spot : spots) {
        lights_.push_back(spots_.even_light(x + margin_, y + margin_, spot));
      }
    }
    for (int i = 0; i < n_ * n_; ++i) {
      const Ray ray = ray_of(x, y, i);
      const auto at =
          static_cast<std::size_t>(n_ * y + i / n_) * static_cast<std::size_t>(n_ * tile_.width) +
          static_cast<std::size_t>(n_ * x + i % n_);
      out.depth[at] = ray.hit.depth;
      out.color[at] = {};
      if (!ray.hit.any()) continue;
      Light light;
      for (std::size_t s = 0; s < spots.size(); ++s) {
        const SurfacePoint& point = spots[s].point;
        if (point.particle == ray.hit.particle && point.stick == ray.hit.stick) light = lights_[s];
      }
      if (has_hard_shadows(shading_)) {
        add_hard_shadows(frame_, ray.point(), Vector3d(ray.hit.normal), light, directions_);
      }
      out.color[at] = phong(shading_.lighting, frame_.colors->of(ray.hit.particle),
                            Vector3d(ray.hit.normal), -unit(ray.direction), light);
    }
  }

  const SurfaceFrame& frame_;
  const SurfaceShading& shading_;
  int n_, margin_;
  Tile tile_;
  RayGrid grid_;
  SurfaceHits hits_;
  Spots spots_;
  std::vector<Vector3f> directions_;
  std::vector<Light> lights_;  ///< of a pixel's spots
};

}  // namespace

RayGrid rays_of(const ImagePlane& plane, const Tile& tile, int margin) {
  const int n = plane.samples;
  RayGrid grid;
  grid.du = 2 * plane.half_width / (plane.width * n);
  grid.dv = -2 * plane.half_height / (plane.height * n);
  grid.u = 0.5 * grid.du - plane.half_width;
  grid.v = 0.5 * grid.dv + plane.half_height;
  grid.column = n * (tile.x - margin);
  grid.row = n * (tile.y - margin);
  grid.width = n * (tile.width + 2 * margin);
  grid.height = n * (tile.height + 2 * margin);
  return grid;
}

SurfaceFrame make_surface_frame(const Surface& surface, const SurfaceView& view,
                                const ImagePlane& plane, const SurfaceShading& shading) {
  SurfaceFrame frame = make_light_frame(view, plane, shading);
  frame.surface = &surface;
  frame.colors = &surface.colors;
  return frame;
}

SurfaceFrame make_light_frame(const SurfaceView& view, const ImagePlane& plane,
                              const SurfaceShading& shading) {
  SurfaceFrame frame{nullptr, nullptr, view, plane, shading, {}, {}, {}};
  frame.sky = cosine_directions(shading.occlusion_samples, shading.seed);
  for (LightSource& light : frame.shading.lighting.lights) {
    std::vector<Vector3f>& lamp = frame.lamps.emplace_back();
    if (!light.direction) continue;
    light.direction = normalize(*light.direction);
    lamp = cone_directions(shading.shadow_samples, *light.direction, shading.light_radius,
                           shading.seed);
  }
  return frame;
}

void render_surface(const SurfaceFrame& frame, const Tile& tile, SurfaceSamples& out) {
  TileShader(frame, tile).run(out);
}

}  // namespace motes
