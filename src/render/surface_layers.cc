#include "render/surface_layers.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

namespace motes {
namespace {

/// What one ray of a pixel meets.
struct Hit {
  double depth;
  Color color;
  float opacity;
  std::size_t ray;  ///< of the pixel's
};

/// Hits from the front as layers. light[r]: what of the light from behind comes to ray r of the
/// pixel, 1 at first. A layer keeps away what its hits do of what the rays still see.
void add_layers(const std::vector<Hit>& hits, double thickness, std::vector<float>& light,
                std::vector<Layer>& out) {
  auto open = static_cast<float>(light.size());  // the sum of light
  for (std::size_t i = 0; i < hits.size() && open > 0;) {
    const double front = hits[i].depth;
    Layer layer;
    float kept = 0;
    for (; i < hits.size() && hits[i].depth <= front + thickness; ++i) {
      const Hit& hit = hits[i];
      const float weight = light[hit.ray] * hit.opacity;
      light[hit.ray] -= weight;
      kept += weight;
      layer.depth += static_cast<double>(weight) * hit.depth;
      layer.color.r += weight * hit.color.r;
      layer.color.g += weight * hit.color.g;
      layer.color.b += weight * hit.color.b;
    }
    if (!(kept > 0)) continue;
    layer.depth /= static_cast<double>(kept);
    layer.color = {layer.color.r / kept, layer.color.g / kept, layer.color.b / kept};
    layer.opacity = std::min(kept / open, 1.0F);
    open = std::accumulate(light.begin(), light.end(), 0.0F);
    out.push_back(layer);
  }
}

/// Hits of all rays of a tile, solids' and isosurfaces'.
class TileHits {
 public:
  void find(const FrameSurfaces& surfaces, const Tile& tile) {
    solid_.depth.clear();
    crossings_.clear();
    if (surfaces.solids != nullptr) {
      render_surface(*surfaces.solids, tile, solid_);
      n_ = surfaces.solids->plane.samples;
    }
    if (surfaces.isosurfaces != nullptr) {
      shade_isosurfaces(*surfaces.isosurfaces, tile, crossings_);
      n_ = surfaces.isosurfaces->light.plane.samples;
    }
    width_ = static_cast<std::size_t>(n_) * static_cast<std::size_t>(tile.width);
    begin_.assign(width_ * static_cast<std::size_t>(n_) * static_cast<std::size_t>(tile.height) + 1,
                  0);
    for (const IsosurfaceHit& hit : crossings_) ++begin_[hit.ray + 1];
    std::partial_sum(begin_.begin(), begin_.end(), begin_.begin());
  }

  std::size_t rays_per_pixel() const {
    return static_cast<std::size_t>(n_) * static_cast<std::size_t>(n_);
  }

  /// Those of pixel (x, y), from the front.
  void take(int x, int y, std::vector<Hit>& out) const {
    out.clear();
    for (int k = 0; k < n_ * n_; ++k) {
      const int row = y * n_ + k / n_, column = x * n_ + k % n_;
      const auto i = static_cast<std::size_t>(row) * width_ + static_cast<std::size_t>(column);
      const auto ray = static_cast<std::size_t>(k);
      if (!solid_.depth.empty() && std::isfinite(solid_.depth[i])) {
        out.push_back({solid_.depth[i], solid_.color[i], 1, ray});
      }
      for (std::size_t c = begin_[i]; c < begin_[i + 1]; ++c) {
        out.push_back({crossings_[c].depth, crossings_[c].color, crossings_[c].opacity, ray});
      }
    }
    std::stable_sort(out.begin(), out.end(),
                     [](const Hit& a, const Hit& b) { return a.depth < b.depth; });
  }

 private:
  int n_ = 1;
  std::size_t width_ = 0;  ///< rays of a row
  SurfaceSamples solid_;
  std::vector<IsosurfaceHit> crossings_;
  std::vector<std::size_t> begin_;  ///< of each ray's crossings, and the end
};

}  // namespace

void find_layers(const FrameSurfaces& surfaces, double thickness, const Tile& tile,
                 TileLayers& out) {
  static thread_local TileHits tile_hits;
  static thread_local std::vector<Hit> hits;
  static thread_local std::vector<float> light;
  tile_hits.find(surfaces, tile);
  out.width = tile.width;
  out.layers.clear();
  out.begin.assign(1, 0);
  for (int y = 0; y < tile.height; ++y) {
    for (int x = 0; x < tile.width; ++x) {
      tile_hits.take(x, y, hits);
      light.assign(tile_hits.rays_per_pixel(), 1);
      add_layers(hits, thickness, light, out.layers);
      out.begin.push_back(static_cast<std::uint32_t>(out.layers.size()));
    }
  }
}

void composite_layers(const TileLayers& layers, const Tile& tile, Framebuffer& image) {
  for (int y = 0; y < tile.height; ++y) {
    for (int x = 0; x < tile.width; ++x) {
      float* const rgba = image.pixel(tile.x + x, tile.y + y);
      std::fill_n(rgba, 4, 0.0f);
      for (const Layer& layer : layers.of(x, y)) {
        const float weight = (1 - rgba[3]) * layer.opacity;
        rgba[0] += weight * layer.color.r;
        rgba[1] += weight * layer.color.g;
        rgba[2] += weight * layer.color.b;
        rgba[3] += weight;
      }
    }
  }
}

}  // namespace motes
