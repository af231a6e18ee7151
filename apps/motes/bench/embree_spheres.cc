// Calls rtcIntersect and rtcOccluded as Embree's manual advises for speed: packets of neighbouring
// pixels, told to be coherent, with denormals flushed.
#include "motes/bench/embree_spheres.h"

#include <embree3/rtcore.h>
#include <fmt/format.h>
#include <tbb/parallel_for.h>
#include <xmmintrin.h>

#include <array>
#include <atomic>
#include <cmath>
#include <limits>

#include "core/error.h"

namespace motes {
namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();
constexpr unsigned none = RTC_INVALID_GEOMETRY_ID;

class FlushTinyToZero {
 public:
  FlushTinyToZero() : saved_(_mm_getcsr()) { _mm_setcsr(saved_ | 0x8040); }
  ~FlushTinyToZero() { _mm_setcsr(saved_); }
  FlushTinyToZero(const FlushTinyToZero&) = delete;
  FlushTinyToZero& operator=(const FlushTinyToZero&) = delete;

 private:
  unsigned saved_;
};

/// A view in single precision.
struct FloatView {
  Vector3f x, y, forward;
  Point3f eye;
  bool orthographic;

  explicit FloatView(const SurfaceView& view)
      : x(view.axes.x),
        y(view.axes.y),
        forward(view.axes.forward),
        eye(view.eye),
        orthographic(view.orthographic) {}
};

// The loops over packets become vectors, of the widest that the machine has, as Motes' own are.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
#define MOTES_WIDEST_VECTORS \
  __attribute__((target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")))
#else
#define MOTES_WIDEST_VECTORS
#endif

constexpr int packet_size = 16, packet_side = 4;

/// The rays of a block of pixels, from (column, row) of the grid on.
MOTES_WIDEST_VECTORS
void set_up(const FloatView& view, const RayGrid& grid, int column, int row, RTCRayHit16& out) {
  for (int l = 0; l < packet_size; ++l) {
    const int i = grid.column + column + l % packet_side, j = grid.row + row + l / packet_side;
    const auto u = static_cast<float>(grid.u + i * grid.du);
    const auto v = static_cast<float>(grid.v + j * grid.dv);
    const float x = view.orthographic ? u : 0, y = view.orthographic ? v : 0;
    const float slope_x = u - x, slope_y = v - y;
    out.ray.org_x[l] = view.eye.x + x * view.x.x + y * view.y.x;
    out.ray.org_y[l] = view.eye.y + x * view.x.y + y * view.y.y;
    out.ray.org_z[l] = view.eye.z + x * view.x.z + y * view.y.z;
    out.ray.dir_x[l] = view.forward.x + slope_x * view.x.x + slope_y * view.y.x;
    out.ray.dir_y[l] = view.forward.y + slope_x * view.x.y + slope_y * view.y.y;
    out.ray.dir_z[l] = view.forward.z + slope_x * view.x.z + slope_y * view.y.z;
    out.ray.tnear[l] = 0;
    out.ray.tfar[l] = infinity;
    out.ray.mask[l] = ~0u;
    out.ray.time[l] = 0;
    out.ray.flags[l] = 0;
    out.hit.geomID[l] = none;
    out.hit.instID[0][l] = none;
  }
}

/// Gives the normals of hits their length, and those of rays that hit nothing none.
MOTES_WIDEST_VECTORS
void finish_normals(RTCHit16& hit) {
  for (int l = 0; l < packet_size; ++l) {
    const float x = hit.Ng_x[l], y = hit.Ng_y[l], z = hit.Ng_z[l];
    const float scale = hit.geomID[l] == none ? 0 : 1 / std::sqrt(x * x + y * y + z * z);
    hit.Ng_x[l] = hit.geomID[l] == none ? 0 : x * scale;
    hit.Ng_y[l] = hit.geomID[l] == none ? 0 : y * scale;
    hit.Ng_z[l] = hit.geomID[l] == none ? 0 : z * scale;
  }
}

/// Ray `lane` of a packet on its own.
RTCRayHit single_ray(const RTCRayHit16& packet, int lane) {
  RTCRayHit out;
  out.ray = rtcGetRayFromRayN(const_cast<RTCRayN*>(reinterpret_cast<const RTCRayN*>(&packet.ray)),
                              packet_size, static_cast<unsigned>(lane));
  out.hit.geomID = none;
  out.hit.instID[0] = none;
  return out;
}

void put_back(const RTCRayHit& single, int lane, RTCRayHit16& packet) {
  packet.ray.tfar[lane] = single.ray.tfar;
  packet.hit.geomID[lane] = single.hit.geomID;
  packet.hit.primID[lane] = single.hit.primID;
  packet.hit.Ng_x[lane] = single.hit.Ng_x;
  packet.hit.Ng_y[lane] = single.hit.Ng_y;
  packet.hit.Ng_z[lane] = single.hit.Ng_z;
}

RTCIntersectContext make_context(RTCIntersectContextFlags flags) {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = flags;
  return context;
}

alignas(64) constexpr std::array<int, packet_size> all_valid = [] {
  std::array<int, packet_size> valid{};
  valid.fill(-1);
  return valid;
}();

class Spheres final : public EmbreeSpheres {
 public:
  Spheres(std::span<const Sphere> spheres, EmbreeBuild build, int threads)
      : device_(rtcNewDevice(threads > 0 ? fmt::format("threads={}", threads).c_str() : nullptr)) {
    if (device_ == nullptr) fail();
    rtcSetDeviceMemoryMonitorFunction(device_, count_bytes, &bytes_);
    scene_ = rtcNewScene(device_);
    rtcSetSceneBuildQuality(scene_, build == EmbreeBuild::low      ? RTC_BUILD_QUALITY_LOW
                                    : build == EmbreeBuild::medium ? RTC_BUILD_QUALITY_MEDIUM
                                                                   : RTC_BUILD_QUALITY_HIGH);
    const RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_SPHERE_POINT);
    static_assert(sizeof(Sphere) == 4 * sizeof(float));
    auto* const vertices = static_cast<Sphere*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4, sizeof(Sphere), spheres.size()));
    if (vertices == nullptr) fail();
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, spheres.size(), 1 << 14),
                      [&](const auto& range) {
                        for (std::size_t i = range.begin(); i != range.end(); ++i) {
                          vertices[i] = spheres[i];
                        }
                      });
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene_, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene_);
    if (rtcGetDeviceError(device_) != RTC_ERROR_NONE) fail();
  }
  Spheres(const Spheres&) = delete;
  Spheres& operator=(const Spheres&) = delete;
  ~Spheres() override {
    rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
  }

  std::size_t bytes() const override { return static_cast<std::size_t>(bytes_.load()); }

  void trace(const SurfaceView& view, const RayGrid& grid, EmbreeRays rays,
             SurfaceHits& hits) const override {
    const FlushTinyToZero guard;
    const FloatView float_view(view);
    RTCIntersectContext context = make_context(RTC_INTERSECT_CONTEXT_FLAG_COHERENT);
    hits.resize(grid.size());
    // Blocks of 8 x 8 pixels: four packets, or one stream.
    std::array<RTCRayHit16, 4> packets;
    for (int row = 0; row < grid.height; row += 2 * packet_side) {
      for (int column = 0; column < grid.width; column += 2 * packet_side) {
        for (int i = 0; i < 4; ++i) {
          set_up(float_view, grid, column + i % 2 * packet_side, row + i / 2 * packet_side,
                 packets[static_cast<std::size_t>(i)]);
        }
        intersect(packets, rays, context);
        for (int i = 0; i < 4; ++i) {
          RTCRayHit16& packet = packets[static_cast<std::size_t>(i)];
          finish_normals(packet.hit);
          store(packet, grid, column + i % 2 * packet_side, row + i / 2 * packet_side, hits);
        }
      }
    }
  }

  int num_unoccluded(const Point3d& from, std::span<const Vector3f> directions, float near,
                     EmbreeRays rays) const override {
    const FlushTinyToZero guard;
    RTCIntersectContext context = make_context(RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT);
    const Point3f origin(from);
    if (rays == EmbreeRays::single) {
      int count = 0;
      for (const Vector3f& d : directions) {
        RTCRay ray{origin.x, origin.y, origin.z, near, d.x, d.y, d.z, 0, infinity, ~0u, 0, 0};
        rtcOccluded1(scene_, &context, &ray);
        count += ray.tfar > 0 ? 1 : 0;
      }
      return count;
    }
    RTCRay16 packet;
    for (int l = 0; l < packet_size; ++l) {
      const Vector3f& d = directions[static_cast<std::size_t>(l)];
      packet.org_x[l] = origin.x;
      packet.org_y[l] = origin.y;
      packet.org_z[l] = origin.z;
      packet.dir_x[l] = d.x;
      packet.dir_y[l] = d.y;
      packet.dir_z[l] = d.z;
      packet.tnear[l] = near;
      packet.tfar[l] = infinity;
      packet.mask[l] = ~0u;
      packet.time[l] = 0;
      packet.flags[l] = 0;
    }
    rtcOccluded16(all_valid.data(), scene_, &context, &packet);
    int count = 0;
    for (const float far : packet.tfar) count += far > 0 ? 1 : 0;
    return count;
  }

 private:
  static bool count_bytes(void* counter, ssize_t bytes, bool) {
    *static_cast<std::atomic<ssize_t>*>(counter) += bytes;
    return true;
  }

  [[noreturn]] void fail() const {
    throw Error(
        fmt::format("Embree failed with error {}", static_cast<int>(rtcGetDeviceError(device_))));
  }

  void intersect(std::array<RTCRayHit16, 4>& packets, EmbreeRays rays,
                 RTCIntersectContext& context) const {
    if (rays == EmbreeRays::packet) {
      for (RTCRayHit16& packet : packets) {
        rtcIntersect16(all_valid.data(), scene_, &context, &packet);
      }
      return;
    }
    std::array<RTCRayHit, std::size_t{4} * packet_size> singles;
    for (std::size_t i = 0; i < singles.size(); ++i) {
      singles[i] = single_ray(packets[i / packet_size], static_cast<int>(i % packet_size));
    }
    if (rays == EmbreeRays::stream) {
      rtcIntersect1M(scene_, &context, singles.data(), singles.size(), sizeof(RTCRayHit));
    } else {
      for (RTCRayHit& single : singles) rtcIntersect1(scene_, &context, &single);
    }
    for (std::size_t i = 0; i < singles.size(); ++i) {
      put_back(singles[i], static_cast<int>(i % packet_size), packets[i / packet_size]);
    }
  }

  static void store(const RTCRayHit16& packet, const RayGrid& grid, int column, int row,
                    SurfaceHits& hits) {
    for (int l = 0; l < packet_size; ++l) {
      const auto at =
          static_cast<std::size_t>(row + l / packet_side) * static_cast<std::size_t>(grid.width) +
          static_cast<std::size_t>(column + l % packet_side);
      const bool any = packet.hit.geomID[l] != none;
      hits.depth[at] = packet.ray.tfar[l];
      hits.particle[at] = any ? packet.hit.primID[l] : no_particle;
      hits.stick[at] = no_stick;
      hits.normal_x[at] = packet.hit.Ng_x[l];
      hits.normal_y[at] = packet.hit.Ng_y[l];
      hits.normal_z[at] = packet.hit.Ng_z[l];
    }
  }

  RTCDevice device_;
  RTCScene scene_ = nullptr;
  std::atomic<ssize_t> bytes_{0};
};

}  // namespace

std::string_view name_of(EmbreeBuild build) {
  return build == EmbreeBuild::low ? "low" : build == EmbreeBuild::medium ? "medium" : "high";
}

std::string_view name_of(EmbreeRays rays) {
  return rays == EmbreeRays::single ? "single" : rays == EmbreeRays::packet ? "packets" : "streams";
}

std::unique_ptr<EmbreeSpheres> build_embree_spheres(std::span<const Sphere> spheres,
                                                    EmbreeBuild build, int threads) {
  return std::make_unique<Spheres>(spheres, build, threads);
}

}  // namespace motes
