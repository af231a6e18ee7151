// What every reader makes and all rendering starts from: particles as a structure of arrays.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/vec.h"
#include "particles/cell.h"

namespace motes {

/// A named value of each particle, as the file has it. Readers give vectors as three properties
/// (vx, vy, vz). Names that Motes gives a meaning: "mass"; "h", the smoothing length as the code
/// defines it; "radius", the standard deviation of the Gaussian that stands for the particle;
/// "density"; "charge".
struct Property {
  std::string name;
  std::vector<float> values;  ///< one a particle
};

/// A bond between two particles, by index into the ParticleSet; first <= second.
struct Bond {
  std::uint32_t first = 0, second = 0;
  /// To which of the second's images: so many edges (MinimumImage::edges()) from the one that is
  /// nearest to the first.
  std::array<std::int8_t, 3> image{};
  bool operator==(const Bond&) const = default;
};

/// Particles of one frame. Position of particle i: origin + (x[i], y[i], z[i]); the floats are kept
/// near zero by the double-precision origin, so coordinates of 1e6 keep features of 1e-2.
struct ParticleSet {
  Point3d origin;
  std::vector<float> x, y, z;

  std::vector<std::string> species_names;  ///< distinct; element symbols where known
  std::vector<std::uint16_t> species;      ///< index into species_names; one a particle, or empty
  std::vector<std::int64_t> ids;           ///< the file's own numbers; one a particle, or empty
  std::vector<Property> properties;
  /// Whether particles without a radius (no property "radius", or NaN there) have the size that
  /// their neighbours' distance gives, as N-body particles do: see default_radii().
  bool radii_from_neighbors = false;
  std::vector<Bond> bonds;
  /// Whether there are others, which are for distances to tell: PDB files list those of ligands.
  bool bonds_are_partial = false;

  std::optional<Cell> cell;
  std::optional<double> time;  ///< the file's own unit
  std::string length_unit;     ///< "angstrom" for molecular formats, the file's unit, or "unknown"

  std::size_t size() const { return x.size(); }
  Point3d position(std::size_t i) const { return origin + Vector3d{x[i], y[i], z[i]}; }
  /// The property of that name, or null.
  const Property* find_property(std::string_view name) const;
  /// Index of `name` in species_names, added if it is not there.
  std::uint16_t species_index(std::string_view name);
  /// Box of the finite positions in world coordinates; empty if there are none.
  Bounds3d bounds() const;
};

/// Sets origin and x, y, z from positions in double precision (arrays of one length): the origin is
/// the middle of the finite positions' box, rounded so that small shifts are exact in float.
void set_positions(ParticleSet& particles, const std::vector<double>& x,
                   const std::vector<double>& y, const std::vector<double>& z);

/// The same from positions in single precision, in place.
void set_positions(ParticleSet& particles, std::vector<float> x, std::vector<float> y,
                   std::vector<float> z);

}  // namespace motes
