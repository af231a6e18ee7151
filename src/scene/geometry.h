// Balls and sticks: what a scene draws of particles besides their fields.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "core/color.h"
#include "core/report.h"
#include "particles/particle_set.h"
#include "scene/selection.h"

namespace motes {

/// Radii from a table of elements: van der Waals (van_der_waals_radius()) or covalent
/// (Cordero et al. 2008), angstrom.
enum class ElementRadius { van_der_waals, covalent };

/// The names that scenes give them.
const std::vector<std::string>& element_radius_names();
std::optional<ElementRadius> element_radius_from_name(std::string_view name);

/// What colours go by: the elements' customary ones, a colour for each species, or, of a particle
/// that a field has, what the transfer function of the first that has it gives at its centre.
enum class ColorBy { element, species, field };

struct ColorByProperty {
  std::string property;
  std::string map = "viridis";
  std::optional<std::pair<double, double>> range;  ///< nullopt: all of the values
  bool operator==(const ColorByProperty&) const = default;
};

/// Which bonds sticks are drawn for: the file's if it has any, else by distance; or one of the two.
enum class BondSource { automatic, file, distance };

/// Balls, or sticks between bonded particles.
struct Geometry {
  enum class Type { spheres, sticks };
  Type type = Type::spheres;
  Selection select;
  /// A table, a number or a property; of sticks a number.
  std::variant<ElementRadius, double, std::string> radius = ElementRadius::van_der_waals;
  double scale = 1;  ///< factor on balls' radii
  std::variant<ColorBy, Color, ColorByProperty> color = ColorBy::element;
  BondSource bonds = BondSource::automatic;  ///< of sticks
  bool operator==(const Geometry&) const = default;
};

/// The particles that are drawn, with all that their balls and sticks need.
struct GeometrySource {
  std::vector<std::uint32_t> index;  ///< into the ParticleSet, increasing
  std::vector<float> radius;  ///< of balls; one an index, or one for all; file's length; 0: none
  /// 0xrrggbb; one an index, or one for all. See by_field().
  std::vector<std::uint32_t> srgb;
  std::vector<Bond> bonds;  ///< between particles that are drawn
  /// One a particle: whether it has bonds by distance, which are found when there is a tree and
  /// join the file's; empty where all are the file's.
  std::vector<bool> bonds_among;
  float stick_radius = 0;  ///< file's length

  bool empty() const { return index.empty(); }
  float radius_of(std::size_t k) const { return radius[radius.size() == 1 ? 0 : k]; }
  std::uint32_t srgb_of(std::size_t k) const { return srgb[srgb.size() == 1 ? 0 : k]; }
};

/// Set beside a GeometrySource's colour that is only for want of a field's.
inline constexpr std::uint32_t for_want_of_field = 0x1000000;
inline bool by_field(std::uint32_t srgb) { return (srgb & for_want_of_field) != 0; }

/// What `geometry` draws of `particles`: of several balls for a particle the last. Where sticks
/// meet there is a ball of their radius at least. Particles whose position is not finite or whose
/// radius is no number are left out, with a warning that counts them; radii of 0 are no balls.
/// Radii from a table are those of radii_by_element(), which reports `progress` where neighbours
/// have to be found. Throws Error, which names the key ("geometry[0].radius: what"), for unknown
/// species and properties and for what selects no particle.
GeometrySource make_geometry_source(const ParticleSet& particles,
                                    const std::vector<Geometry>& geometry, Warnings& warnings,
                                    Progress* progress = nullptr);

/// Gives colours by a property the range that they have.
void fill_in_colors(const ParticleSet& particles, std::vector<Geometry>& geometry);

/// The colour of a species that is no element: colours that are easily told apart.
std::uint32_t other_species_color(std::size_t species);

/// 0xrrggbb, one for each species that the particles have.
std::vector<std::uint32_t> colors_of_species(const ParticleSet& particles, ColorBy by);

}  // namespace motes
