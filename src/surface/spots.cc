#include "surface/spots.h"

#include <algorithm>
#include <cmath>

#include "surface/directions.h"

namespace motes {
namespace {

/// Whether the light that reaches one spot reaches another near it alike: on a flat or smoothly
/// bent piece of surface, not beyond an edge or a step.
inline bool alike(const Spot& a, const Spot& b) {
  constexpr double least_cosine = 0.8, most_slope = 0.35;
  if (!(dot(a.normal, b.normal) > least_cosine)) return false;
  const Vector3d between = b.point.place - a.point.place;
  const double height =
      std::max(std::abs(dot(between, a.normal)), std::abs(dot(between, b.normal)));
  return height * height <= most_slope * most_slope * dot(between, between);
}

/// Whether two spots of a pixel are of one ball, stick or piece of an isosurface: of its level
/// there may be others, one behind the other.
bool of_one(const Spot& a, const Spot& b) {
  if (a.point.particle != b.point.particle || a.point.stick != b.point.stick) return false;
  return a.point.particle != no_particle || alike(a, b);
}

}  // namespace

void Spots::reset(int columns) {
  columns_ = columns;
  spots_.clear();
  begin_.assign(1, 0);
  ranks_.clear();
}

void Spots::add(const Spot& spot, std::uint32_t rank) {
  for (std::size_t s = 0; s < ranks_.size(); ++s) {
    Spot& other = spots_[begin_.back() + s];
    if (!of_one(other, spot)) continue;
    const int num_rays = other.num_rays + 1;
    if (rank < ranks_[s]) {
      other = spot;
      ranks_[s] = rank;
    }
    other.num_rays = num_rays;
    return;
  }
  spots_.push_back(spot);
  ranks_.push_back(rank);
}

std::span<Spot> Spots::end_pixel() {
  ranks_.clear();
  const std::size_t begin = begin_.back();
  begin_.push_back(spots_.size());
  return std::span(spots_).subspan(begin);
}

std::span<const Spot> Spots::of(int x, int y) const {
  const auto pixel = static_cast<std::size_t>(y) * static_cast<std::size_t>(columns_) +
                     static_cast<std::size_t>(x);
  return std::span(spots_).subspan(begin_[pixel], begin_[pixel + 1] - begin_[pixel]);
}

Light Spots::even_light(int x, int y, const Spot& spot) const {
  if (of(x, y).size() > few_spots) return spot.light;
  constexpr int reach = pattern_side / 2;
  float sum = 0;
  Light light{0, {}};
  for (int dy = -reach; dy <= reach; ++dy) {
    for (int dx = -reach; dx <= reach; ++dx) {
      // The outermost ones count half: then each pixel of the pattern counts the same.
      const float half = (std::abs(dx) == reach ? 0.5f : 1) * (std::abs(dy) == reach ? 0.5f : 1);
      for (const Spot& other : of(x + dx, y + dy)) {
        if (&other != &spot && !alike(spot, other)) continue;
        const float weight = half * static_cast<float>(other.num_rays);
        sum += weight;
        light.sky += weight * other.light.sky;
        for (std::size_t l = 0; l < max_lights; ++l) {
          light.lamps[l] += weight * other.light.lamps[l];
        }
      }
    }
  }
  light.sky /= sum;
  for (float& lamp : light.lamps) lamp /= sum;
  return light;
}

}  // namespace motes
