// GRO files.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "io/atom_names.h"
#include "io/text_fixture.h"

namespace motes {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::ThrowsMessage;

const std::string water =
    "Water, t= 2.5 step= 10\n    3\n"
    "    1SOL     OW99999   0.230   0.628   0.113 -0.1000  0.2000  0.3000\n"
    "    1SOL    HW1    0   0.137   0.626   0.150-10.1227  0.0000  0.0000\n"
    "    1SOL    HW2    1   0.231   0.589   0.021  0.0000  0.0000  0.0000\n"
    "   1.0   2.0   3.0\n";

TEST(Gro, ReadsAngstromsFromNanometres) {
  const auto particles = read_text("a.gro", water);
  ASSERT_EQ(particles.size(), 3u);
  expect_position(particles, 1, {1.37, 6.26, 1.5});
  EXPECT_THAT(species_of(particles), ElementsAre("O", "H", "H"));
  EXPECT_THAT(particles.ids, ElementsAre(99999, 100000, 100001));
  EXPECT_FLOAT_EQ(particles.find_property("vx")->values[1], -101.227F);
  EXPECT_EQ(particles.time, 2.5);
  EXPECT_EQ(particles.length_unit, "angstrom");
  EXPECT_EQ(particles.cell->vectors[1], Vector3d(0, 20, 0));
}

TEST(Gro, ReadsMoreDigitsAndTriclinicBoxes) {
  const auto particles = read_text("a.gro",
                                   "title\n1\n    1LIG     CL    1   0.12345   1.12345  10.12345\n"
                                   "1 2 3 0 0 0.5 0 0.25 0.75\n");
  expect_position(particles, 0, {1.2345, 11.2345, 101.2345});
  EXPECT_THAT(species_of(particles), ElementsAre("Cl"));
  EXPECT_EQ(particles.cell->vectors[1], Vector3d(5, 20, 0));
  EXPECT_EQ(particles.cell->vectors[2], Vector3d(2.5, 7.5, 30));
}

TEST(Gro, ReadsFramesAndBoxesWithoutVolume) {
  const std::string empty = "nothing\n0\n0 0 0\n";
  const TemporaryFile file("a.gro", water + empty + water + "\n\n");
  const ReadOptions options;
  const auto trajectory = open_trajectory(file.path(), options);
  EXPECT_EQ(trajectory->num_frames(), 3u);
  EXPECT_EQ(trajectory->read_frame(1).size(), 0u);
  EXPECT_FALSE(trajectory->read_frame(1).cell);
  EXPECT_EQ(trajectory->read_frame(2).size(), 3u);
}

TEST(Gro, BeadsKeepTheirNames) {
  const auto particles = read_text("a.gro",
                                   "title\n2\n    1DPPC   NC3    1   0.000   0.000   0.000\n"
                                   "    1DPPC   C1A    2   0.000   0.000   0.000\n1 1 1\n");
  EXPECT_THAT(species_of(particles), ElementsAre("NC3", "C1A"));
}

TEST(GuessElement, KnowsPlacesFromElements) {
  EXPECT_EQ(guess_element("CA", "ALA"), "C");
  EXPECT_EQ(guess_element("CA", "CA2+"), "Ca");
  EXPECT_EQ(guess_element("1HB2", "ALA"), "H");
  EXPECT_EQ(guess_element("NA", "HEM"), "N");
  EXPECT_EQ(guess_element("NA", "NA"), "Na");
  EXPECT_EQ(guess_element("CL3", "LIG"), "Cl");
  EXPECT_EQ(guess_element("ZN", "ZN2"), "Zn");
  EXPECT_EQ(guess_element("MW", "SOL"), "MW");
}

class BadGro : public testing::TestWithParam<BadText> {};

TEST_P(BadGro, IsRefusedWithTheLine) {
  EXPECT_THAT([&] { read_text("a.gro", GetParam().text); },
              ThrowsMessage<Error>(HasSubstr(GetParam().message)));
}

const std::string row = "    1SOL     OW    1   0.230   0.628   0.113\n";

INSTANTIATE_TEST_SUITE_P(
    Texts, BadGro,
    testing::Values(
        BadText{"NoCount", "title\nmany\n", "a.gro:2: expected the number of atoms, found 'many'"},
        BadText{"FewRows", "title\n3\n" + row + row, "a.gro:5: the file ends after 2 of 3 atoms"},
        BadText{"NoBox", "title\n2\n" + row + row,
                "a.gro:5: the file ends here; expected the line of"},
        BadText{"ManyRows", "title\n1\n" + row + row + "1 1 1\n",
                "a.gro:4: expected the 3 or 9 numbers of the box"},
        BadText{"NoPosition", "title\n1\n    1SOL     OW    1\n1 1 1\n",
                "a.gro:3: expected a row with residue, atom and position"},
        BadText{"NoNumber", "title\n1\n    1SOL     OW    1   0.230   0.6x8   0.113\n1 1 1\n",
                "a.gro:3: expected a position of three numbers"},
        BadText{"BlankRow", "title\n2\n" + row + "\n1 1 1\n", "a.gro:3: expected 2 atoms"}),
    [](const auto& bad) { return bad.param.name; });

}  // namespace
}  // namespace motes
