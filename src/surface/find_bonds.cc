// Search of bonds by distance: pairs of the tree's leaves that come as near as a bond, then pairs
// of their atoms.
//
// How near boxes or atoms come in a periodic cell is told along the cell's axes: there, images are
// whole numbers apart, and the nearest of them differs by half at most, whatever the cell's shape
// and however far outside of it atoms lie. What comes near by that measure in single precision, a
// little more than does, is then looked at image by image in double.
#include "surface/find_bonds.h"

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>

#include "particles/bonds.h"
#include "particles/minimum_image.h"

namespace motes {
namespace {

/// The nearest whole number of |x| < 2^21, in the few operations that compilers make vectors of.
inline float nearest_whole(float x) {
  constexpr float magic = 12582912;  // 1.5 * 2^23: its neighbours are 1 apart
  return (x + magic) - magic;
}

/// A direction across which the images of a cell are whole numbers apart, or one of no period.
struct Axis {
  Vector3d edge;
  Vector3d across;  ///< dot(across, v): v in edges of the cell; of the file's lengths
  bool periodic = false;
};

/// Of the cell's periodic edges, and of what completes them to space.
std::array<Axis, 3> make_axes(const std::vector<Vector3d>& edges) {
  std::array<Vector3d, 3> all{Vector3d{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  std::copy(edges.begin(), edges.end(), all.begin());
  if (edges.size() == 1) {
    const Vector3d& e = edges[0];
    const bool along_x = std::abs(e.x) >= std::max(std::abs(e.y), std::abs(e.z));
    all[1] = normalize(cross(e, along_x ? Vector3d{0, 1, 0} : Vector3d{1, 0, 0}));
  }
  if (edges.size() == 1 || edges.size() == 2) all[2] = normalize(cross(all[0], all[1]));
  const double volume = dot(all[0], cross(all[1], all[2]));
  std::array<Axis, 3> axes;
  for (std::size_t a = 0; a < 3; ++a) {
    axes[a] = {all[a], cross(all[(a + 1) % 3], all[(a + 2) % 3]) / volume, a < edges.size()};
  }
  return axes;
}

/// A box by its middle and half its size; internal lengths.
struct Box {
  Vector3f middle, half;
};

Box child_box(const Bvh::Node& node, std::size_t c) {
  const Vector3f min{node.min_x[c], node.min_y[c], node.min_z[c]};
  const Vector3f max{node.max_x[c], node.max_y[c], node.max_z[c]};
  return {0.5F * (min + max), 0.5F * (max - min)};
}

/// Which boxes, or atoms, may be as near as a bond: never says no where they are.
class Nearness {
 public:
  /// reach: of bonds, internal length, with what single precision loses.
  Nearness(const std::array<Axis, 3>& axes, double length_scale, double reach)
      : square_(static_cast<float>(reach * reach)) {
    for (std::size_t a = 0; a < 3; ++a) {
      const Vector3d across = axes[a].across / length_scale;
      across_[a] = Vector3f(across);
      extent_[a] = Vector3f{std::abs(across_[a].x), std::abs(across_[a].y), std::abs(across_[a].z)};
      reach_[a] = static_cast<float>(length(across) * reach);
      edge_[a] = Vector3f(length_scale * axes[a].edge);
      // Without a period, all is in the one image.
      period_[a] = axes[a].periodic ? 1.0F : 0.0F;
    }
  }

  /// v: from one middle to the other; half: of both boxes together.
  bool near(const Vector3f& v, const Vector3f& half) const {
    bool near = true;
    for (std::size_t a = 0; a < 3; ++a) {
      const float place = dot(across_[a], v);
      const float away = std::abs(place - period_[a] * nearest_whole(place));
      // Whole numbers that large are found no more, and all counts as near.
      const bool within =
          away <= dot(extent_[a], half) + reach_[a] || period_[a] * std::abs(place) > largest;
      near = near && within;
    }
    return near;
  }

  /// Where only one image of what is near has boxes near each other: what moves the second there.
  std::optional<Vector3f> only_shift(const Vector3f& v, const Vector3f& half) const {
    Vector3f shift;
    for (std::size_t a = 0; a < 3; ++a) {
      if (period_[a] == 0) continue;
      const float place = dot(across_[a], v), away = dot(extent_[a], half) + reach_[a];
      const float edges = std::ceil(place - away);
      if (std::floor(place + away) != edges) return std::nullopt;
      shift = shift - edges * edge_[a];
    }
    return shift;
  }
  /// The largest squared distance of a bond, with what single precision loses.
  float square() const { return square_; }

  /// The children of a node near to a box, as bits. Hot: half of the search. Children that are not
  /// there are not near.
  unsigned children_near(const Box& box, const Bvh::Node& node) const {
    std::array<bool, Bvh::width> near;
    for (std::size_t c = 0; c < Bvh::width; ++c) {
      const Box child = child_box(node, c);
      near[c] = this->near(child.middle - box.middle, child.half + box.half);
    }
    unsigned bits = 0;
    for (std::size_t c = 0; c < Bvh::width; ++c) bits |= static_cast<unsigned>(near[c]) << c;
    return bits;
  }

 private:
  static constexpr float largest = 1 << 21;
  std::array<Vector3f, 3> edge_, across_, extent_;  ///< internal lengths
  std::array<float, 3> reach_{}, period_{};
  float square_;
};

/// A leaf by number, with its atoms' box.
struct Leaf {
  std::size_t number;
  Box box;
};

/// What the search is among and by what rule.
struct Atoms {
  const ParticleSet& particles;
  const KernelSet& kernels;
  std::span<const std::uint32_t> particle_of;
  std::vector<std::uint8_t> elements;  ///< of kernels; no_element: no atom, or looked at already
};

class BondSearch {
 public:
  BondSearch(const Atoms& atoms, const BondRule& rule, const MinimumImage& image)
      : atoms_(atoms),
        rule_(rule),
        image_(image),
        axes_(make_axes(image.edges())),
        near_(axes_, atoms.kernels.length_scale,
              rule.longest() * atoms.kernels.length_scale + rounding(atoms.kernels)) {
    for (std::size_t a = 0; a < 3; ++a) {
      if (axes_[a].periodic) most_[a] = length(axes_[a].across) * rule.longest() * (1 + 1e-9);
      own_images_ = own_images_ || most_[a] >= 1;
    }
  }

  /// Nodes that have leaves as children, by number.
  std::size_t num_nodes() const {
    const Bvh& bvh = atoms_.kernels.bvh;
    return bvh.level_begin.empty() ? 0 : bvh.nodes.size() - bvh.level_begin.back();
  }

  /// Appends the bonds of the atoms under a node with those of its and later leaves.
  void search(std::size_t node, std::vector<Bond>& bonds) const {
    const Bvh& bvh = atoms_.kernels.bvh;
    const std::vector<Leaf> own = leaves_of(node);
    const Box box = around(own);
    static thread_local std::vector<Leaf> others;
    others.clear();
    traverse(
        bvh, [&](const Bvh::Node& n) { return near_.children_near(box, n); },
        [&](std::size_t leaf) {
          if (leaf < Bvh::width * node) return;
          const Bvh::Node& above = bvh.nodes[bvh.level_begin.back() + leaf / Bvh::width];
          others.push_back({leaf, child_box(above, leaf % Bvh::width)});
        });
    for (const Leaf& leaf : own) {
      for (const Leaf& other : others) {
        if (other.number < leaf.number ||
            !near_.near(other.box.middle - leaf.box.middle, other.box.half + leaf.box.half)) {
          continue;
        }
        meet(leaf, other, bonds);
      }
    }
  }

 private:
  /// What the middles of boxes and the difference of places lose in single precision, and more.
  static double rounding(const KernelSet& kernels) {
    const Bounds3f bounds = bounds_of(kernels.bvh);
    float largest = 0;
    for (int axis = 0; axis < 3; ++axis) {
      largest = std::max({largest, std::abs(bounds.min[axis]), std::abs(bounds.max[axis])});
    }
    return 2e-6 * static_cast<double>(largest);
  }

  std::vector<Leaf> leaves_of(std::size_t node) const {
    const Bvh& bvh = atoms_.kernels.bvh;
    std::vector<Leaf> leaves;
    for (std::size_t c = 0; c < Bvh::width; ++c) {
      const std::size_t leaf = Bvh::width * node + c;
      if (leaf >= bvh.num_leaves()) break;
      leaves.push_back({leaf, child_box(bvh.nodes[bvh.level_begin.back() + node], c)});
    }
    return leaves;
  }

  static Box around(const std::vector<Leaf>& leaves) {
    Bounds3f bounds;
    for (const Leaf& leaf : leaves) {
      const Point3f middle(leaf.box.middle);
      bounds.add(middle - leaf.box.half);
      bounds.add(middle + leaf.box.half);
    }
    return {Vector3f(bounds.center()), 0.5F * bounds.diagonal()};
  }

  /// The atoms of two leaves.
  void meet(const Leaf& a, const Leaf& b, std::vector<Bond>& bonds) const {
    if (const auto shift = near_.only_shift(b.box.middle - a.box.middle, a.box.half + b.box.half)) {
      meet_shifted(a, b, *shift, bonds);
      return;
    }
    const KernelSet& k = atoms_.kernels;
    for (std::size_t i = first_of(a); i < first_of(a) + Bvh::leaf_size; ++i) {
      for (std::size_t j = first_of(b); j < first_of(b) + Bvh::leaf_size; ++j) {
        if (j < i || (j == i && !own_images_) || !is_atom(i) || !is_atom(j)) continue;
        const Vector3f v{k.x[j] - k.x[i], k.y[j] - k.y[i], k.z[j] - k.z[i]};
        if (near_.near(v, {})) meet_images(i, j, bonds);
      }
    }
  }

  /// The same where the second leaf is near in one place only, moved by `shift`. Hot.
  void meet_shifted(const Leaf& a, const Leaf& b, const Vector3f& shift,
                    std::vector<Bond>& bonds) const {
    constexpr std::size_t n = Bvh::leaf_size;
    const KernelSet& kernels = atoms_.kernels;
    const float* x = &kernels.x[first_of(a)];
    const float* y = &kernels.y[first_of(a)];
    const float* z = &kernels.z[first_of(a)];
    std::array<float, n> square;
    const Vector3f middle = b.box.middle + shift, half = b.box.half;
    for (std::size_t k = 0; k < n; ++k) {
      const float dx = std::max(std::abs(x[k] - middle.x) - half.x, 0.0F);
      const float dy = std::max(std::abs(y[k] - middle.y) - half.y, 0.0F);
      const float dz = std::max(std::abs(z[k] - middle.z) - half.z, 0.0F);
      square[k] = dx * dx + dy * dy + dz * dz;
    }
    for (std::size_t k = 0; k < n; ++k) {
      if (square[k] > near_.square() || !is_atom(first_of(a) + k)) continue;
      meet_shifted(first_of(a) + k, Vector3f{x[k], y[k], z[k]} - shift, b, bonds);
    }
  }

  /// Atom i, which lies at `from`, with those of a leaf.
  void meet_shifted(std::size_t i, const Vector3f& from, const Leaf& leaf,
                    std::vector<Bond>& bonds) const {
    constexpr std::size_t n = Bvh::leaf_size;
    const KernelSet& kernels = atoms_.kernels;
    const std::size_t first = first_of(leaf);
    const float* x = &kernels.x[first];
    const float* y = &kernels.y[first];
    const float* z = &kernels.z[first];
    std::array<float, n> square;
    for (std::size_t k = 0; k < n; ++k) {
      const float dx = x[k] - from.x, dy = y[k] - from.y, dz = z[k] - from.z;
      square[k] = dx * dx + dy * dy + dz * dz;
    }
    for (std::size_t k = i < first ? 0 : std::min(i + 1 - first, n); k < n; ++k) {
      if (square[k] <= near_.square() && is_atom(first + k)) meet_images(i, first + k, bonds);
    }
  }

  static std::size_t first_of(const Leaf& leaf) { return Bvh::leaf_size * leaf.number; }
  bool is_atom(std::size_t i) const { return atoms_.elements[i] != BondRule::no_element; }

  /// An atom with the images of another, or half of those of its own.
  void meet_images(std::size_t i, std::size_t j, std::vector<Bond>& bonds) const {
    const std::uint8_t a = atoms_.elements[i], b = atoms_.elements[j];
    const auto [first, second] = std::minmax(atoms_.particle_of[i], atoms_.particle_of[j]);
    const ParticleSet& p = atoms_.particles;
    const auto d = [f = first, s = second](const std::vector<float>& x) {
      return static_cast<double>(x[s]) - static_cast<double>(x[f]);
    };
    const Vector3d nearest =
        first == second ? Vector3d{} : image_(Vector3d{d(p.x), d(p.y), d(p.z)});
    std::array<int, 3> low{}, high{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (!axes_[axis].periodic) continue;
      // In cells as thin as no crystal's not all images are looked at.
      constexpr double many = 100;
      const double place = dot(axes_[axis].across, nearest);
      low[axis] = static_cast<int>(std::ceil(std::max(-place - most_[axis], -many)));
      high[axis] = static_cast<int>(std::floor(std::min(-place + most_[axis], many)));
    }
    std::array<int, 3> at{};
    for (at[0] = low[0]; at[0] <= high[0]; ++at[0]) {
      for (at[1] = low[1]; at[1] <= high[1]; ++at[1]) {
        for (at[2] = low[2]; at[2] <= high[2]; ++at[2]) {
          if (first == second && at <= std::array<int, 3>{}) continue;
          const auto count = [&](std::size_t axis) { return static_cast<std::int8_t>(at[axis]); };
          const std::array<std::int8_t, 3> image{count(0), count(1), count(2)};
          const Vector3d v = nearest + image_.shift(image);
          if (rule_.holds(a, b, dot(v, v))) bonds.push_back({first, second, image});
        }
      }
    }
  }

  const Atoms& atoms_;
  const BondRule& rule_;
  const MinimumImage& image_;
  std::array<Axis, 3> axes_;
  Nearness near_;
  std::array<double, 3> most_{};  ///< the longest bond along each periodic axis, in edges
  bool own_images_ = false;       ///< an atom may be bonded to an image of itself
};

std::vector<std::uint8_t> elements_of(const ParticleSet& particles, std::vector<bool> among,
                                      std::span<const std::uint32_t> particle_of,
                                      const BondRule& rule, std::size_t padded) {
  std::vector<std::uint8_t> elements(padded, BondRule::no_element);
  for (std::size_t i = 0; i < particle_of.size(); ++i) {
    const std::uint32_t p = particle_of[i];
    if (!among[p]) continue;
    elements[i] = rule.elements()[particles.species[p]];
    among[p] = false;  // a particle of several fields is one atom
  }
  return elements;
}

}  // namespace

std::vector<Bond> find_bonds(const ParticleSet& particles, const std::vector<bool>& among,
                             std::span<const std::uint32_t> particle_of, const KernelSet& kernels) {
  assert(among.size() == particles.size() && particle_of.size() == kernels.size());
  if (particles.species.empty()) return {};
  const BondRule rule(particles.species_names);
  if (rule.longest() == 0) return {};
  const Atoms atoms{particles, kernels, particle_of,
                    elements_of(particles, among, particle_of, rule, kernels.x.size())};
  const MinimumImage image(particles.cell);
  const BondSearch search(atoms, rule, image);
  tbb::enumerable_thread_specific<std::vector<Bond>> found;
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, search.num_nodes(), 64),
                    [&](const auto& range) {
                      std::vector<Bond>& bonds = found.local();
                      for (std::size_t node = range.begin(); node != range.end(); ++node) {
                        search.search(node, bonds);
                      }
                    });
  std::vector<Bond> bonds;
  std::size_t count = 0;
  for (const std::vector<Bond>& part : found) count += part.size();
  bonds.reserve(count);
  for (const std::vector<Bond>& part : found) bonds.insert(bonds.end(), part.begin(), part.end());
  sort_bonds(bonds);
  return bonds;
}

}  // namespace motes
