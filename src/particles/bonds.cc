// Search of bonds by distance: atoms sorted into bins as wide as the longest bond.
//
// Bins with the same number along two axes make a row; atoms are sorted by row, then by bin. Atoms
// of a row meet those of the nine rows around in step, so that nothing is looked up atom by atom
// and empty space costs nothing, however large it is.
#include "particles/bonds.h"

#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <limits>
#include <tuple>

#include "core/aligned.h"
#include "particles/elements.h"
#include "particles/minimum_image.h"

namespace motes {
namespace {

constexpr double shortest_bond = 0.4, tolerance = 0.45;  // angstrom
constexpr std::size_t max_elements = 97;                 // hydrogen is 1, as in elements.h
constexpr std::uint8_t no_element = 0;

/// The largest squared distance of a bond between two elements; 0 where there is none.
class BondReach {
 public:
  /// Of the elements that there are.
  explicit BondReach(std::vector<std::uint8_t> elements) {
    std::sort(elements.begin(), elements.end());
    elements.erase(std::unique(elements.begin(), elements.end()), elements.end());
    for (const std::uint8_t a : elements) {
      for (const std::uint8_t b : elements) {
        if (a == no_element || b == no_element || (a == 1 && b == 1)) continue;
        const double reach = static_cast<double>(element_by_number(a)->covalent_radius) +
                             static_cast<double>(element_by_number(b)->covalent_radius) + tolerance;
        squares_[index(a, b)] = reach * reach;
        longest_ = std::max(longest_, reach);
      }
    }
  }
  double square(std::uint8_t a, std::uint8_t b) const { return squares_[index(a, b)]; }
  double longest() const { return longest_; }

 private:
  static std::size_t index(std::uint8_t a, std::uint8_t b) { return max_elements * a + b; }
  std::array<double, max_elements * max_elements> squares_{};
  double longest_ = 0;
};

/// Atomic numbers of the species.
std::vector<std::uint8_t> elements_of(const ParticleSet& particles) {
  std::vector<std::uint8_t> elements;
  for (const std::string& name : particles.species_names) {
    const Element* element = find_element(name);
    elements.push_back(element != nullptr ? static_cast<std::uint8_t>(element->number)
                                          : no_element);
  }
  return elements;
}

struct Atom {
  Point3d position;  ///< in the cell, relative to the particles' origin
  std::uint32_t index;
  std::uint8_t element;
};

/// The number of an atom's bin along each axis, in one key: the last axis makes the low bits.
struct Key {
  static constexpr int bits = 21;
  static constexpr std::int64_t max_bins = std::int64_t{1} << bits;
  std::uint64_t value;
  std::uint32_t index;

  std::int64_t bin() const { return static_cast<std::int64_t>(value & (max_bins - 1)); }
  std::uint64_t row() const { return value >> bits; }
};

/// Cuts space along three axes into bins that are at least as wide as the longest bond.
struct Bins {
  struct Axis {
    Vector3d edge;    ///< of the cell, if periodic
    Vector3d across;  ///< a position's part in units of the edge: dot(across, position)
    double first = 0, per_unit = 1;
    std::int64_t count = 1;
    bool periodic = false;

    double place(const Point3d& p) const { return dot(across, p - Point3d{}); }
  };
  std::array<Axis, 3> axes;
  /// Some periodic axis has fewer than three bins: the same two atoms meet in several ways there.
  bool small = false;
  /// Of each edge of the cell: how many the images of two atoms may be apart from which a third is
  /// a bond away.
  std::array<int, 3> most_images{};
};

/// Edges that span space: the cell's periodic ones, and some across them.
std::array<Vector3d, 3> complete(const std::vector<Vector3d>& edges) {
  std::array<Vector3d, 3> all{Vector3d{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  std::copy(edges.begin(), edges.end(), all.begin());
  if (edges.size() == 1) {
    const Vector3d& e = edges[0];
    const bool along_x = std::abs(e.x) >= std::max(std::abs(e.y), std::abs(e.z));
    all[1] = normalize(cross(e, along_x ? Vector3d{0, 1, 0} : Vector3d{1, 0, 0}));
  }
  if (edges.size() == 1 || edges.size() == 2) all[2] = normalize(cross(all[0], all[1]));
  return all;
}

Bins make_bins(const ParticleSet& particles, const MinimumImage& image, double width) {
  Bins bins;
  const std::array<Vector3d, 3> edges = complete(image.edges());
  const double volume = dot(edges[0], cross(edges[1], edges[2]));
  for (std::size_t a = 0; a < 3; ++a) {
    Bins::Axis& axis = bins.axes[a];
    axis.edge = edges[a];
    axis.across = cross(edges[(a + 1) % 3], edges[(a + 2) % 3]) / volume;
    axis.periodic = a < image.edges().size();
    double extent = 1;  // in units of the edge
    if (!axis.periodic) {
      double low = std::numeric_limits<double>::max(), high = -low;
      for (std::size_t i = 0; i < particles.size(); ++i) {
        const double at = axis.place(Point3d{particles.x[i], particles.y[i], particles.z[i]});
        if (!std::isfinite(at)) continue;
        low = std::min(low, at);
        high = std::max(high, at);
      }
      axis.first = low;
      extent = std::max(high - low, 0.0);
    }
    // Planes between the bins are 1 / |across| apart for each unit.
    const double wide = std::floor(extent / length(axis.across) / (width * (1 + 1e-6)));
    axis.count =
        static_cast<std::int64_t>(std::clamp(wide, 1.0, static_cast<double>(Key::max_bins)));
    axis.per_unit = extent > 0 ? static_cast<double>(axis.count) / extent : 0;
    bins.small = bins.small || (axis.periodic && axis.count < 3);
    constexpr double many = 100;  // in a cell as thin as no crystal's
    if (axis.periodic) {
      bins.most_images[a] =
          static_cast<int>(std::min(2 * width * (1 + 1e-6) * length(axis.across), many));
    }
  }
  // Few bins in a row make many rows, which threads share.
  std::sort(bins.axes.begin(), bins.axes.end(),
            [](const Bins::Axis& a, const Bins::Axis& b) { return a.count > b.count; });
  return bins;
}

/// Moves an atom into the cell, and tells its bin along the axis.
std::int64_t take_into(const Bins::Axis& axis, Point3d& position) {
  double place = axis.place(position) - axis.first;
  if (axis.periodic) {
    const double edges = std::floor(place);
    position = position - edges * axis.edge;
    place -= edges;
  }
  return std::clamp(static_cast<std::int64_t>(place * axis.per_unit), std::int64_t{0},
                    axis.count - 1);
}

/// Atoms in the order of their keys.
struct SortedAtoms {
  UninitializedVector<Key> keys;
  UninitializedVector<Atom> atoms;
};

SortedAtoms sort_atoms(const ParticleSet& particles, const std::vector<std::uint8_t>& elements,
                       const Bins& bins) {
  SortedAtoms sorted;
  const auto is_atom = [&](std::size_t i) {
    return elements[particles.species[i]] != no_element &&
           std::isfinite(particles.x[i] + particles.y[i] + particles.z[i]);
  };
  for (std::size_t i = 0; i < particles.size(); ++i) {
    if (is_atom(i)) sorted.keys.push_back({0, static_cast<std::uint32_t>(i)});
  }
  const auto for_all = [&](auto&& work) {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, sorted.keys.size(), 1 << 14),
                      [&](const auto& range) {
                        for (std::size_t i = range.begin(); i != range.end(); ++i) work(i);
                      });
  };
  const auto position_of = [&](std::uint32_t p) {
    return Point3d{particles.x[p], particles.y[p], particles.z[p]};
  };
  for_all([&](std::size_t i) {
    Key& key = sorted.keys[i];
    Point3d position = position_of(key.index);
    for (const Bins::Axis& axis : bins.axes) {
      key.value = key.value << Key::bits | static_cast<std::uint64_t>(take_into(axis, position));
    }
  });
  tbb::parallel_sort(sorted.keys.begin(), sorted.keys.end(), [](const Key& a, const Key& b) {
    return std::tie(a.value, a.index) < std::tie(b.value, b.index);
  });
  sorted.atoms.resize(sorted.keys.size());
  for_all([&](std::size_t i) {
    const std::uint32_t p = sorted.keys[i].index;
    Atom& atom = sorted.atoms[i];
    atom = {position_of(p), p, elements[particles.species[p]]};
    for (const Bins::Axis& axis : bins.axes) take_into(axis, atom.position);
  });
  return sorted;
}

/// Some atoms in a row, or the row moved by whole edges: [begin, end) of the sorted ones.
struct Row {
  std::size_t begin, end;
  Vector3d shift;
};

/// A bin next to another along an axis.
struct NextBin {
  std::int64_t bin;
  Vector3d shift;
};

/// The bins that bin `at` of an axis meets, itself among them; each once.
std::vector<NextBin> bins_around(const Bins::Axis& axis, std::int64_t at) {
  std::vector<NextBin> around;
  if (axis.periodic && axis.count < 3) {
    for (std::int64_t bin = 0; bin < axis.count; ++bin) around.push_back({bin, {}});
    return around;
  }
  for (std::int64_t bin = at - 1; bin <= at + 1; ++bin) {
    if (bin >= 0 && bin < axis.count) {
      around.push_back({bin, {}});
    } else if (axis.periodic) {
      around.push_back(bin < 0 ? NextBin{axis.count - 1, -axis.edge} : NextBin{0, axis.edge});
    }
  }
  return around;
}

/// Finds the bonds of the atoms of one row.
class RowSearch {
 public:
  RowSearch(const SortedAtoms& sorted, const Bins& bins, const BondReach& reach,
            const MinimumImage& image, std::vector<Bond>& bonds)
      : sorted_(sorted), bins_(bins), reach_(reach), image_(image), bonds_(bonds) {}

  /// rows: all rows, sorted; row: one of them.
  void search(const std::vector<Row>& rows, const Row& row) {
    for (const Row& other : rows_around(rows, row)) meet(row, other);
    if (!bins_.small) return;
    for (std::size_t i = row.begin; i < row.end; ++i)
      meet_images(sorted_.atoms[i], sorted_.atoms[i]);
  }

 private:
  /// Without those before it, which meet it themselves.
  std::vector<Row> rows_around(const std::vector<Row>& rows, const Row& row) const {
    const std::uint64_t key = sorted_.keys[row.begin].row();
    const auto low_bits = static_cast<std::uint64_t>(Key::max_bins - 1);
    const auto a = static_cast<std::int64_t>(key >> Key::bits);
    const auto b = static_cast<std::int64_t>(key & low_bits);
    std::vector<Row> around;
    for (const NextBin& first : bins_around(bins_.axes[0], a)) {
      for (const NextBin& second : bins_around(bins_.axes[1], b)) {
        const std::uint64_t wanted = static_cast<std::uint64_t>(first.bin) << Key::bits |
                                     static_cast<std::uint64_t>(second.bin);
        const auto row_of = [&](const Row& r) { return sorted_.keys[r.begin].row(); };
        const auto it =
            std::lower_bound(rows.begin(), rows.end(), wanted,
                             [&](const Row& r, std::uint64_t k) { return row_of(r) < k; });
        if (it == rows.end() || row_of(*it) != wanted || it->end <= row.begin) continue;
        around.push_back({it->begin, it->end, first.shift + second.shift});
      }
    }
    return around;
  }

  /// Atoms of `row` with those of `other`, bin by bin of the last axis.
  void meet(const Row& row, const Row& other) {
    const Bins::Axis& axis = bins_.axes[2];
    if (axis.periodic && axis.count < 3) {
      for (std::size_t i = row.begin; i < row.end; ++i) compare(i, other.begin, other.end, {});
      return;
    }
    std::size_t low = other.begin, high = other.begin;
    for (std::size_t i = row.begin; i < row.end; ++i) {
      const std::int64_t bin = sorted_.keys[i].bin();
      while (low < other.end && sorted_.keys[low].bin() < bin - 1) ++low;
      high = std::max(high, low);
      while (high < other.end && sorted_.keys[high].bin() <= bin + 1) ++high;
      compare(i, low, high, other.shift);
      if (axis.periodic && bin == 0) {
        std::size_t last = other.end;
        while (last > other.begin && sorted_.keys[last - 1].bin() == axis.count - 1) --last;
        compare(i, last, other.end, other.shift - axis.edge);
      }
      if (axis.periodic && bin == axis.count - 1) {
        std::size_t end = other.begin;
        while (end < other.end && sorted_.keys[end].bin() == 0) ++end;
        compare(i, other.begin, end, other.shift + axis.edge);
      }
    }
  }

  /// Atom i with those of [begin, end) that come after it, moved by `shift`.
  void compare(std::size_t i, std::size_t begin, std::size_t end, const Vector3d& shift) {
    const Atom& atom = sorted_.atoms[i];
    const Point3d from = atom.position - shift;
    for (std::size_t j = std::max(begin, i + 1); j < end; ++j) {
      const Atom& other = sorted_.atoms[j];
      if (bins_.small) {
        meet_images(atom, other);
      } else if (are_bonded(atom, other, other.position - from)) {
        bonds_.push_back({std::min(atom.index, other.index), std::max(atom.index, other.index)});
      }
    }
  }

  bool are_bonded(const Atom& a, const Atom& b, const Vector3d& v) const {
    const double square = dot(v, v);
    return square <= reach_.square(a.element, b.element) && square > shortest_bond * shortest_bond;
  }

  /// An atom with all images of another, or of its own.
  void meet_images(const Atom& a, const Atom& b) {
    const bool swap = b.index < a.index, same = b.index == a.index;
    const Atom& first = swap ? b : a;
    const Atom& second = swap ? a : b;
    const Vector3d nearest = same ? Vector3d{} : image_(second.position - first.position);
    if (dot(nearest, nearest) > reach_.square(a.element, b.element)) return;
    const std::array<int, 3>& most = bins_.most_images;
    std::array<int, 3> n{};
    for (n[0] = -most[0]; n[0] <= most[0]; ++n[0]) {
      for (n[1] = -most[1]; n[1] <= most[1]; ++n[1]) {
        for (n[2] = -most[2]; n[2] <= most[2]; ++n[2]) {
          // Of an atom and its own images each bond is there from both ends.
          if (same && n <= std::array<int, 3>{}) continue;
          const auto count = [&](std::size_t axis) { return static_cast<std::int8_t>(n[axis]); };
          const std::array<std::int8_t, 3> image{count(0), count(1), count(2)};
          if (!are_bonded(first, second, nearest + image_.shift(image))) continue;
          bonds_.push_back({first.index, second.index, image});
        }
      }
    }
  }

  const SortedAtoms& sorted_;
  const Bins& bins_;
  const BondReach& reach_;
  const MinimumImage& image_;
  std::vector<Bond>& bonds_;
};

void sort_bonds(std::vector<Bond>& bonds) {
  tbb::parallel_sort(bonds.begin(), bonds.end(), [](const Bond& a, const Bond& b) {
    return std::tie(a.first, a.second, a.image) < std::tie(b.first, b.second, b.image);
  });
}

}  // namespace

std::vector<Bond> find_bonds(const ParticleSet& particles) {
  assert(particles.size() < std::numeric_limits<std::uint32_t>::max());
  if (particles.species.empty()) return {};
  const std::vector<std::uint8_t> elements = elements_of(particles);
  const BondReach reach(elements);
  if (reach.longest() == 0) return {};
  const MinimumImage image(particles.cell);
  const Bins bins = make_bins(particles, image, reach.longest());
  const SortedAtoms sorted = sort_atoms(particles, elements, bins);
  std::vector<Row> rows;
  for (std::size_t i = 0; i < sorted.keys.size(); ++i) {
    if (i == 0 || sorted.keys[i].row() != sorted.keys[i - 1].row()) rows.push_back({i, i, {}});
    rows.back().end = i + 1;
  }

  tbb::enumerable_thread_specific<std::vector<Bond>> found;
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, rows.size(), 16), [&](const auto& range) {
    RowSearch search(sorted, bins, reach, image, found.local());
    for (std::size_t r = range.begin(); r != range.end(); ++r) search.search(rows, rows[r]);
  });
  std::vector<Bond> bonds;
  std::size_t count = 0;
  for (const std::vector<Bond>& part : found) count += part.size();
  bonds.reserve(count);
  for (const std::vector<Bond>& part : found) bonds.insert(bonds.end(), part.begin(), part.end());
  sort_bonds(bonds);
  return bonds;
}

std::vector<Bond> file_bonds(const ParticleSet& particles, Warnings& warnings) {
  std::vector<Bond> bonds;
  bonds.reserve(particles.bonds.size());
  for (const Bond& bond : particles.bonds) {
    assert(std::max(bond.first, bond.second) < particles.size());
    const auto [first, second] = std::minmax(bond.first, bond.second);
    if (first != second) bonds.push_back({first, second});
  }
  if (const std::size_t lone = particles.bonds.size() - bonds.size(); lone > 0) {
    warnings.add(fmt::format("{} of a particle to itself left out",
                             lone == 1 ? "1 bond" : fmt::format("{} bonds", lone)));
  }
  sort_bonds(bonds);
  bonds.erase(std::unique(bonds.begin(), bonds.end()), bonds.end());
  return bonds;
}

}  // namespace motes
