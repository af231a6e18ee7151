// The nanospheres and the aluminium particles: carved from blocks of glass and crystal.
#include <algorithm>
#include <array>
#include <numbers>
#include <numeric>

#include "motes/bench/carve.h"
#include "motes/bench/recipes.h"

namespace motes {
namespace {

/// A rotation as its rows.
using Rotation = std::array<Vector3d, 3>;

Vector3d random_vector(const Random& random, std::uint64_t index) {
  return jitter(random, index, 1);
}

Rotation random_rotation(const Random& random, std::uint64_t index) {
  const Vector3d a = normalize(random_vector(random, 2 * index));
  const Vector3d b = normalize(cross(a, random_vector(random, 2 * index + 1)));
  return {a, b, cross(a, b)};
}

Vector3d rotate(const Rotation& r, const Vector3d& v) {
  return {dot(r[0], v), dot(r[1], v), dot(r[2], v)};
}

double square(const Vector3d& v) { return dot(v, v); }

/// Ten periods of the face-centred cubic crystal of aluminium along each axis.
Block aluminium_block() {
  constexpr double lattice_constant = 4.05;
  constexpr int periods = 10;
  const std::array<Vector3d, 4> corners{{{0, 0, 0}, {0, 0.5, 0.5}, {0.5, 0, 0.5}, {0.5, 0.5, 0}}};
  Block block;
  const double size = periods * lattice_constant;
  block.size = {size, size, size};
  for (int i = 0; i < periods * periods * periods; ++i) {
    const int layer = i / (periods * periods), row = i / periods % periods;
    const Vector3d cell(layer, row, i % periods);
    for (const Vector3d& corner : corners) {
      block.positions.push_back((cell + corner) * lattice_constant);
      block.species.push_back(0);
    }
  }
  return block;
}

/// Species of make_nanoparticles().
enum : std::uint16_t { core_aluminium, shell_aluminium, oxygen };

/// Where the gas may be: a box around the origin, but not in the particles.
struct GasSpace {
  Vector3d half;  ///< of the box's edges
  std::vector<Vector3d> centers;
  double radius;  ///< of the spheres to leave out
};

/// `pairs` molecules of oxygen, evenly spread over the free points of a jittered grid.
void add_gas(const GasSpace& space, std::size_t pairs, const Random& random, ParticleSet& atoms) {
  const double spheres = static_cast<double>(space.centers.size()) * 4 / 3 * std::numbers::pi *
                         std::pow(space.radius, 3);
  const double volume = 8 * space.half.x * space.half.y * space.half.z - spheres;
  const double spacing = std::cbrt(volume / static_cast<double>(pairs)) / 1.03;
  std::array<std::uint64_t, 3> n;
  Vector3d step;
  for (int axis = 0; axis < 3; ++axis) {
    const double count = std::ceil(2 * space.half[axis] / spacing);
    n[static_cast<std::size_t>(axis)] = static_cast<std::uint64_t>(count);
    step[axis] = 2 * space.half[axis] / count;
  }
  std::vector<Vector3d> free;
  for (std::uint64_t i = 0; i < n[0] * n[1] * n[2]; ++i) {
    const std::array<std::uint64_t, 3> cell{i / (n[1] * n[2]), i / n[2] % n[1], i % n[2]};
    Vector3d point;
    for (int axis = 0; axis < 3; ++axis) {
      const auto place = static_cast<std::size_t>(axis);
      const double offset = random.uniform(3 * i + place, 0.2, 0.8);
      point[axis] = (static_cast<double>(cell[place]) + offset) * step[axis] - space.half[axis];
    }
    const bool outside = std::ranges::all_of(space.centers, [&](const Vector3d& center) {
      return square(point - center) > space.radius * space.radius;
    });
    if (outside) free.push_back(point);
  }
  constexpr double half_bond = 0.605;
  const Random directions(13);
  for (std::size_t i = 0; i < pairs; ++i) {
    const Vector3d& point = free[i * free.size() / pairs];
    const Vector3d bond = half_bond * normalize(random_vector(directions, i));
    add_atom(atoms, point + bond, oxygen);
    add_atom(atoms, point - bond, oxygen);
  }
}

}  // namespace

ParticleSet make_nanosphere(const ParticleSet& glass, std::size_t num_atoms) {
  constexpr double hollow = 0.55, noise = 0.05;
  const Block block = make_block(glass);
  const double density =
      static_cast<double>(block.positions.size()) / (block.size.x * block.size.y * block.size.z);
  const double shell = 1 - hollow * hollow * hollow;
  // A little too large: the outermost atoms are dropped below.
  const double radius = 1.02 * std::cbrt(static_cast<double>(num_atoms) / density / shell * 3 /
                                         (4 * std::numbers::pi));
  const Random random(3);
  ParticleSet all;
  for_each_copy(block, radius, [&](const Vector3d& position, std::uint16_t species) {
    const double r = length(position);
    if (r >= radius || r <= hollow * radius) return;
    add_atom(all, position + jitter(random, all.size(), noise), species);
  });

  std::vector<std::uint32_t> order(all.size());
  std::iota(order.begin(), order.end(), 0U);
  const auto square_radius = [&all](std::uint32_t i) {
    return all.x[i] * all.x[i] + all.y[i] * all.y[i] + all.z[i] * all.z[i];
  };
  std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return square_radius(a) < square_radius(b);
  });
  order.resize(num_atoms);
  std::sort(order.begin(), order.end());
  ParticleSet kept;
  kept.species_names = glass.species_names;
  for (const std::uint32_t i : order) {
    add_atom(kept, {all.x[i], all.y[i], all.z[i]}, all.species[i]);
  }
  return kept;
}

ParticleSet make_nanoparticles(const ParticleSet& alumina, std::size_t num_atoms) {
  constexpr double radius = 230, shell = 30, core_radius = radius - shell, noise = 0.1;
  const Block crystal = aluminium_block(), glass = make_block(alumina);
  const auto aluminium = static_cast<std::uint16_t>(std::ranges::find(alumina.species_names, "Al") -
                                                    alumina.species_names.begin());
  const Random random(11), places(12);
  ParticleSet atoms;
  atoms.species_names = {"Al", "AlO", "O"};
  for (std::vector<float>* axis : {&atoms.x, &atoms.y, &atoms.z}) axis->reserve(num_atoms);
  atoms.species.reserve(num_atoms);
  std::vector<Vector3d> centers;
  for (std::uint64_t i = 0; i < 3; ++i) {
    centers.push_back({(static_cast<double>(i) - 1) * (2 * radius + 1.5),
                       0.06 * radius * places.normal(2 * i),
                       0.06 * radius * places.normal(2 * i + 1)});
    const Rotation of_core = random_rotation(places, 10 + 2 * i),
                   of_shell = random_rotation(places, 11 + 2 * i);
    const auto add = [&](const Rotation& rotation, const Vector3d& p, std::uint16_t species) {
      const Vector3d moved = p + jitter(random, atoms.size(), noise);
      add_atom(atoms, rotate(rotation, moved) + centers.back(), species);
    };
    for_each_copy(crystal, core_radius, [&](const Vector3d& p, std::uint16_t) {
      if (square(p) < (core_radius - 1) * (core_radius - 1)) add(of_core, p, core_aluminium);
    });
    for_each_copy(glass, radius, [&](const Vector3d& p, std::uint16_t species) {
      if (square(p) < radius * radius && square(p) > (core_radius + 1) * (core_radius + 1)) {
        add(of_shell, p, species == aluminium ? shell_aluminium : oxygen);
      }
    });
  }
  const Vector3d half{centers.back().x + 1.6 * radius, 1.9 * radius, 1.9 * radius};
  add_gas({half, centers, radius + 3}, (num_atoms - atoms.size()) / 2, random, atoms);
  return atoms;
}

}  // namespace motes
