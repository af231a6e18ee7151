// Where the pixels of a tile look for light: once for each ball, stick and piece of an isosurface
// that they show.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/vec.h"
#include "scene/scene.h"
#include "surface/trace.h"

namespace motes {

/// How much of the light that could reach a point does, 0 to 1.
struct Light {
  float sky = 1;                                ///< of the ambient light
  std::array<float, max_lights> lamps = all();  ///< of each of the lighting's lights

 private:
  static constexpr std::array<float, max_lights> all() {
    std::array<float, max_lights> lamps;
    lamps.fill(1);
    return lamps;
  }
};

/// A pixel that shows more spots is crowded: what it shows is so small that its spots share its
/// rays to the light, and have nothing around them that they could be evened out with.
inline constexpr std::size_t few_spots = 4;

/// What a pixel shows of one ball, stick or piece of an isosurface.
struct Spot {
  SurfacePoint point;
  Vector3d normal;
  Light light;
  int num_rays = 1;  ///< of the pixel that meet the same
};

/// The spots of a tile's pixels, column by column and row by row.
class Spots {
 public:
  /// Takes back all spots, and begins with the first pixel of so many columns.
  void reset(int columns);
  /// Adds what one of the pixel's rays meets. Of the spots of a ball, a stick or a piece of an
  /// isosurface (those have no particle, and their level as stick) that of the lowest rank is kept.
  /// With ranks by chance it may be any: the first would be at the edge.
  void add(const Spot& spot, std::uint32_t rank);
  /// Goes on to the next pixel; returns the spots of the last.
  std::span<Spot> end_pixel();

  /// The spots of pixel (x, y).
  std::span<const Spot> of(int x, int y) const;
  /// The light of a spot of pixel (x, y), evened out over the pattern of directions: the mean of
  /// the rays around that lie in nearly the same plane; its own if the pixel is crowded. There are
  /// `pattern_side` / 2 pixels on each side of it.
  Light even_light(int x, int y, const Spot& spot) const;

 private:
  int columns_ = 0;
  std::vector<Spot> spots_;
  std::vector<std::size_t> begin_;    ///< of each pixel, and of the one that comes next
  std::vector<std::uint32_t> ranks_;  ///< of the present pixel's spots
};

}  // namespace motes
