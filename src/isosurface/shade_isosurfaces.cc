#include "isosurface/shade_isosurfaces.h"

#include <algorithm>
#include <limits>
#include <span>

#include "surface/directions.h"
#include "surface/light.h"
#include "surface/phong.h"

namespace motes {
namespace {

/// Spots of some levels, and the light of those of the tile's pixels, evened out. The points'
/// `stick` is the level.
struct LitSpots {
  Spots spots;
  std::vector<Light> lights;
  std::vector<std::size_t> begin;  ///< of each pixel's lights
};

/// One tile on its way.
class TileShader {
 public:
  TileShader(const ShadedIsosurfaces& isosurfaces, const Tile& tile)
      : isosurfaces_(isosurfaces),
        light_(isosurfaces.light),
        n_(light_.plane.samples),
        margin_(has_spots(light_.shading) ? pattern_side / 2 : 0),
        tile_(tile),
        grid_(rays_of(light_.plane, tile, margin_)) {
    // Where nothing is opaque nothing hides light.
    std::size_t num_lists = 1;
    bool any_opaque = light_.surface != nullptr;
    for (const FieldIsosurfaces& field : isosurfaces.frame.fields) {
      for (const IsosurfaceLevel& level : field.levels) {
        const bool opaque = level.opacity >= 1;
        any_opaque = any_opaque || opaque;
        if (list_of_level_.size() <= level.number) list_of_level_.resize(level.number + 1);
        list_of_level_[level.number] = opaque ? 0 : num_lists++;
      }
    }
    lit_.resize(any_opaque ? num_lists : 0);
  }

  void run(std::vector<IsosurfaceHit>& out) {
    trace_isosurfaces(isosurfaces_.frame, grid_, hits_);
    begin_.assign(grid_.size() + 1, 0);
    for (const IsosurfaceHit& hit : hits_) ++begin_[hit.ray + 1];
    for (std::size_t i = 1; i < begin_.size(); ++i) begin_[i] += begin_[i - 1];
    if (margin_ != 0) light_spots();
    out.clear();
    const int skipped = n_ * margin_;
    for (int row = 0; row < n_ * tile_.height; ++row) {
      for (int column = 0; column < n_ * tile_.width; ++column) {
        for (IsosurfaceHit hit : hits_of(column + skipped, row + skipped)) {
          shade(column / n_, row / n_, hit);
          hit.ray = static_cast<std::uint32_t>(row * n_ * tile_.width + column);
          out.push_back(hit);
        }
      }
    }
  }

 private:
  std::span<const IsosurfaceHit> hits_of(int column, int row) const {
    const auto ray = static_cast<std::size_t>(row) * static_cast<std::size_t>(grid_.width) +
                     static_cast<std::size_t>(column);
    return std::span(hits_).subspan(begin_[ray], begin_[ray + 1] - begin_[ray]);
  }

  struct Ray {
    Point3d origin;
    Vector3d direction;
  };
  Ray ray_of(const IsosurfaceHit& hit) const {
    const auto width = static_cast<std::uint32_t>(grid_.width);
    const SurfaceView& view = light_.view;
    const Vector3d across =
        (grid_.u + (grid_.column + static_cast<int>(hit.ray % width)) * grid_.du) * view.axes.x +
        (grid_.v + (grid_.row + static_cast<int>(hit.ray / width)) * grid_.dv) * view.axes.y;
    if (view.orthographic) return {view.eye + across, view.axes.forward};
    return {view.eye, view.axes.forward + across};
  }
  SurfacePoint point_of(const IsosurfaceHit& hit) const {
    const Ray ray = ray_of(hit);
    return {ray.origin + hit.depth * ray.direction, no_particle, hit.level};
  }

  /// A spot for each piece of a level that a pixel shows.
  void light_spots() {
    for (LitSpots& lit : lit_) lit.spots.reset(tile_.width + 2 * margin_);
    for (int y = 0; y < tile_.height + 2 * margin_; ++y) {
      for (int x = 0; x < tile_.width + 2 * margin_; ++x) {
        const int number = pattern_number(tile_.x + x - margin_, tile_.y + y - margin_);
        if (!lit_.empty()) add_spots(x, y, number);
        for (LitSpots& lit : lit_) {
          look_for_light(light_, lit.spots.end_pixel(), number, directions_);
        }
      }
    }
    for (LitSpots& lit : lit_) {
      for (int y = 0; y < tile_.height; ++y) {
        for (int x = 0; x < tile_.width; ++x) {
          lit.begin.push_back(lit.lights.size());
          for (const Spot& spot : lit.spots.of(x + margin_, y + margin_)) {
            lit.lights.push_back(lit.spots.even_light(x + margin_, y + margin_, spot));
          }
        }
      }
    }
  }

  /// The spots of the pixel (x, y) of the tile and its margin, which is of that number of the
  /// pattern.
  void add_spots(int x, int y, int number) {
    for (int i = 0; i < n_ * n_; ++i) {
      for (const IsosurfaceHit& hit : hits_of(n_ * x + i % n_, n_ * y + i / n_)) {
        lit_[list_of_level_[hit.level]].spots.add({point_of(hit), Vector3d(hit.normal), {}},
                                                  rank_of(number, i));
      }
    }
  }

  /// Lights a hit of the tile's pixel (x, y).
  void shade(int x, int y, IsosurfaceHit& hit) {
    Light light;
    const Vector3d normal(hit.normal);
    if (!lit_.empty() && margin_ != 0) {
      const LitSpots& lit = lit_[list_of_level_[hit.level]];
      const auto pixel = static_cast<std::size_t>(y) * static_cast<std::size_t>(tile_.width) +
                         static_cast<std::size_t>(x);
      const auto spots = lit.spots.of(x + margin_, y + margin_);
      const Point3d place = point_of(hit).place;
      double nearest = std::numeric_limits<double>::infinity();
      for (std::size_t s = 0; s < spots.size(); ++s) {
        const double distance = length(spots[s].point.place - place);
        if (spots[s].point.stick != hit.level || !(distance < nearest)) continue;
        nearest = distance;
        light = lit.lights[lit.begin[pixel] + s];
      }
    }
    if (!lit_.empty() && has_hard_shadows(light_.shading)) {
      add_hard_shadows(light_, point_of(hit), normal, light, directions_);
    }
    hit.color =
        phong(light_.shading.lighting, hit.color, normal, -unit(ray_of(hit).direction), light);
  }

  const ShadedIsosurfaces& isosurfaces_;
  const SurfaceFrame& light_;
  int n_, margin_;
  Tile tile_;
  RayGrid grid_;
  std::vector<IsosurfaceHit> hits_;
  std::vector<std::size_t> begin_;  ///< of each ray's hits, and the end
  /// Of the opaque levels, and of each translucent one: a pixel shows few spots of each. None where
  /// nothing hides light.
  std::vector<LitSpots> lit_;
  std::vector<std::size_t> list_of_level_;  ///< by its number: of lit_
  std::vector<Vector3f> directions_;
};

}  // namespace

void shade_isosurfaces(const ShadedIsosurfaces& isosurfaces, const Tile& tile,
                       std::vector<IsosurfaceHit>& out) {
  TileShader(isosurfaces, tile).run(out);
}

}  // namespace motes
