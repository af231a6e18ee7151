#include "render/surface_layers.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace motes {
namespace {

/// What one ray of a pixel meets.
struct Hit {
  double depth;
  Color color;
};

/// Hits from the front, of `num_rays` rays, as layers. A ray that has met its own meets no more: of
/// k hits after i others each is a k-th of what the num_rays - i rays that are left see.
void add_layers(const std::vector<Hit>& hits, std::size_t num_rays, double thickness,
                std::vector<Layer>& out) {
  for (std::size_t i = 0; i < hits.size();) {
    std::size_t end = i;
    Layer layer;
    while (end < hits.size() && hits[end].depth <= hits[i].depth + thickness) {
      layer.depth += hits[end].depth;
      layer.color.r += hits[end].color.r;
      layer.color.g += hits[end].color.g;
      layer.color.b += hits[end].color.b;
      ++end;
    }
    const auto count = static_cast<float>(end - i);
    layer.depth /= count;
    layer.color = {layer.color.r / count, layer.color.g / count, layer.color.b / count};
    layer.opacity = count / static_cast<float>(num_rays - i);
    out.push_back(layer);
    i = end;
  }
}

}  // namespace

void find_layers(const SurfaceFrame& frame, double thickness, const Tile& tile, TileLayers& out) {
  static thread_local SurfaceSamples samples;
  static thread_local std::vector<Hit> hits;
  render_surface(frame, tile, samples);
  const int n = frame.plane.samples;
  const auto num_rays = static_cast<std::size_t>(n) * static_cast<std::size_t>(n);
  out.width = tile.width;
  out.layers.clear();
  out.begin.assign(1, 0);
  for (int y = 0; y < tile.height; ++y) {
    for (int x = 0; x < tile.width; ++x) {
      hits.clear();
      for (int k = 0; k < n * n; ++k) {
        const int row = y * n + k / n, column = x * n + k % n;
        const auto i = static_cast<std::size_t>(row) * static_cast<std::size_t>(n * tile.width) +
                       static_cast<std::size_t>(column);
        if (std::isfinite(samples.depth[i])) hits.push_back({samples.depth[i], samples.color[i]});
      }
      std::stable_sort(hits.begin(), hits.end(),
                       [](const Hit& a, const Hit& b) { return a.depth < b.depth; });
      add_layers(hits, num_rays, thickness, out.layers);
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
