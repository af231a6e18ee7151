// PDB: columns, elements, models, bonds, faults.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "io/reader.h"
#include "support/shared_data.h"
#include "support/truncation.h"

namespace motes {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

const std::string two_atoms =
    "CRYST1   10.000   20.000   30.000  90.00  90.00  90.00 P 1           1\n"
    "ATOM      1  CA  ALA A   1       1.000   2.000   3.000  0.50 20.00           C\n"
    "HETATM    7 ZN    ZN A   2      -4.000   5.500  -6.125  1.00  1.50\n";

ParticleSet read(const std::string& content, std::size_t frame = 0) {
  const TemporaryFile file("a.pdb", content);
  Warnings warnings;
  ReadOptions options;
  options.warnings = &warnings;
  return open_trajectory(file.path(), options)->read_frame(frame);
}

std::string error_of(const std::string& content) {
  const TemporaryFile file("a.pdb", content);
  return error_of_reading(file.path());
}

TEST(Pdb, ReadsColumns) {
  const ParticleSet particles = read(two_atoms + "CONECT    1    7\nCONECT    7    1\nEND\n");
  ASSERT_EQ(particles.size(), 2u);
  EXPECT_EQ(particles.position(1), Point3d(-4, 5.5, -6.125));
  EXPECT_THAT(particles.species_names, ElementsAre("C", "Zn"));
  EXPECT_THAT(particles.ids, ElementsAre(1, 7));
  EXPECT_THAT(particles.find_property("occupancy")->values, ElementsAre(0.5, 1));
  EXPECT_THAT(particles.find_property("b_factor")->values, ElementsAre(20, 1.5));
  EXPECT_THAT(particles.bonds, ElementsAre(Bond{0, 1}));
  EXPECT_EQ(particles.cell->vectors[2], Vector3d(0, 0, 30));
  EXPECT_EQ(particles.length_unit, "angstrom");
}

TEST(Pdb, WarnsWhereTheFileEndsWithAnAtom) {
  for (const bool whole : {true, false}) {
    const TemporaryFile file("a.pdb", two_atoms + (whole ? "END\n" : ""));
    Warnings warnings;
    ReadOptions options;
    options.warnings = &warnings;
    EXPECT_EQ(open_trajectory(file.path(), options)->read_frame(0).size(), 2u);
    if (whole) {
      EXPECT_THAT(warnings.lines(), IsEmpty());
    } else {
      EXPECT_THAT(warnings.lines(), ElementsAre(HasSubstr("may be cut short")));
    }
  }
}

TEST(Pdb, ReadsModelsAsFramesWithTheCellOfTheFile) {
  const std::string model =
      "MODEL        1\nATOM      1  O   HOH A   1       1.000   2.000   3.000\nENDMDL\n";
  std::string second = model;
  second.replace(second.find("1.000"), 5, "9.000");
  const std::string content =
      two_atoms.substr(0, two_atoms.find('\n') + 1) + model + second + "END\n";
  const TemporaryFile file("a.pdb", content);
  EXPECT_EQ(open_trajectory(file.path(), {})->num_frames(), 2u);
  EXPECT_EQ(read(content, 0).position(0).x, 1);
  EXPECT_EQ(read(content, 1).position(0).x, 9);
  EXPECT_EQ(read(content, 1).cell->vectors[0].x, 10);
  EXPECT_THAT(error_of(content + model.substr(0, model.find("ENDMDL"))), IsEmpty());
  EXPECT_THAT(error_of(model.substr(0, model.find("ENDMDL"))),
              HasSubstr("a.pdb:2: ends within a model; expected ENDMDL"));
}

TEST(Pdb, ReadsFramesThatENDSeparates) {
  const TemporaryFile file("a.pdb", two_atoms + "END\n" + two_atoms + "END\n");
  EXPECT_EQ(open_trajectory(file.path(), {})->num_frames(), 2u);
}

TEST(Pdb, IgnoresThePlaceholderOfACell) {
  std::string content = two_atoms;
  content.replace(0, content.find('\n'),
                  "CRYST1    1.000    1.000    1.000  90.00  90.00  90.00 P 1           1");
  EXPECT_FALSE(read(content).cell.has_value());
}

TEST(Pdb, MakesTriclinicCells) {
  std::string content = two_atoms;
  content.replace(0, content.find('\n'),
                  "CRYST1    2.000    4.000    6.000  60.00  90.00 120.00 P 1           1");
  const auto vectors = read(content).cell->vectors;
  EXPECT_NEAR(dot(vectors[1], vectors[2]), 4 * 6 * 0.5, 1e-9);
  EXPECT_NEAR(dot(vectors[0], vectors[2]), 0, 1e-9);
  EXPECT_NEAR(dot(vectors[0], vectors[1]), 2 * 4 * -0.5, 1e-9);
  EXPECT_NEAR(length(vectors[2]), 6, 1e-9);
}

TEST(Pdb, KeepsTheFirstOfAlternateLocations) {
  const ParticleSet particles = read(
      "ATOM      1  CA AALA A   1       1.000   2.000   3.000  0.50 20.00           C\n"
      "ATOM      2  CA BALA A   1       9.000   2.000   3.000  0.50 20.00           C\n"
      "ATOM      3  CA AALA A   2       5.000   2.000   3.000  0.50 20.00           C\n");
  ASSERT_EQ(particles.size(), 2u);
  EXPECT_EQ(particles.position(1).x, 5);
}

TEST(Pdb, NamesTheLineOfAFault) {
  std::string stars = two_atoms;
  stars.replace(stars.find(" 5.500"), 6, "******");
  EXPECT_THAT(error_of(stars), HasSubstr("a.pdb:3: expected the coordinate y in columns 39 to 46"));
  EXPECT_THAT(error_of(two_atoms + "ATOM      8  O   HOH A   3      -4.000   5.500  -6.1\n"),
              HasSubstr("a.pdb:4: expected the coordinate z"));
  EXPECT_THAT(error_of("HEADER\nTITLE\nREMARK\nREMARK\nREMARK\nEND\n"),
              HasSubstr("expected ATOM or HETATM"));
  EXPECT_THAT(error_of("CRYST1   10.000   20.000\n" + two_atoms),
              HasSubstr("a.pdb:1: expected three"));
}

TEST(Pdb, KnowsItselfFromItsContent) {
  const TemporaryFile file("structure", two_atoms);
  EXPECT_EQ(open_trajectory(file.path(), {})->format(), "PDB");
}

TEST(Pdb, CutShortIsAnErrorOfOneLineOrCorrect) {
  std::string content = two_atoms;
  for (int i = 0; i < 50; ++i) content += two_atoms.substr(two_atoms.find("ATOM"));
  expect_clear_errors_when_cut("a.pdb", content + "END\n");
}

TEST(SharedPdbs, OfHaemoglobinHaveItsElements) {
  const auto path = shared_file("files/pdb/4hhb.pdb");
  if (!path) GTEST_SKIP() << "4hhb.pdb is not here";
  const ParticleSet particles = open_trajectory(*path, {})->read_frame(0);
  EXPECT_THAT(particles.species_names,
              testing::UnorderedElementsAre("N", "C", "O", "S", "Fe", "P"));
  EXPECT_FALSE(particles.bonds.empty());
}

TEST(SharedPdbs, ThatAreDamagedAreRefusedWithTheLine) {
  const auto path = shared_file("bad/made/pdb_stars_in_coordinates.pdb");
  if (!path) GTEST_SKIP() << "bad/made is not here";
  EXPECT_THAT(error_of_reading(*path), HasSubstr("expected the coordinate"));
}

}  // namespace
}  // namespace motes
