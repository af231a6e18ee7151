// Surfaces that rays meet on their way through the volume: the contract between what finds them and
// pass 2. Layout only. Lengths are internal (KernelSet::length_scale).
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <iterator>
#include <limits>
#include <span>
#include <vector>

#include "core/aligned.h"
#include "core/color.h"
#include "samples/samples.h"

namespace motes {

/// A piece of surface in the way of a pixel's ray.
struct Layer {
  double depth = 0;   ///< along the view, from the eye
  float opacity = 1;  ///< share of what comes from behind that it keeps away
  Color color;        ///< not weighted by the opacity
};

/// The layers of a tile's pixels, from the front.
struct TileLayers {
  int width = 0;                     ///< pixels of a row
  std::vector<std::uint32_t> begin;  ///< into `layers`; one a pixel, row by row, and the end
  std::vector<Layer> layers;

  std::span<const Layer> of(int column, int row) const {
    const auto pixel = static_cast<std::size_t>(row) * static_cast<std::size_t>(width) +
                       static_cast<std::size_t>(column);
    return std::span(layers).subspan(begin[pixel], begin[pixel + 1] - begin[pixel]);
  }
};

/// Sets the layers of a tile's pixels. Called by many threads at once.
using LayerSource = std::function<void(const Tile&, TileLayers&)>;

/// Those of a block's rays, [layer][lane], with their places among the samples: sample k stands for
/// depths (first + k) step to (first + k + 1) step of its SamplePlanes.
struct BlockLayers {
  int most = 0;                           ///< of a ray
  AlignedVector<float> sample, fraction;  ///< whole number, and the rest; infinite behind the last
  AlignedVector<float> opacity, r, g, b;
  alignas(64) std::int32_t next[max_lanes] = {};  ///< layer that the ray meets next

  /// Makes all rays have none; `most_of_a_ray` may be set then.
  void clear(int most_of_a_ray) {
    most = most_of_a_ray;
    const std::size_t size = static_cast<std::size_t>(most + 1) * max_lanes;
    sample.assign(size, std::numeric_limits<float>::infinity());
    for (auto* array : {&fraction, &opacity, &r, &g, &b}) array->assign(size, 0.0f);
    std::fill(std::begin(next), std::end(next), 0);
  }

  void set(int lane, std::span<const Layer> layers, const SamplePlanes& planes) {
    auto i = static_cast<std::size_t>(lane);
    for (const Layer& layer : layers) {
      const double place =
          std::max(layer.depth / planes.step - static_cast<double>(planes.first), 0.0);
      sample[i] = static_cast<float>(std::floor(place));
      fraction[i] = static_cast<float>(place - std::floor(place));
      opacity[i] = layer.opacity;
      r[i] = layer.color.r;
      g[i] = layer.color.g;
      b[i] = layer.color.b;
      i += max_lanes;
    }
  }

  /// Sample in which the ray meets the first layer that lets nothing through; infinite if none.
  float end_of(int lane) const {
    for (auto i = static_cast<std::size_t>(lane); i < sample.size(); i += max_lanes) {
      if (opacity[i] >= 1) return sample[i];
    }
    return std::numeric_limits<float>::infinity();
  }
};

}  // namespace motes
