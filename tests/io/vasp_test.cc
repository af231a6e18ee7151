// VASP's structures, and the volumes behind them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "io/grid_fixture.h"
#include "io/text_fixture.h"

namespace motes {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

const std::string cell = "2.0\n1 0 0\n1 2 0\n0 0 4\n";  // twice that: a volume of 64
const std::string positions = "0 0 0\n0.5 0.5 0.5\n0.25 0 0.75\n";
const std::string structure = "salt\n" + cell + "Na Cl\n1 2\nDirect\n" + positions + "\n";
const std::string grid = "2 1 3\n";
/// x runs fastest.
const std::string values = " 0 64 .128E+03 192 256\n 320\n";
const std::string density = structure + grid + values;
const std::string occupancies =
    "augmentation occupancies   1   3\n 1.0 2.0\n 3.0\naugmentation occupancies   2   1\n .5-101\n";

TEST(Vasp, GivesItsDensity) {
  const auto grids = grids_of("CHGCAR", density);
  ASSERT_EQ(grids.size(), 1u);
  EXPECT_EQ(grids[0].name, "density");
  EXPECT_THAT(grids[0].dims, ElementsAre(2, 1, 3));
  EXPECT_THAT(grids[0].values, ElementsAre(0, 1, 2, 3, 4, 5)) << "in units of the volume";
  expect_vector(Vector3d(grids[0].origin), {0, 0, 0});
  expect_vector(grids[0].steps[0], {1, 0, 0});
  expect_vector(grids[0].steps[1], {2, 4, 0});
  expect_vector(grids[0].steps[2], {0, 0, 8. / 3});
  EXPECT_TRUE(grids[0].periodic);
  EXPECT_EQ(grids[0].length_unit, "angstrom");
}

TEST(Vasp, GivesItsAtoms) {
  for (const std::string& text : {structure, density}) {
    const ParticleSet atoms = read_text("CHGCAR", text);
    EXPECT_THAT(species_of(atoms), ElementsAre("Na", "Cl", "Cl"));
    expect_position(atoms, 1, {2, 2, 4});
    expect_position(atoms, 2, {0.5, 0, 6});
    expect_vector(atoms.cell->vectors[1], {2, 4, 0});
    EXPECT_TRUE(atoms.cell->periodic[0]);
    EXPECT_EQ(atoms.length_unit, "angstrom");
  }
}

// Those of structures alone stay where the file has them.
TEST(Vasp, HasItsAtomsInTheCellOfItsGrid) {
  std::string text = density;
  text.replace(text.find("0.25 0 0.75"), 11, "1.25 -1 0.9999999999");
  const ParticleSet atoms = read_text("CHGCAR", text);
  expect_position(atoms, 2, Point3d{0.5, 0, -8e-10});
  const ParticleSet alone = read_text("POSCAR", text.substr(0, text.find(grid + values)));
  expect_position(alone, 2, Point3d{0.5 * 1.0 + 2 - 2, -4, 8});
}

TEST(Vasp, SecondBlockIsTheSpin) {
  const std::string moments = "1.0 -1.0\n 0.5\n";
  const std::string second = " 2  1  3\n64 0 0 0 0\n -.64E+02\n" + occupancies;
  for (const std::string& between :
       {std::string(), occupancies, moments, occupancies + moments, "\n" + occupancies}) {
    std::string text = density;
    text += between;
    text += second;
    const auto grids = grids_of("CHGCAR", text);
    ASSERT_EQ(grids.size(), 2u) << between;
    EXPECT_EQ(grids[1].name, "spin");
    EXPECT_THAT(grids[0].values, ElementsAre(0, 1, 2, 3, 4, 5));
    EXPECT_THAT(grids[1].values, ElementsAre(1, 0, 0, 0, 0, -1));
  }
  const auto grids =
      grids_of("CHGCAR", structure + grid + values + grid + values + grid + values + grid + values);
  ASSERT_EQ(grids.size(), 4u);
  EXPECT_EQ(grids[3].name, "spin_z");
}

TEST(Vasp, PotentialsAreNoDensities) {
  for (const auto& [file, name] :
       {std::pair{"LOCPOT", "potential"}, std::pair{"ELFCAR.gz", "elf"}}) {
    const auto grids = grids_of(file, density);
    EXPECT_EQ(grids[0].name, name);
    EXPECT_EQ(grids[0].values[1], 64);
  }
}

TEST(Vasp, ReadsOlderHeadersAndOtherScales) {
  // VASP 4: the species, if anywhere, are in the title.
  const std::string rest = cell + "1 2\nDirect\n" + positions;
  EXPECT_THAT(species_of(read_text("POSCAR", "Na Cl\n" + rest)), ElementsAre("Na", "Cl", "Cl"));
  EXPECT_THAT(species_of(read_text("POSCAR", "table salt\n" + rest)), ElementsAre("1", "2", "2"));
  ReadOptions options;
  options.types = {{1, "Li"}};
  EXPECT_THAT(species_of(read_text("POSCAR", structure, options)), ElementsAre("Li", "Cl", "Cl"));

  // A negative scale is the volume, three are one an axis.
  const std::string vectors = "1 0 0\n1 2 0\n0 0 4\n";
  const std::string atom = "Fe_pv/3a9c\n1\nSelective dynamics\nCartesian\n1 1 1 T F T\n";
  const ParticleSet by_volume = read_text("POSCAR", "a\n-64\n" + vectors + atom);
  expect_vector(by_volume.cell->vectors[1], {2, 4, 0});
  expect_position(by_volume, 0, {2, 2, 2});
  EXPECT_THAT(species_of(by_volume), ElementsAre("Fe"));
  const ParticleSet by_axis = read_text("POSCAR", "a\n1 2 3\n" + vectors + atom);
  expect_vector(by_axis.cell->vectors[1], {1, 4, 0});
  expect_position(by_axis, 0, {1, 2, 3});
}

TEST(Vasp, IsKnownByItsContent) {
  const TemporaryFile chgcar("salt.txt", density), poscar("salt", structure);
  const TemporaryFile moving("CONTCAR", structure + "0 0 0\n1 1 1\n0.5 0 0\n");
  EXPECT_TRUE(is_grid_file(chgcar.path()));
  EXPECT_FALSE(is_grid_file(poscar.path()));
  EXPECT_FALSE(is_grid_file(moving.path())) << "velocities are no grid";
  for (const auto& file : {chgcar.path(), poscar.path(), moving.path()}) {
    EXPECT_EQ(open_trajectory(file, {})->format(), "VASP");
  }
}

TEST(Vasp, VolumesByTheirNameAreGridsHoweverBad) {
  const std::string negative = std::string(structure).append("2 -1 3\n").append(values);
  for (const std::string& text : {std::string(structure), negative}) {
    for (const std::string name : {"CHGCAR", "AECCAR0.gz", "LOCPOT_bulk"}) {
      const TemporaryFile file(name, text);
      EXPECT_TRUE(is_grid_file(file.path())) << name;
    }
  }
}

TEST(Vasp, CutShortIsRefused) {
  expect_refused_when_cut("CHGCAR", density);
  // With what follows the first block, pieces that end behind it are good.
  const std::string whole = density + occupancies + grid + values;
  for (std::size_t length = density.size() + 1; length < whole.size(); ++length) {
    Warnings warnings;
    const std::string error = grid_error("CHGCAR", whole.substr(0, length), &warnings);
    if (error.empty()) continue;
    EXPECT_TRUE(error.starts_with("CHGCAR:")) << error;
  }
}

TEST(Vasp, SaysThatAnAtomMayBeCutShort) {
  const TemporaryFile file("POSCAR", structure.substr(0, structure.size() - 3));
  Warnings warnings;
  ReadOptions options;
  options.warnings = &warnings;
  open_trajectory(file.path(), options);
  EXPECT_THAT(warnings.lines(), ElementsAre(HasSubstr("POSCAR:11: the last line has no end")));
}

class BadVasp : public testing::TestWithParam<BadText> {};

TEST_P(BadVasp, IsRefusedWithTheLine) {
  EXPECT_THAT(grid_error("CHGCAR", GetParam().text), HasSubstr(GetParam().message));
}

INSTANTIATE_TEST_SUITE_P(
    Texts, BadVasp,
    testing::Values(
        BadText{"NoScale", "a\none\n", "CHGCAR:2: expected the scale of the cell"},
        BadText{"ZeroScale", "a\n0\n1 0 0\n", "CHGCAR:2: expected the scale of the cell"},
        BadText{"ShortVector", "a\n1\n1 0\n",
                "CHGCAR:3: expected a vector of the cell, found '1 0'"},
        BadText{"Flat", "a\n1\n1 0 0\n0 1 0\n1 1 0\nNa\n1\nDirect\n0 0 0\n",
                "CHGCAR:5: expected three vectors that span a cell with a volume"},
        BadText{"NoCounts", "a\n" + cell + "Na Cl\nmany\n",
                "CHGCAR:7: expected the number of atoms of each species, found 'many'"},
        BadText{"FewCounts", "a\n" + cell + "Na Cl\n3\nDirect\n" + positions,
                "CHGCAR:7: expected 2 numbers of atoms, one a species, found 1"},
        BadText{"NoAtoms", "a\n" + cell + "Na Cl\n0 0\nDirect\n" + positions, "at least 1"},
        BadText{"NoMode", "a\n" + cell + "Na Cl\n1 2\n" + positions,
                "CHGCAR:8: expected Direct or Cartesian, found '0 0 0'"},
        BadText{"FewAtoms", "a\n" + cell + "Na Cl\n9 2\nDirect\n" + positions,
                "CHGCAR:12: the file ends after 3 of 11 atoms"},
        BadText{"NoGrid", structure, "CHGCAR: has no grid behind its atoms"},
        BadText{"ZeroGrid", structure + "2 0 3\n",
                "CHGCAR:13: expected the three numbers of a grid behind 3 atoms, found '2 0 3'"},
        BadText{"NegativeGrid", structure + "2 -1 3\n",
                "CHGCAR:13: expected the three numbers of a grid"},
        BadText{"HugeGrid", structure + "10000 10000 10000\n1 2\n", "CHGCAR: samples, 10000 x"},
        BadText{"Overflow",
                structure + "9000000000000000000 9000000000000000000 9000000000000000000\n1\n",
                "CHGCAR: samples, 9000000000000000000 x"},
        BadText{"FewValues", structure + "2 2 3\n" + values,
                "CHGCAR:16: the file ends after 6 of 12 values"},
        BadText{
            "ManyValues", structure + grid + "0 1 2 3 4\n5 6\n",
            "CHGCAR:15: expected the end of the line after 6 values (2 x 1 x 3 by line 13), found "
            "'6'"},
        BadText{"ManyLines", structure + grid + values + "1 2 3.5\n",
                "CHGCAR:16: expected the grid's 2 1 3 again behind the numbers after 6 values (2 x "
                "1 x 3 by line 13)"},
        BadText{"SmallGrid", structure + "1 1 3\n1 2 3\n4 5 6 7\n",
                "CHGCAR:15: expected 3 numbers of atoms or the end of the file after 3 values (1 x "
                "1 x 3 by line 13), found '7' behind 3 of them"},
        BadText{"Junk", structure + grid + values + "junk\n",
                "CHGCAR:16: expected augmentation occupancies, the grid's 2 1 3 again"},
        BadText{"OtherGrid", structure + grid + values + "3 1 2\n" + values,
                "CHGCAR:16: expected the grid's 2 1 3 again, found '3 1 2'"},
        BadText{"Stars", structure + grid + "1 2 3 4 5\n*****\n",
                "CHGCAR:15: expected a number, found '*****'"},
        BadText{"ThreeBlocks", structure + grid + values + grid + values + grid + values,
                "CHGCAR: has 3 blocks of values; expected 1, 2 or 4"}),
    [](const auto& bad) { return bad.param.name; });

}  // namespace
}  // namespace motes
