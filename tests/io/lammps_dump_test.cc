// LAMMPS dump files.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "core/error.h"
#include "io/text_fixture.h"

namespace motes {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::ThrowsMessage;

const std::string orthogonal_head =
    "ITEM: TIMESTEP\n7\nITEM: NUMBER OF ATOMS\n2\nITEM: BOX BOUNDS pp ff pp\n-1 9\n0 20\n0 30\n";

TEST(LammpsDump, ReadsColumnsInAnyOrder) {
  const auto particles = read_text("a.dump", orthogonal_head +
                                                 "ITEM: ATOMS z vx type y id x c_s[1]\n"
                                                 "3 0.5 2 2 11 1 nan\n6 -0.5 1 5 9 4 1e-3\n");
  ASSERT_EQ(particles.size(), 2u);
  expect_position(particles, 0, {1, 2, 3});
  expect_position(particles, 1, {4, 5, 6});
  EXPECT_THAT(particles.ids, ElementsAre(11, 9));
  EXPECT_THAT(species_of(particles), ElementsAre("2", "1"));
  EXPECT_THAT(particles.species_names, ElementsAre("1", "2"));
  ASSERT_EQ(particles.properties.size(), 2u);
  EXPECT_EQ(particles.properties[0].name, "vx");
  EXPECT_THAT(particles.properties[0].values, ElementsAre(0.5F, -0.5F));
  EXPECT_TRUE(std::isnan(particles.properties[1].values[0]));
  EXPECT_EQ(particles.time, 7);
  EXPECT_EQ(particles.length_unit, "unknown");
  ASSERT_TRUE(particles.cell);
  EXPECT_EQ(particles.cell->origin, Point3d(-1, 0, 0));
  EXPECT_EQ(particles.cell->vectors[2], Vector3d(0, 0, 30));
  EXPECT_EQ(particles.cell->periodic, (std::array{true, false, true}));
}

TEST(LammpsDump, PrefersWrappedPositionsAndLengths) {
  const auto particles =
      read_text("a.dump", orthogonal_head +
                              "ITEM: ATOMS xsu ysu zsu xu yu zu xs ys zs x y z\n"
                              "9 9 9 8 8 8 7 7 7 1 2 3\n9 9 9 8 8 8 7 7 7 4 5 6\n");
  expect_position(particles, 1, {4, 5, 6});
  EXPECT_TRUE(particles.properties.empty());
}

TEST(LammpsDump, ScaledPositionsAreFractionsOfTheTiltedCell) {
  // Cell (10,0,0), (2,10,0), (-3,1,10) from (0,0,0), as the bounds of its bounding box.
  const auto particles =
      read_text("a.dump",
                "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n1\nITEM: BOX BOUNDS xy xz yz pp pp pp\n"
                "-3 12 2\n0 11 -3\n0 10 1\nITEM: ATOMS xs ys zs\n0.5 0.5 0.5\n");
  ASSERT_TRUE(particles.cell);
  EXPECT_EQ(particles.cell->origin, Point3d(0, 0, 0));
  EXPECT_EQ(particles.cell->vectors[0], Vector3d(10, 0, 0));
  EXPECT_EQ(particles.cell->vectors[1], Vector3d(2, 10, 0));
  EXPECT_EQ(particles.cell->vectors[2], Vector3d(-3, 1, 10));
  expect_position(particles, 0, {4.5, 5.5, 5});
}

TEST(LammpsDump, ReadsGeneralBoxes) {
  const auto particles = read_text(
      "a.dump",
      "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n1\nITEM: BOX BOUNDS abc origin pp pp fs\n"
      "0 2 0 1\n-3 0 0 2\n0 0 4 3\nITEM: ATOMS xs ys zs\n0.5 0.5 0.5\n");
  EXPECT_EQ(particles.cell->vectors[1], Vector3d(-3, 0, 0));
  EXPECT_EQ(particles.cell->periodic, (std::array{true, true, false}));
  expect_position(particles, 0, {-0.5, 3, 5});
}

TEST(LammpsDump, NamesTypesFromTheUserTheElementsOrTheMasses) {
  const std::string masses =
      orthogonal_head + "ITEM: ATOMS type x y z mass\n1 1 1 1 28.0855\n2 2 2 2 16\n";
  Warnings warnings;
  ReadOptions options;
  options.warnings = &warnings;
  EXPECT_THAT(read_text("a.dump", masses, options).species_names, ElementsAre("Si", "O"));
  EXPECT_THAT(warnings.lines(), ElementsAre(HasSubstr("named after their masses: 1=Si,2=O")));
  options.types = {{1, "A"}};
  EXPECT_THAT(read_text("a.dump", masses, options).species_names, ElementsAre("A", "O"));

  const std::string elements =
      orthogonal_head + "ITEM: ATOMS type element x y z\n1 Kr 1 1 1\n2 Ar 2 2 2\n";
  EXPECT_THAT(read_text("a.dump", elements).species_names, ElementsAre("Kr", "Ar"));
  EXPECT_THAT(read_text("a.dump", elements, options).species_names, ElementsAre("A", "2"));
}

TEST(LammpsDump, ReadsUnitsTimeCrLfAndTrailingBlanks) {
  const auto particles = read_text(
      "a.dump",
      "ITEM: UNITS\r\nlj\r\nITEM: TIME\r\n2.5\r\nITEM: TIMESTEP\r\n7\r\nITEM: NUMBER OF ATOMS\r\n"
      "1\r\nITEM: BOX BOUNDS\r\n0 1 \r\n0 1\r\n0 1\r\nITEM: ATOMS x y z \r\n1 2 3 \r\n\r\n");
  EXPECT_EQ(particles.time, 2.5);
  EXPECT_EQ(particles.length_unit, "sigma");
  expect_position(particles, 0, {1, 2, 3});
}

TEST(LammpsDump, ReadsFramesOfDifferentSizeInAnyOrder) {
  std::string text;
  for (int n = 0; n < 5; ++n) {
    text += "ITEM: TIMESTEP\n" + std::to_string(n) + "\nITEM: NUMBER OF ATOMS\n" +
            std::to_string(n) + "\nITEM: BOX BOUNDS pp pp pp\n0 9\n0 9\n0 9\nITEM: ATOMS x y z\n";
    for (int i = 0; i < n; ++i) text += "1 2 3\n";
  }
  const TemporaryFile file("a.dump", text);
  const ReadOptions options;
  const auto trajectory = open_trajectory(file.path(), options);
  for (const std::size_t frame : {3, 0, 4, 1, 2}) {
    EXPECT_EQ(trajectory->read_frame(frame).size(), frame);
    EXPECT_EQ(trajectory->read_frame(frame).time, static_cast<double>(frame));
  }
  EXPECT_EQ(trajectory->num_frames(), 5u);
  EXPECT_THAT([&] { trajectory->read_frame(5); },
              ThrowsMessage<Error>(HasSubstr("has no frame 5; expected 0 to 4")));
}

TEST(LammpsDump, ACutFrameLeavesTheFramesBeforeIt) {
  const std::string frame = orthogonal_head + "ITEM: ATOMS x y z\n1 2 3\n4 5 6\n";
  const TemporaryFile file("a.dump",
                           frame + frame + orthogonal_head + "ITEM: ATOMS x y z\n1 2 3\n");
  Warnings warnings;
  ReadOptions options;
  options.warnings = &warnings;
  const auto trajectory = open_trajectory(file.path(), options);
  EXPECT_EQ(trajectory->read_frame(1).size(), 2u);
  EXPECT_EQ(trajectory->num_frames(), 2u);
  EXPECT_THAT(warnings.lines(),
              ElementsAre(HasSubstr("a.dump:33: the file ends after 1 of 2 atoms")));
  EXPECT_THAT([&] { trajectory->read_frame(2); },
              ThrowsMessage<Error>(HasSubstr("a.dump:33: the file ends after 1 of 2 atoms")));
}

class BadLammpsDump : public testing::TestWithParam<BadText> {};

TEST_P(BadLammpsDump, IsRefusedWithTheLine) {
  EXPECT_THAT([&] { read_text("a.dump", GetParam().text); },
              ThrowsMessage<Error>(HasSubstr(GetParam().message)));
}

INSTANTIATE_TEST_SUITE_P(
    Texts, BadLammpsDump,
    testing::Values(
        BadText{"NoPositions", orthogonal_head + "ITEM: ATOMS id y z\n1 1 1\n2 2 2\n",
                "a.dump:9: expected columns with positions"},
        BadText{"Word", orthogonal_head + "ITEM: ATOMS x y z\n1 2 3\n4 five 6\n",
                "a.dump:11: expected a number for y, found 'five'"},
        BadText{"FewColumns", orthogonal_head + "ITEM: ATOMS x y z\n1 2\n4 5 6\n",
                "a.dump:10: expected 3 columns (x y z), found 2"},
        BadText{"ManyColumns", orthogonal_head + "ITEM: ATOMS x y z\n1 2 3 4\n4 5 6\n",
                "a.dump:10: expected 3 columns (x y z), found '4' after them"},
        BadText{"BlankRow", orthogonal_head + "ITEM: ATOMS x y z\n1 2 3\n\n",
                "a.dump:10: expected 2 rows from here on, found 1"},
        BadText{"ManyRows", orthogonal_head + "ITEM: ATOMS x y z\n1 2 3\n4 5 6\n7 8 9\n",
                "a.dump:12: expected a new frame ('ITEM: TIMESTEP') after 2 atoms"},
        BadText{"FractionalId", orthogonal_head + "ITEM: ATOMS id x y z\n1.5 1 2 3\n2 4 5 6\n",
                "a.dump:10: expected an integer for id, found '1.5'"},
        BadText{"NoCount", "ITEM: TIMESTEP\n1\nITEM: ATOMS x y z\n1 2 3\n",
                "a.dump:3: expected 'ITEM: NUMBER OF ATOMS' before"},
        BadText{"NegativeCount", "ITEM: NUMBER OF ATOMS\n-1\n", "a.dump:2: expected the number of"},
        BadText{"LyingCount",
                "ITEM: NUMBER OF ATOMS\n9000000000000000000\nITEM: ATOMS x y z\n1 2 3\n",
                "a.dump:5: the file ends after 1 of 9000000000000000000 atoms"},
        BadText{"FlatBox",
                "ITEM: NUMBER OF ATOMS\n1\nITEM: BOX BOUNDS pp pp pp\n0 1\n0 0\n0 1\n"
                "ITEM: ATOMS xs ys zs\n0 0 0\n",
                "a.dump:3: expected a box with a volume"}),
    [](const auto& bad) { return bad.param.name; });

}  // namespace
}  // namespace motes
