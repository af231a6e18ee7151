// Rays in all directions from a point on a surface: which of them meet an isosurface nearby.
// Included once per instruction set.
#if defined(MOTES_ISOSURFACE_OCCLUSION_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MOTES_ISOSURFACE_OCCLUSION_INL_H_
#undef MOTES_ISOSURFACE_OCCLUSION_INL_H_
#else
#define MOTES_ISOSURFACE_OCCLUSION_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "isosurface/isosurface.h"
#include "isosurface/local_kernels-inl.h"

HWY_BEFORE_NAMESPACE();
namespace motes {
namespace HWY_NAMESPACE {

/// Which children of a node may have a kernel that reaches within `length` of p.
HWY_INLINE unsigned children_within(const Bvh::Node& node, const Point3f& p, float length,
                                    float support_factor) {
  const hn::CappedTag<float, Bvh::width> d;
  using V = hn::Vec<decltype(d)>;
  unsigned hits = 0;
  for (std::size_t c = 0; c < Bvh::width; c += hn::Lanes(d)) {
    const auto outside = [&](float x, const float* min, const float* max) HWY_ATTR {
      const V below = hn::Sub(hn::Load(d, min + c), hn::Set(d, x));
      const V above = hn::Sub(hn::Set(d, x), hn::Load(d, max + c));
      return hn::Max(hn::Zero(d), hn::Max(below, above));
    };
    const V x = outside(p.x, node.min_x, node.max_x);
    const V y = outside(p.y, node.min_y, node.max_y);
    const V z = outside(p.z, node.min_z, node.max_z);
    const V square = hn::MulAdd(x, x, hn::MulAdd(y, y, hn::Mul(z, z)));
    const V reach = hn::MulAdd(hn::Set(d, support_factor), hn::Load(d, node.max_radius + c),
                               hn::Set(d, 1.00001f * length));
    hits |= mask_bits(d, hn::Le(square, hn::Mul(reach, reach))) << c;
  }
  return hits;
}

/// The surroundings of a point in one field. One at a time on a thread.
class Surroundings {
 public:
  static constexpr bool has_faces = false;

  Surroundings(const KernelSet& kernels, const SamplingConstants& constants, std::size_t f,
               const Point3d& start)
      : kernels_(kernels), constants_(constants), f_(f), start_(start), local_(scratch()) {
    with_shape(constants, f, [&](const auto& shape) { distance_scale_ = shape.distance_scale; });
    for (int a = 0; a < 3; ++a) {
      start_high_[a] = static_cast<float>(start[a]);
      start_low_[a] = static_cast<float>(start[a] - static_cast<double>(start_high_[a]));
    }
  }

  /// Takes directions, of which the first `count` lanes matter.
  void look_along(const float (&directions)[3][max_lanes], std::size_t count) {
    std::copy_n(&directions[0][0], 3 * max_lanes, &directions_[0][0]);
    middle_ = {};
    for (std::size_t l = 0; l < count; ++l) middle_ = middle_ + direction(l);
    middle_ = middle_ / static_cast<double>(count);
    spread_ = 0;
    for (std::size_t l = 0; l < count; ++l) {
      spread_ = std::max(spread_, length(direction(l) - middle_));
    }
  }

  /// Finds the kernels that reach the lanes' rays between two distances.
  void enter(float near, float far) {
    const double middle = 0.5 * (static_cast<double>(near) + static_cast<double>(far));
    // From the middle's place to those of a lane: across at `far`, and along it.
    const double radius = static_cast<double>(far) * spread_ +
                          0.5 * static_cast<double>(far - near) * motes::length(middle_);
    if (radius < static_cast<double>(far)) {
      gather(start_ + middle * middle_, static_cast<float>(1.00001 * radius));
    } else {
      gather(start_, far);
    }
  }

  /// The field at a distance from the point along the lanes' directions.
  HWY_NOINLINE Lanes evaluate(float distance) const {
    const LaneTag d;
    const Lanes t = hn::Set(d, distance);
    const Lanes x = hn::Mul(t, hn::Load(d, directions_[0]));
    const Lanes y = hn::Mul(t, hn::Load(d, directions_[1]));
    const Lanes z = hn::Mul(t, hn::Load(d, directions_[2]));
    Lanes sum = hn::Zero(d);
    with_shape(constants_, f_, [&](const auto& shape) HWY_ATTR {
      const LocalKernels& local = local_.kernels;
      for (std::size_t i = 0; i < local.size; ++i) {
        if (std::abs(local_.distance[i] - distance) > local.support[i]) continue;
        const Lanes dx = hn::Sub(x, hn::Set(d, local.x[i]));
        const Lanes dy = hn::Sub(y, hn::Set(d, local.y[i]));
        const Lanes dz = hn::Sub(z, hn::Set(d, local.z[i]));
        const Lanes square = hn::MulAdd(dx, dx, hn::MulAdd(dy, dy, hn::Mul(dz, dz)));
        const auto phi = shape.template at<false>(d, hn::Mul(square, hn::Set(d, local.scale[i])));
        sum = hn::MulAdd(hn::Set(d, local.peak[i]), phi.value, sum);
      }
    });
    return sum;
  }

 private:
  /// Kernels around the point, and how far their centres are from it.
  struct Local {
    LocalKernels kernels;
    std::vector<float> distance;
  };
  /// Memory that one point leaves to the next: there is one for each pixel.
  static Local& scratch() {
    static thread_local Local local;
    return local;
  }

  Vector3d direction(std::size_t lane) const {
    return {directions_[0][lane], directions_[1][lane], directions_[2][lane]};
  }
  /// Finds the kernels that reach within `length` of p.
  void gather(const Point3d& p, float length) {
    if (p == gathered_ && length == gathered_length_) return;
    gathered_ = p;
    gathered_length_ = length;
    const float factor = constants_.fields[f_].support_factor;
    const Point3f near(static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z));
    const Vector3f around(p - start_);
    local_.kernels.size = 0;
    local_.distance.clear();
    traverse(
        kernels_.bvh,
        [&](const Bvh::Node& node) { return children_within(node, near, length, factor); },
        [&](std::size_t leaf) { add_leaf(leaf, around, length); });
  }

  void add_leaf(std::size_t leaf, const Vector3f& around, float length) {
    const LaneTag d;
    const FieldConstants& field = constants_.fields[f_];
    LocalKernels& local = local_.kernels;
    local.reserve(Bvh::leaf_size);
    for (std::size_t i = 0; i < Bvh::leaf_size; i += hn::Lanes(d)) {
      const std::size_t begin = leaf * Bvh::leaf_size + i;
      Lanes from_start[3];
      Lanes square = hn::Zero(d), from_middle_sq = hn::Zero(d);
      const float* const centers[3] = {&kernels_.x[begin], &kernels_.y[begin], &kernels_.z[begin]};
      for (int a = 0; a < 3; ++a) {
        // In two steps: what is near is told apart to the last digit.
        from_start[a] = hn::Sub(hn::Sub(hn::Load(d, centers[a]), hn::Set(d, start_high_[a])),
                                hn::Set(d, start_low_[a]));
        const Lanes from_middle = hn::Sub(from_start[a], hn::Set(d, around[a]));
        square = hn::MulAdd(from_start[a], from_start[a], square);
        from_middle_sq = hn::MulAdd(from_middle, from_middle, from_middle_sq);
      }
      const Lanes radius = hn::Load(d, kernels_.radius.from(begin));
      const Lanes support = hn::Mul(radius, hn::Set(d, 1.00001f * field.support_factor));
      const Lanes reach = hn::Add(support, hn::Set(d, 1.00001f * length));
      unsigned bits = mask_bits(d, hn::Le(from_middle_sq, hn::Mul(reach, reach)));
      if (bits == 0) continue;
      alignas(64) float x[max_lanes], y[max_lanes], z[max_lanes], distance[max_lanes],
          supports[max_lanes];
      hn::Store(from_start[0], d, x);
      hn::Store(from_start[1], d, y);
      hn::Store(from_start[2], d, z);
      hn::Store(hn::Sqrt(square), d, distance);
      hn::Store(support, d, supports);
      for (; bits != 0; bits &= bits - 1) {
        const auto lane = static_cast<std::size_t>(__builtin_ctz(bits));
        const std::size_t kernel = begin + lane;
        if (kernel >= kernels_.size() || kernels_.field_of(kernel) != f_) continue;
        const float own_radius = kernels_.radius[kernel];
        const std::size_t at = local.size++;
        local.x[at] = x[lane];
        local.y[at] = y[lane];
        local.z[at] = z[lane];
        local.support[at] = supports[lane];
        local.scale[at] = distance_scale_ / (own_radius * own_radius);
        local.peak[at] = field.peak_factor * kernels_.weight[kernel];
        local_.distance.push_back(distance[lane]);
      }
    }
  }

  const KernelSet& kernels_;
  const SamplingConstants& constants_;
  std::size_t f_;
  Point3d start_;
  float start_high_[3], start_low_[3];  ///< their sum is the start
  float distance_scale_ = 1;
  Point3d gathered_;            ///< what the local kernels reach
  float gathered_length_ = -1;  ///< around that; negative: there are none yet
  Local& local_;
  alignas(64) float directions_[3][max_lanes];
  Vector3d middle_;    ///< of the directions
  double spread_ = 0;  ///< how far they are from it at most
};

/// Some directions of one field's surroundings on their way out: which of them are still open.
template <class Field>
class OpenDirections {
 public:
  /// directions: of `count` lanes.
  OpenDirections(const IsosurfaceFrame& frame, const Field& surroundings,
                 const FieldIsosurfaces& field, const Point3d& start, const Vector3f* directions,
                 std::size_t count)
      : frame_(frame),
        surroundings_(surroundings),
        field_(field),
        start_(start),
        directions_(directions),
        open_((1u << count) - 1) {}

  bool any() const { return open_ != 0; }
  bool is_open(std::size_t lane) const { return (open_ >> lane & 1) != 0; }

  /// Closes those that meet an opaque level between two distances, where the field is `before` and
  /// `after`.
  void close_between(float low, float high, Lanes before, Lanes after) {
    const LaneTag d;
    const Lanes from = hn::Set(d, low), spacing = hn::Set(d, high - low);
    for (const IsosurfaceLevel& level : field_.levels) {
      if (level.opacity < 1) continue;
      const Lanes v = hn::Set(d, level.value);
      const unsigned above = mask_bits(d, hn::Gt(before, v));
      if constexpr (Field::has_faces) {
        const unsigned enclosed = level.value > 0 ? above : ~above;
        const bool capped = level.value != 0;
        close(capped ? surroundings_.pass_face(low, high) & enclosed : 0,
              surroundings_.face_distances());
      }
      const Lanes part = hn::Div(hn::Sub(v, before), hn::Sub(after, before));
      close(mask_bits(d, hn::Gt(after, v)) ^ above, hn::MulAdd(spacing, part, from));
    }
  }

 private:
  /// Closes those of `lanes` whose place at `distance` is not clipped away.
  void close(unsigned lanes, Lanes distance) {
    lanes &= open_;
    if (lanes == 0) return;
    alignas(64) float distances[max_lanes];
    hn::Store(distance, LaneTag(), distances);
    for (; lanes != 0; lanes &= lanes - 1) {
      const auto l = static_cast<std::size_t>(__builtin_ctz(lanes));
      const Point3d place = start_ + static_cast<double>(distances[l]) * Vector3d(directions_[l]);
      if (!is_clipped(frame_, place)) open_ &= ~(1u << l);
    }
  }

  const IsosurfaceFrame& frame_;
  const Field& surroundings_;
  const FieldIsosurfaces& field_;
  Point3d start_;
  const Vector3f* directions_;
  unsigned open_;
};

/// Leaves out the directions along which a level comes within `length`, for the levels of one field
/// that are opaque.
template <class Field>
void prune_by_field(const IsosurfaceFrame& frame, Field& surroundings,
                    const FieldIsosurfaces& field, const Point3d& start, float length,
                    std::vector<Vector3f>& directions) {
  constexpr double steps_of_samples = 1.5;  // from one to the next
  const double most = steps_of_samples * frame.planes.step;
  const int count = std::max(1, static_cast<int>(std::ceil(static_cast<double>(length) / most)));
  const float spacing = length / static_cast<float>(count);
  std::size_t size = 0;
  for (std::size_t first = 0; first < directions.size(); first += hn::Lanes(LaneTag())) {
    const std::size_t there = std::min(directions.size() - first, hn::Lanes(LaneTag()));
    alignas(64) float lanes[3][max_lanes] = {};
    for (std::size_t l = 0; l < there; ++l) {
      for (int i = 0; i < 3; ++i) lanes[i][l] = directions[first + l][i];
    }
    surroundings.look_along(lanes, there);
    OpenDirections<Field> open(frame, surroundings, field, start, &directions[first], there);
    // Long ways in pieces, so that each sample meets but the kernels near it.
    constexpr int piece = 16;
    surroundings.enter(0, spacing * static_cast<float>(std::min(piece, count)));
    Lanes before = surroundings.evaluate(0);
    for (int i = 1; i <= count && open.any(); ++i) {
      const float low = spacing * static_cast<float>(i - 1);
      const float high = spacing * static_cast<float>(i);
      if (i > piece && i % piece == 1) {
        surroundings.enter(low, spacing * static_cast<float>(std::min(i - 1 + piece, count)));
      }
      const Lanes after = surroundings.evaluate(high);
      open.close_between(low, high, before, after);
      before = after;
    }
    for (std::size_t l = 0; l < there; ++l) {
      if (open.is_open(l)) directions[size++] = directions[first + l];
    }
  }
  directions.resize(size);
}

}  // namespace HWY_NAMESPACE
}  // namespace motes
HWY_AFTER_NAMESPACE();

#endif
