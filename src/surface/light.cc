#include "surface/light.h"

#include <algorithm>
#include <limits>
#include <span>

#include "surface/directions.h"

namespace motes {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

bool casts_shadows(const LightSource& light) { return light.direction && light.intensity > 0; }

bool has_shadows(const SurfaceShading& shading) {
  const Lighting& lighting = shading.lighting;
  return shading.shadows && lighting.enabled && std::ranges::any_of(lighting.lights, casts_shadows);
}
bool has_soft_shadows(const SurfaceShading& shading) {
  return has_shadows(shading) && shading.light_radius > 0;
}

/// How many of the directions are free up to `length`, or of what is pruned, `prune_length`; they
/// are left in any state.
int count_free(const SurfaceFrame& frame, SurfacePoint from, const Vector3d& normal, double length,
               double prune_length, std::vector<Vector3f>& directions) {
  if (frame.prune) frame.prune(from.place, normal, prune_length, directions);
  if (frame.surface == nullptr) return static_cast<int>(directions.size());
  if (from.particle == no_particle) from.stick = no_stick;
  return num_unoccluded(*frame.surface, from, directions, length);
}

/// Which of its pixel's rays a spot has; the pixel is of that number of the pattern.
struct Share {
  int number;
  std::size_t spot, num_spots;

  /// Those of the directions that are the spot's: all of the pixel's or, of a crowded pixel, its
  /// share of what few_spots have.
  std::span<const Vector3f> of(std::span<const Vector3f> all) const {
    const std::span<const Vector3f> directions = directions_of(all, number);
    if (num_spots <= few_spots) return directions;
    const std::size_t share = std::max<std::size_t>(few_spots * directions.size() / num_spots, 1);
    return directions.subspan(spot % (directions.size() / share) * share, share);
  }
};

Light light_of(const SurfaceFrame& frame, const Spot& spot, const Share& share,
               std::vector<Vector3f>& scratch) {
  const SurfaceShading& shading = frame.shading;
  const auto free_part = [&](std::size_t count, double length, double prune_length) {
    const int free = count_free(frame, spot.point, spot.normal, length, prune_length, scratch);
    return static_cast<float>(free) / static_cast<float>(count);
  };
  Light light;
  if (shading.occlusion_samples > 0) {
    const Across sides = across(spot.normal);
    const std::span<const Vector3f> directions = share.of(frame.sky);
    scratch.clear();
    for (const Vector3f& direction : directions) {
      const Vector3d d(direction);
      scratch.emplace_back(d.x * sides.x + d.y * sides.y + d.z * spot.normal);
    }
    const double distance = shading.occlusion_distance;
    light.sky = free_part(directions.size(), distance, std::min(distance, frame.prune_distance));
  }
  if (!has_soft_shadows(shading)) return light;
  for (std::size_t l = 0; l < frame.lamps.size(); ++l) {
    if (!casts_shadows(shading.lighting.lights[l])) continue;
    const std::span<const Vector3f> directions = share.of(frame.lamps[l]);
    scratch.clear();
    for (const Vector3f& direction : directions) {
      if (dot(Vector3d(direction), spot.normal) > 0) scratch.push_back(direction);
    }
    light.lamps[l] = free_part(directions.size(), infinity, infinity);
  }
  return light;
}

}  // namespace

bool has_spots(const SurfaceShading& shading) {
  return shading.occlusion_samples > 0 || has_soft_shadows(shading);
}

bool has_hard_shadows(const SurfaceShading& shading) {
  return has_shadows(shading) && !has_soft_shadows(shading);
}

void look_for_light(const SurfaceFrame& frame, std::span<Spot> spots, int number,
                    std::vector<Vector3f>& scratch) {
  for (std::size_t s = 0; s < spots.size(); ++s) {
    spots[s].light = light_of(frame, spots[s], {number, s, spots.size()}, scratch);
  }
}

void add_hard_shadows(const SurfaceFrame& frame, const SurfacePoint& point, const Vector3d& normal,
                      Light& light, std::vector<Vector3f>& scratch) {
  const std::vector<LightSource>& lights = frame.shading.lighting.lights;
  for (std::size_t l = 0; l < lights.size(); ++l) {
    if (!casts_shadows(lights[l])) continue;
    scratch.clear();
    if (dot(*lights[l].direction, normal) > 0) scratch.emplace_back(*lights[l].direction);
    light.lamps[l] =
        static_cast<float>(count_free(frame, point, normal, infinity, infinity, scratch));
  }
}

}  // namespace motes
