// Gaussian cube files: the atoms and the grids.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "io/grid_fixture.h"
#include "io/text_fixture.h"

namespace motes {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr double bohr = 0.529177210903;  // angstrom

/// Two atoms, 2 x 3 x 4 voxels. Value (i, j, k) is 100 i + 10 j + k, z running fastest.
std::string cube(const std::string& atoms_line = "2 1 -2 0.5", const std::string& sign = "") {
  std::string text = "water\nof sorts\n" + atoms_line + "\n" + sign + "2 0.5 0 0\n" + sign +
                     "3 0 1 0.25\n" + sign + "4 0 0 2\n8 0.0 1 2 3\n1 0.0 -1 0 0.5\n";
  return text;
}

std::string values(int num_fields = 1) {
  std::string text;
  for (int i = 0; i < 2; ++i) {
    for (int j = 0; j < 3; ++j) {
      for (int k = 0; k < 4; ++k) {
        for (int f = 0; f < num_fields; ++f) {
          text += " " + std::to_string(1000 * f + 100 * i + 10 * j + k);
        }
      }
      text += "\n";
    }
  }
  return text;
}

void expect_values(const Grid& grid, float offset) {
  ASSERT_EQ(grid.values.size(), 24u);
  for (std::size_t k = 0; k < 4; ++k) {
    for (std::size_t j = 0; j < 3; ++j) {
      for (std::size_t i = 0; i < 2; ++i) {
        EXPECT_EQ(grid.values[grid.index(i, j, k)],
                  offset + static_cast<float>(100 * i + 10 * j + k));
      }
    }
  }
}

TEST(Cube, GivesItsGridInAngstroms) {
  const auto grids = grids_of("a.cube", cube() + values());
  ASSERT_EQ(grids.size(), 1u);
  const Grid& grid = grids[0];
  EXPECT_EQ(grid.name, "value");
  EXPECT_THAT(grid.dims, ElementsAre(2, 3, 4));
  expect_vector(Vector3d(grid.origin), bohr * Vector3d{1, -2, 0.5});
  expect_vector(grid.steps[0], bohr * Vector3d{0.5, 0, 0});
  expect_vector(grid.steps[1], bohr * Vector3d{0, 1, 0.25});
  expect_vector(grid.steps[2], bohr * Vector3d{0, 0, 2});
  expect_vector(Vector3d(grid.position(1, 2, 3)), bohr * Vector3d{1.5, 0, 7});
  EXPECT_FALSE(grid.periodic);
  EXPECT_EQ(grid.length_unit, "angstrom");
  expect_values(grid, 0);
}

TEST(Cube, GivesItsAtoms) {
  const ParticleSet atoms = read_text("a.cube", cube() + values());
  EXPECT_THAT(species_of(atoms), ElementsAre("O", "H"));
  expect_position(atoms, 0, Point3d{} + bohr * Vector3d{1, 2, 3});
  EXPECT_EQ(atoms.length_unit, "angstrom");
  expect_vector(atoms.cell->vectors[1], bohr * Vector3d{0, 3, 0.75});
  EXPECT_EQ(atoms.cell->periodic[0], false);
  EXPECT_THAT(atoms.properties, IsEmpty()) << "charges that are all zero say nothing";
  // The atoms do not wait for the values.
  EXPECT_EQ(read_text("a.cube", cube()).size(), 2u);
}

TEST(Cube, NegativeNumbersOfVoxelsAreInAngstroms) {
  const std::string text = cube("2 1 -2 0.5", "-") + values();
  const Grid grid = grids_of("a.cube", text)[0];
  expect_vector(Vector3d(grid.origin), {1, -2, 0.5});
  expect_vector(grid.steps[1], {0, 1, 0.25});
  expect_values(grid, 0);
  expect_position(read_text("a.cube", text), 1, {-1, 0, 0.5});
}

TEST(Cube, NegativeNumberOfAtomsMeansOrbitals) {
  const auto grids = grids_of("a.cube", cube("-2 0 0 0") + "3 7\n12\n 5\n" + values(3));
  ASSERT_EQ(grids.size(), 3u);
  EXPECT_EQ(grids[0].name, "orbital_7");
  EXPECT_EQ(grids[1].name, "orbital_12");
  EXPECT_EQ(grids[2].name, "orbital_5");
  for (std::size_t f = 0; f < 3; ++f) expect_values(grids[f], 1000 * static_cast<float>(f));
  EXPECT_EQ(read_text("a.cube", cube("-2 0 0 0") + "1 7\n" + values()).size(), 2u);
}

TEST(Cube, SeveralValuesAVoxelAreGrids) {
  const auto grids = grids_of("a.cube", cube("2 0 0 0 2") + values(2));
  ASSERT_EQ(grids.size(), 2u);
  EXPECT_EQ(grids[0].name, "value_1");
  EXPECT_EQ(grids[1].name, "value_2");
  expect_values(grids[1], 1000);
}

TEST(Cube, ChargesAreAPropertyWhereTheySaySomething) {
  const std::string head = "a\nb\n2 0 0 0\n1 1 0 0\n1 0 1 0\n1 0 0 1\n";
  EXPECT_THAT(read_text("a.cube", head + "8 8 0 0 0\n1 1 0 0 0\n1\n").properties, IsEmpty());
  const ParticleSet atoms = read_text("a.cube", head + "8 6.0 0 0 0\n1 1 0 0 0\n1\n");
  ASSERT_NE(atoms.find_property("charge"), nullptr);
  EXPECT_THAT(atoms.find_property("charge")->values, ElementsAre(6, 1));
}

TEST(Cube, OfOnePeriodIsPeriodic) {
  for (const char* const titles : {"density\nContains the selected quantity on a FFT grid\n",
                                   " Cubefile created from PWScf calculation\nin angstrom\n"}) {
    const std::string text =
        titles + cube().substr(std::string("water\nof sorts\n").size()) + values();
    EXPECT_TRUE(grids_of("a.cube", text)[0].periodic) << titles;
    EXPECT_TRUE(read_text("a.cube", text).cell->periodic[2]) << titles;
  }
}

TEST(Cube, HasItsAtomsInThePeriodicCell) {
  const std::string rest = cube().substr(std::string("water\nof sorts\n").size()) + values();
  const ParticleSet as_they_are = read_text("a.cube", "a\nb\n" + rest);
  const ParticleSet moved = read_text("a.cube", "PWScf\nb\n" + rest);
  // Of edges (1, 0, 0), (0, 3, 0.75) and (0, 0, 8) from (1, -2, 0.5): one has (0, 4/3, 3/16),
  // the other (-2, 2/3, -1/16).
  expect_position(moved, 0, as_they_are.position(0) - bohr * Vector3d{0, 3, 0.75});
  expect_position(moved, 1, as_they_are.position(1) + bohr * Vector3d{2, 0, 8});
}

TEST(Cube, IsKnownByItsContent) {
  const TemporaryFile file("density.txt", cube() + values());
  EXPECT_TRUE(is_grid_file(file.path()));
  EXPECT_EQ(open_trajectory(file.path(), {})->format(), "cube");
  // An XYZ file with numbers for names begins much the same.
  const TemporaryFile xyz("a.xyz", "5\n\n8 0 0 0\n1 1 0 0\n1 0 1 0\n1 0 0 1\n1 0 0 2\n");
  EXPECT_FALSE(is_grid_file(xyz.path()));
  EXPECT_EQ(open_trajectory(xyz.path(), {})->format(), "XYZ");
}

TEST(Cube, CutShortIsRefused) {
  expect_refused_when_cut("a.cube", cube() + values());
  expect_refused_when_cut("a.cube", cube("-2 0 0 0") + "2 7 12\n" + values(2));
}

class BadCube : public testing::TestWithParam<BadText> {};

TEST_P(BadCube, IsRefusedWithTheLine) {
  EXPECT_THAT(grid_error("a.cube", GetParam().text), HasSubstr(GetParam().message));
}

std::string with_axes(const std::string& axes) {
  return "a\nb\n1 0 0 0\n" + axes + "1 0 0 0 0\n1 2 3\n";
}

INSTANTIATE_TEST_SUITE_P(
    Texts, BadCube,
    testing::Values(
        BadText{"NoCount", "a\nb\nmany 0 0 0\n",
                "a.cube:3: expected the number of atoms and the grid's origin, found 'many 0 0 0'"},
        BadText{"NoValuesAVoxel", cube("2 0 0 0 0") + values(),
                "a.cube:3: expected a number of values a voxel of 1 to 1000, found 0"},
        BadText{"ValuesAndOrbitals", cube("-2 0 0 0 2") + "1 1\n" + values(),
                "a.cube:3: expected a number of values a voxel of 1, found 2"},
        BadText{"NoVoxels", with_axes("0 1 0 0\n1 0 1 0\n1 0 0 1\n"),
                "a.cube:4: expected a number of voxels other than 0"},
        BadText{"MixedSigns", with_axes("1 1 0 0\n-1 0 1 0\n1 0 0 1\n"),
                "a.cube:6: expected numbers of voxels of one sign"},
        BadText{"HugeCount", with_axes("9999999999 1 0 0\n1 0 1 0\n1 0 0 1\n"),
                "a.cube:4: expected a number of voxels and their vector"},
        BadText{"TooLarge", with_axes("10000 1 0 0\n10000 0 1 0\n10000 0 0 1\n"),
                "a.cube: samples, 10000 x 10000 x 10000 of them, of more than"},
        BadText{"Flat", with_axes("2 1 0 0\n2 2 0 0\n2 0 0 1\n"),
                "a.cube: has steps between its samples that span no volume"},
        BadText{"FewValues", with_axes("2 1 0 0\n2 0 1 0\n1 0 0 1\n"),
                "a.cube:9: the file ends after 3 of 4 values"},
        BadText{"ManyValues", with_axes("2 1 0 0\n1 0 1 0\n1 0 0 1\n"),
                "a.cube:8: expected the end of the file after 2 values, found '3'"},
        BadText{"NoNumber", with_axes("4 1 0 0\n1 0 1 0\n1 0 0 1\n") + "four\n",
                "a.cube:9: expected a number, found 'four'"},
        BadText{"BadAtom", "a\nb\n1 0 0 0\n1 1 0 0\n1 0 1 0\n1 0 0 1\nO 0 0 0 0\n1\n",
                "a.cube:7: expected an integer for number, found 'O'"},
        BadText{"NoOrbitals", cube("-2 0 0 0") + "0\n" + values(),
                "a.cube:9: expected at least 1 orbital"},
        BadText{"ManyOrbitals", cube("-2 0 0 0") + "1 2 3\n" + values(),
                "a.cube:9: expected 1 orbitals, found 2"}),
    [](const auto& bad) { return bad.param.name; });

}  // namespace
}  // namespace motes
