// The membrane: idealised molecules put side by side, with enough disorder to look like one.
#include <array>
#include <cmath>

#include "motes/bench/carve.h"
#include "motes/bench/recipes.h"

namespace motes {
namespace {

/// Indices into species_names, and values of the property "molecule".
enum Species : std::uint16_t { C, N, O, P, H };
enum Molecule { tryptophan, lipid, water };

struct Atom {
  Species species;
  Vector3d position;
};

/// The amino acid, its rings in the plane z = 0 with ideal bonds.
constexpr std::array<Atom, 27> tryptophan_atoms{{
    {C, {0, -0.70, 0}},        {C, {0, 0.70, 0}},          {C, {1.212, 1.40, 0}},
    {C, {2.425, 0.70, 0}},     {C, {2.425, -0.70, 0}},     {C, {1.212, -1.40, 0}},
    {N, {-1.32, 1.12, 0}},     {C, {-2.14, 0, 0}},         {C, {-1.33, -1.13, 0}},
    {C, {-1.85, -2.54, 0}},    {C, {-3.37, -2.60, 0.10}},  {N, {-3.90, -1.90, 1.25}},
    {C, {-3.95, -4.02, 0.05}}, {O, {-4.90, -4.35, 0.70}},  {O, {-3.40, -4.92, -0.75}},
    {H, {-1.72, 2.05, 0}},     {H, {-3.22, 0.05, 0}},      {H, {1.212, -2.49, 0}},
    {H, {3.37, -1.25, 0}},     {H, {3.37, 1.25, 0}},       {H, {1.212, 2.49, 0}},
    {H, {-1.45, -3.05, 0.89}}, {H, {-1.45, -3.05, -0.89}}, {H, {-3.75, -2.05, -0.78}},
    {H, {-3.60, -0.95, 1.30}}, {H, {-4.90, -1.95, 1.15}},  {H, {-3.80, -5.75, -0.75}},
}};

constexpr double site_spacing = 8;  // of lipids: 64 square angstroms each
constexpr int sites_x = 7, sites_y = 3;

class Membrane {
 public:
  ParticleSet make();

 private:
  void add(Molecule molecule, const Atom& atom);
  void add_lipid(const Vector3d& site, double side);
  void add_water(int count, double side);

  Random random_{7};
  std::uint64_t next_ = 0;  ///< of random_
  ParticleSet atoms_;
  std::vector<float> molecules_;
};

void Membrane::add(Molecule molecule, const Atom& atom) {
  constexpr double noise = 0.15;
  add_atom(atoms_, atom.position + jitter(random_, 1'000'000 + atoms_.size(), noise), atom.species);
  molecules_.push_back(static_cast<float>(molecule));
}

/// A phospholipid without hydrogen, 50 atoms, its head at z = 21 and its two tails reaching down to
/// the middle of the membrane; mirrored where `side` is -1.
void Membrane::add_lipid(const Vector3d& site, double side) {
  const double turn = 6.283185307179586 * random_.uniform(next_++);
  const double lift = random_.normal(next_++);
  const Vector3d lean{0.08 * random_.normal(next_), 0.08 * random_.normal(next_ + 1), 0};
  next_ += 2;
  const auto put = [&](Species species, double x, double y, double z) {
    const Vector3d turned{x * std::cos(turn) - y * std::sin(turn),
                          x * std::sin(turn) + y * std::cos(turn), side * (z + lift)};
    add(lipid, {species, site + turned + lean * (21 - z)});
  };
  // Choline.
  put(N, 2.2, 0, 21.5);
  for (const double angle : {0.0, 2.1, 4.2}) {
    put(C, 2.2 + 1.4 * std::cos(angle), 1.4 * std::sin(angle), 22.1);
  }
  put(C, 1.8, 0.3, 20.1);
  put(C, 0.7, 0.6, 19.3);
  // Phosphate.
  put(P, -0.9, 0, 18.6);
  put(O, 0.2, -0.4, 18.7);
  put(O, -1.4, 1.4, 18.9);
  put(O, -1.8, -1.0, 19.3);
  put(O, -1.0, -0.2, 17.0);
  // Glycerol.
  put(C, 0, 0, 16.2);
  put(C, 1.2, 0.6, 15.6);
  put(C, -1.2, -0.6, 15.6);
  // Two chains, each with its ester.
  for (const double way : {1.0, -1.0}) {
    put(O, way * 1.9, 0, 15.0);
    put(O, way * 3.2, way * 0.9, 14.3);
    for (int i = 0; i < 16; ++i) {
      put(C, way * (2.4 + (i % 2 == 0 ? 0.42 : -0.42)), 0, 14.2 - 0.85 * i);
    }
  }
}

/// `count` molecules on a jittered grid beyond the heads.
void Membrane::add_water(int count, double side) {
  constexpr double spacing = 3.11;
  const int columns = static_cast<int>(sites_x * site_spacing / spacing);
  const int rows = static_cast<int>(sites_y * site_spacing / spacing);
  for (int i = 0; i < count; ++i) {
    const int row = i / columns % rows, layer = i / (columns * rows);
    const Vector3d cell(i % columns - 0.5 * (columns - 1), row - 0.5 * (rows - 1),
                        side * (8.2 + layer));
    const Vector3d oxygen = spacing * cell + 0.3 * jitter(random_, next_++, 1);
    const Vector3d a = normalize(jitter(random_, next_, 1));
    const Vector3d b = normalize(cross(a, jitter(random_, next_ + 1, 1)));
    next_ += 2;
    add(water, {O, oxygen});
    add(water, {H, oxygen + 0.586 * a + 0.757 * b});
    add(water, {H, oxygen + 0.586 * a - 0.757 * b});
  }
}

ParticleSet Membrane::make() {
  atoms_.species_names = {"C", "N", "O", "P", "H"};
  atoms_.length_unit = "angstrom";
  for (const Atom& atom : tryptophan_atoms) {
    // Upright in the place that the lipids of one side leave free, between head and tails.
    const Vector3d& p = atom.position;
    add(tryptophan, {atom.species, {p.x, p.z, 12 - p.y}});
  }
  for (const double side : {1.0, -1.0}) {
    for (int site = 0; site < sites_x * sites_y; ++site) {
      if (site == sites_x * sites_y / 2) continue;
      const int column = site % sites_x - (sites_x - 1) / 2;
      const int row = site / sites_x - (sites_y - 1) / 2;
      add_lipid({site_spacing * column, site_spacing * row, 0}, side);
    }
  }
  add_water(801, 1);
  add_water(800, -1);
  atoms_.properties.push_back({"molecule", molecules_});
  return std::move(atoms_);
}

}  // namespace

ParticleSet make_membrane() { return Membrane().make(); }

}  // namespace motes
