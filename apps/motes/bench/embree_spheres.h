// Embree's sphere geometry, to compare balls with; a program that is built without the library has
// none.
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <span>
#include <string_view>

#include "bvh/bvh.h"
#include "core/vec.h"
#include "surface/trace.h"

namespace motes {

/// RTC_BUILD_QUALITY_LOW, MEDIUM (its default) and HIGH.
enum class EmbreeBuild { low, medium, high };
inline constexpr std::array embree_builds{EmbreeBuild::low, EmbreeBuild::medium, EmbreeBuild::high};
std::string_view name_of(EmbreeBuild build);

/// How rays are handed over: one by one, in packets of 16, or in streams of 64.
enum class EmbreeRays { single, packet, stream };
inline constexpr std::array embree_rays{EmbreeRays::single, EmbreeRays::packet, EmbreeRays::stream};
std::string_view name_of(EmbreeRays rays);

/// A scene of spheres of type RTC_GEOMETRY_TYPE_SPHERE_POINT.
class EmbreeSpheres {
 public:
  virtual ~EmbreeSpheres() = default;
  /// What Embree has allocated for them, and they themselves.
  virtual std::size_t bytes() const = 0;
  /// What motes::trace() does, in single precision, with coherent rays. Width and height of the
  /// grid are multiples of 8.
  virtual void trace(const SurfaceView& view, const RayGrid& grid, EmbreeRays rays,
                     SurfaceHits& hits) const = 0;
  /// How many of 16 rays from a point meet nothing that is farther than `near`: one by one, or else
  /// as one packet.
  virtual int num_unoccluded(const Point3d& from, std::span<const Vector3f> directions, float near,
                             EmbreeRays rays) const = 0;
};

/// Null where there is no Embree; throws Error where it fails. threads: of the build; 0 for all.
std::unique_ptr<EmbreeSpheres> build_embree_spheres(std::span<const Sphere> spheres,
                                                    EmbreeBuild build, int threads);

}  // namespace motes
