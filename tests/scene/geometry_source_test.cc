// Which balls and bonds a scene's geometry comes to, and what its JSON may be.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <utility>

#include "core/error.h"
#include "scene/geometry.h"
#include "scene/scene.h"

namespace motes {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;

ParticleSet water() {
  ParticleSet particles;
  particles.x = {0, 0.96F, -0.24F, 5};
  particles.y = {0, 0, 0.93F, 5};
  particles.z = {0, 0, 0, 5};
  particles.species_names = {"O", "H", "X"};
  particles.species = {0, 1, 1, 2};
  particles.properties = {{"size", {2, 0, 1, NAN}}, {"q", {-1, 1, 3, 0}}};
  particles.length_unit = "angstrom";
  return particles;
}

GeometrySource source_of(const std::string& geometry, Warnings& warnings) {
  const std::string text =
      R"({"version": 1, "data": {"path": "a.xyz"}, "geometry": )" + geometry + "}";
  return make_geometry_source(water(), parse_scene(text, "s.json").geometry, warnings);
}

std::string message_of(const std::string& geometry) {
  Warnings warnings;
  try {
    source_of(geometry, warnings);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(GeometrySource, TakesRadiiFromElements) {
  Warnings warnings;
  const GeometrySource source = source_of(
      R"([{"type": "spheres", "scale": 0.5, "select": {"species": ["O", "H"]}}])", warnings);
  EXPECT_THAT(source.index, ElementsAre(0, 1, 2));
  EXPECT_THAT(source.radius, ElementsAre(0.76F, 0.6F, 0.6F));  // half of 1.52 and 1.20
  EXPECT_THAT(source.srgb, ElementsAre(0xff0d0d, 0xffffff, 0xffffff));
}

TEST(GeometrySource, TakesPropertiesAndLeavesOutWhatIsNone) {
  Warnings warnings;
  const GeometrySource source = source_of(
      R"([{"type": "spheres", "radius": "size",
           "color": {"property": "q", "map": "grey", "range": [-1, 3]}}])",
      warnings);
  EXPECT_THAT(source.index, ElementsAre(0, 1, 2));
  EXPECT_THAT(source.radius, ElementsAre(2, 0, 1));
  EXPECT_LT(source.srgb[0], source.srgb[1]);
  EXPECT_LT(source.srgb[1], source.srgb[2]);
  EXPECT_THAT(warnings.lines(), ElementsAre(HasSubstr("1 of 4 particles are not drawn")));
}

TEST(GeometrySource, ColoursByCoordinatesUnlessAPropertyHasTheName) {
  ParticleSet particles;
  particles.origin = {0, 0, 100};
  particles.x = particles.y = {0, 0, 0};
  particles.z = {0, 1, 2};
  Geometry balls;
  balls.radius = 1.0;
  balls.color = ColorByProperty{"z", "grey", {{101, 102}}};
  Warnings warnings;
  const auto colors = make_geometry_source(particles, {balls}, warnings).srgb;
  EXPECT_EQ(colors[0], colors[1]);
  EXPECT_LT(colors[1], colors[2]);
  particles.properties = {{"z", {102, 101, 101}}};
  const auto by_property = make_geometry_source(particles, {balls}, warnings).srgb;
  EXPECT_THAT(by_property, ElementsAre(colors[2], colors[1], colors[1]));
}

TEST(GeometrySource, FillsInTheRangesOfColours) {
  std::vector<Geometry> geometry(2);
  geometry[0].color = ColorByProperty{"q", "viridis", {}};
  geometry[0].select.species = {"O", "H"};
  fill_in_colors(water(), geometry);
  using Range = std::pair<double, double>;
  EXPECT_EQ(std::get<ColorByProperty>(geometry[0].color).range, Range(-1, 3));
  geometry[0].color = ColorByProperty{"size", "heat", Range(7, 8)};
  geometry[1].color = ColorByProperty{"size", "viridis", {}};  // NaN is none
  fill_in_colors(water(), geometry);
  EXPECT_EQ(std::get<ColorByProperty>(geometry[0].color).range, Range(7, 8));
  EXPECT_EQ(std::get<ColorByProperty>(geometry[1].color).range, Range(0, 2));
}

TEST(GeometrySource, LeavesBondsByDistanceToTheTreeAndDrawsJoints) {
  Warnings warnings;
  const GeometrySource source = source_of(
      R"([{"type": "spheres", "radius": 0.1, "select": {"species": "O"}},
          {"type": "sticks", "radius": 0.2, "color": "#0000ff"}])",
      warnings);
  EXPECT_THAT(source.bonds_among, ElementsAre(true, true, true, true));
  EXPECT_FLOAT_EQ(source.stick_radius, 0.2F);
  // The oxygen keeps its colour, but no ball is thinner than its sticks.
  EXPECT_THAT(source.radius, ElementsAre(0.2F)) << "of all";
  EXPECT_THAT(source.srgb, ElementsAre(0xff0d0d, 0x0000ff, 0x0000ff, 0x0000ff));
}

/// Two pairs of particles, each of which touches its partner at a radius of 0.5.
ParticleSet pairs(std::string species) {
  ParticleSet particles;
  particles.x = {0, 1, 9, 9};
  particles.y = {0, 0, 0, 1};
  particles.z = {0, 0, 0, 0};
  particles.species_names = {std::move(species)};
  particles.species = {0, 0, 0, 0};
  return particles;
}

TEST(GeometrySource, TakesParticlesOwnSizesWithoutElements) {
  Geometry balls;
  balls.scale = 2;
  for (const bool named : {true, false}) {
    ParticleSet particles = pairs("dark matter");
    if (!named) {
      particles.species.clear();
      particles.species_names.clear();
    }
    Warnings warnings;
    EXPECT_THAT(make_geometry_source(particles, {balls}, warnings).radius, ElementsAre(1));
    EXPECT_THAT(warnings.lines(),
                ElementsAre("van der Waals radii: none of the particles is of a chemical element; "
                            "taken instead: half the mean distance of nearest neighbours"));
    particles.properties = {{"radius", {3, 4, 5, 6}}};
    EXPECT_THAT(make_geometry_source(particles, {balls}, warnings).radius,
                ElementsAre(6, 8, 10, 12));
    EXPECT_THAT(warnings.lines(), Contains(HasSubstr("the file's radii or smoothing lengths")));
  }
  // A name that no particle has makes no elements of them.
  ParticleSet particles = pairs("dark matter");
  particles.species_names.emplace_back("C");
  Warnings warnings;
  EXPECT_THAT(make_geometry_source(particles, {balls}, warnings).radius, ElementsAre(1));
}

TEST(GeometrySource, SaysWhereNoBondIsBetweenSelectedParticles) {
  Geometry sticks;
  sticks.type = Geometry::Type::sticks;
  sticks.radius = 0.1;
  ParticleSet particles = pairs("C");
  particles.bonds = {{0, 1}, {2, 3}};
  Warnings warnings;
  EXPECT_EQ(make_geometry_source(particles, {sticks}, warnings).bonds, particles.bonds);
  EXPECT_THAT(warnings.lines(), ElementsAre());
  EXPECT_THAT(make_geometry_source(particles, {sticks}, warnings).bonds_among, ElementsAre());
  // Where there are others, they are for distances to tell.
  particles.bonds_are_partial = true;
  EXPECT_EQ(make_geometry_source(particles, {sticks}, warnings).bonds, particles.bonds);
  EXPECT_THAT(make_geometry_source(particles, {sticks}, warnings).bonds_among,
              ElementsAre(true, true, true, true));
  sticks.bonds = BondSource::file;
  EXPECT_THAT(make_geometry_source(particles, {sticks}, warnings).bonds_among, ElementsAre());
  particles.bonds_are_partial = false;
  sticks.select.index = {{1, 2}};
  EXPECT_THAT(make_geometry_source(particles, {sticks}, warnings).bonds, ElementsAre());
  EXPECT_THAT(warnings.lines(),
              ElementsAre(HasSubstr("none of the 2 bonds is between two particles that are both "
                                    "selected")));
}

TEST(GeometrySource, RefusesWithOneClearLine) {
  EXPECT_THAT(message_of(R"([{"type": "cubes"}])"),
              HasSubstr("geometry[0].type: expected \"spheres\" or \"sticks\""));
  EXPECT_THAT(message_of(R"([{"type": "spheres", "radius": 0}])"),
              HasSubstr("geometry[0].radius: expected \"van_der_waals\""));
  EXPECT_THAT(message_of(R"([{"type": "sticks", "scale": 2}])"),
              HasSubstr("geometry[0].scale: sticks have none"));
  EXPECT_THAT(message_of(R"([{"type": "sticks"}, {"type": "sticks"}])"),
              HasSubstr("geometry[1]: expected sticks only once"));
  EXPECT_THAT(message_of(R"([{"type": "spheres", "color": "blu"}])"),
              HasSubstr("geometry[0].color: expected \"element\""));
  EXPECT_THAT(message_of(R"([{"type": "spheres", "radius": "siez"}])"),
              HasSubstr("geometry[0].radius: unknown property 'siez'; did you mean 'size'?"));
  EXPECT_THAT(message_of(R"([{"type": "spheres", "select": {"species": "Si"}}])"),
              HasSubstr("geometry[0].select: unknown species 'Si'"));
  EXPECT_THAT(message_of(R"([{"type": "sticks", "bonds": "file"}])"),
              HasSubstr("geometry[0].bonds: the file has none"));
}

}  // namespace
}  // namespace motes
