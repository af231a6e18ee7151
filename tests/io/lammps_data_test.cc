// LAMMPS data files.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "io/text_fixture.h"

namespace motes {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::ThrowsMessage;

ParticleSet read_data(const std::string& text, const ReadOptions& options = {}) {
  return read_text("a.data", text, options);
}

TEST(LammpsData, ReadsAllThatItKnows) {
  Warnings warnings;
  ReadOptions options;
  options.warnings = &warnings;
  const auto particles = read_data(
      "LAMMPS data file via write_data, version 29 Sep 2021, timestep = 20, units = metal\n\n"
      "3 atoms\n2 atom types\n2 bonds\n1 bond types\n"
      "1 11 xlo xhi\n 2\t12  ylo   yhi # comment\n3 13 zlo zhi\n1 2 3 xy xz yz\n\n"
      "Masses\n\n1 28.0855\n2 15.9994 # O2\n\n"
      "Pair Coeffs # lj/cut\n\n1 1 1\n2 1 1\n\n"
      "Atoms # full\n\n30 1 1 0.5 1 2 3 0 0 0\n10 1 2 -0.25 4 5 6 1 0 0\n\n20 1 2 0 7 8 9 0 0 "
      "-1\n\n"
      "Velocities\n\n20 7 8 9\n# a comment\n30 1 2 3\n10 4 5 6\n\n"
      "Bonds\n\n1 1 30 20\n2 1 10 30\n",
      options);
  ASSERT_EQ(particles.size(), 3u);
  expect_position(particles, 1, {4, 5, 6});
  EXPECT_THAT(particles.ids, ElementsAre(30, 10, 20));
  EXPECT_THAT(species_of(particles), ElementsAre("Si", "O2", "O2"));
  EXPECT_THAT(warnings.lines(), ElementsAre(HasSubstr("named after their masses: 1=Si")));
  EXPECT_THAT(particles.find_property("q")->values, ElementsAre(0.5F, -0.25F, 0.0F));
  EXPECT_THAT(particles.find_property("mol")->values, ElementsAre(1, 1, 1));
  EXPECT_THAT(particles.find_property("vy")->values, ElementsAre(2, 5, 8));
  EXPECT_THAT(particles.bonds, ElementsAre(Bond{0, 2}, Bond{0, 1}));
  EXPECT_EQ(particles.time, 20);
  EXPECT_EQ(particles.length_unit, "angstrom");
  ASSERT_TRUE(particles.cell);
  EXPECT_EQ(particles.cell->origin, Point3d(1, 2, 3));
  EXPECT_EQ(particles.cell->vectors[2], Vector3d(2, 3, 10));
}

TEST(LammpsData, ReadsGeneralBoxesAndTypeLabels) {
  const auto particles = read_data(
      "title\n1 atoms\n1 atom types\n0 2 0 avec\n-3 0 0 bvec\n0 0 4 cvec\n1 1 1 abc origin\n\n"
      "Atom Type Labels\n\n1 Si\n\nAtoms # atomic\n\n1 1 0 0 0\n");
  EXPECT_EQ(particles.cell->origin, Point3d(1, 1, 1));
  EXPECT_EQ(particles.cell->vectors[1], Vector3d(-3, 0, 0));
  EXPECT_THAT(species_of(particles), ElementsAre("Si"));
}

TEST(LammpsData, FindsTheStyleFromTheRows) {
  const auto x_of = [](const std::string& row) {
    return read_data("title\n1 atoms\n2 atom types\n\nAtoms\n\n" + row + "\n").position(0).x;
  };
  EXPECT_EQ(x_of("1 2 5 6 7"), 5);
  EXPECT_EQ(x_of("1 2 5 6 7 0 0 1"), 5);
  EXPECT_EQ(x_of("1 1 2 5 6 7"), 5);
  EXPECT_EQ(x_of("1 2 0.5 5 6 7 # charge"), 5);
  EXPECT_EQ(x_of("1 1 2 0.5 5 6 7 0 0 0"), 5);
  EXPECT_EQ(x_of("1 2 0.5 1.5 5 6 7"), 5);
}

TEST(LammpsData, ReducedUnitsHaveNoElements) {
  const std::string head = "title\n2 atoms\n2 atom types\n\nMasses\n\n1 1\n2 2\n\n";
  EXPECT_THAT(read_data(head + "Atoms\n\n1 1 0 0 0\n2 2 1 1 1\n").species_names,
              ElementsAre("1", "2"));
}

TEST(LammpsData, AFileOfNoAtomsHasNone) {
  const auto particles =
      read_data("title\n0 atoms\n0 atom types\n0 1 xlo xhi\n0 1 ylo yhi\n0 1 zlo zhi\n");
  EXPECT_EQ(particles.size(), 0u);
  EXPECT_TRUE(particles.cell);
}

TEST(LammpsData, LeavesOutBondsToMissingAtoms) {
  const std::string head =
      "title\n2 atoms\n1 atom types\n3 bonds\n\nAtoms\n\n1 1 0 0 0\n2 1 0 0 1\n\nBonds\n\n1 1 1 "
      "2\n";
  Warnings warnings;
  ReadOptions options;
  options.warnings = &warnings;
  const auto particles = read_data(head + "\n2 1 2 7\n3 1 8 9\n", options);
  EXPECT_THAT(particles.bonds, ElementsAre(Bond{0, 1}));
  EXPECT_THAT(warnings.lines(), testing::Contains(HasSubstr(
                                    "a.data:15: 2 bonds to atoms that are not there left out, "
                                    "of which this is the first")));
}

class BadLammpsData : public testing::TestWithParam<BadText> {};

TEST_P(BadLammpsData, IsRefused) {
  EXPECT_THAT([&] { read_data(GetParam().text); },
              ThrowsMessage<Error>(HasSubstr(GetParam().message)));
}

INSTANTIATE_TEST_SUITE_P(
    Texts, BadLammpsData,
    testing::Values(
        BadText{"NoHeader", "title\n\nAtoms\n\n1 1 0 0 0\n", "expected a header line 'N atoms'"},
        BadText{"NoKeyword", "title\n2 atoms\n1 atom types\n0.5\n",
                "a.data:4: expected a keyword of the header"},
        BadText{"NoAtoms", "title\n2 atoms\n1 atom types\n", "a section Atoms with 2 atoms"},
        BadText{"EmptyAtoms", "title\n2 atoms\n1 atom types\n\nAtoms\n\n",
                "a.data:7: the file ends after 0 of 2 atoms"},
        BadText{"FewAtoms", "title\n2 atoms\n1 atom types\n\nAtoms\n\n1 1 0 0 0\n",
                "a.data:8: the file ends after 1 of 2 atoms"},
        BadText{"FewColumns", "title\n2 atoms\n1 atom types\n\nAtoms\n\n1 1 0 0 0\n2 1 0 0\n",
                "a.data:8: expected 5 columns (id type x y z), found 4"},
        BadText{"NoStyle", "title\n1 atoms\n1 atom types\n\nAtoms # mine\n\n1 1 0 0\n",
                "a.data:7: expected the columns of an atom style"},
        BadText{"NegativeCount", "title\n-2 atoms\n1 atom types\n",
                "a.data:2: expected the number of atoms"},
        BadText{"ShortBox", "title\n2 atoms\n1 atom types\n1 xlo xhi\n",
                "a.data:4: expected 2 numbers before 'xlo xhi'"},
        BadText{"NoBonds", "title\n1 atoms\n1 atom types\n3 bonds\n\nAtoms\n\n1 1 0 0 0\n",
                "expected a section Bonds with 3 bonds"},
        BadText{"WrongVelocity",
                "title\n2 atoms\n1 atom types\n\nAtoms\n\n1 1 0 0 0\n2 1 0 0 1\n\nVelocities\n\n"
                "1 0 0 0\n7 0 0 0\n",
                "a.data:13: expected the id of an atom, found 7"},
        BadText{"WrongMass", "title\n1 atoms\n1 atom types\n\nMasses\n\n1 heavy\n",
                "a.data:7: expected a type and its mass"}),
    [](const auto& bad) { return bad.param.name; });

}  // namespace
}  // namespace motes
