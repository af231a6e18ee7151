// Where the pixels of a tile look for light: once for each ball and stick that they show.
#pragma once

#include <array>
#include <cstddef>
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

/// What a pixel shows of one ball or stick.
struct Spot {
  SurfacePoint point;
  Vector3d normal;
  Light light;
};

/// The spots of a tile's pixels, column by column and row by row.
class Spots {
 public:
  /// Takes back all spots, and begins with the first pixel of so many columns.
  void reset(int columns);
  /// Adds a spot to the pixel, unless that has one of the same ball or stick.
  void add(const Spot& spot);
  /// Goes on to the next pixel; returns the spots of the last.
  std::span<Spot> end_pixel();

  /// The spots of pixel (x, y).
  std::span<const Spot> of(int x, int y) const;
  /// The light of a spot of pixel (x, y), evened out over the pattern of directions: the mean of
  /// those around that lie in nearly the same plane; its own if the pixel is crowded. There are
  /// `pattern_side` / 2 pixels on each side of it.
  Light even_light(int x, int y, const Spot& spot) const;

 private:
  int columns_ = 0;
  std::vector<Spot> spots_;
  std::vector<std::size_t> begin_;  ///< of each pixel, and of the one that comes next
};

}  // namespace motes
