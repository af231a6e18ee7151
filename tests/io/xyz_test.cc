// XYZ and extended XYZ files.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "io/text_fixture.h"

namespace motes {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::ThrowsMessage;

TEST(Xyz, ReadsPlainFrames) {
  const TemporaryFile file("a.xyz",
                           "  2\r\ncomment = \"\r\n  C 0 0 0\r\nXx\t1 2e0 -3 0.5 more\r\n"
                           "1\n\nHe 1 1 1\n\n0\nempty\n");
  const ReadOptions options;
  const auto trajectory = open_trajectory(file.path(), options);
  EXPECT_EQ(trajectory->num_frames(), 3u);
  const auto particles = trajectory->read_frame(0);
  EXPECT_THAT(species_of(particles), ElementsAre("C", "Xx"));
  expect_position(particles, 1, {1, 2, -3});
  EXPECT_EQ(particles.length_unit, "angstrom");
  EXPECT_FALSE(particles.cell);
  EXPECT_EQ(trajectory->read_frame(1).size(), 1u);
  EXPECT_EQ(trajectory->read_frame(2).size(), 0u);
}

TEST(Xyz, AtomicNumbersBecomeSymbols) {
  EXPECT_THAT(species_of(read_text("a.xyz", "3\n\n14 0 0 0\n8 1 1 1\n999 2 2 2\n")),
              ElementsAre("Si", "O", "999"));
}

TEST(Xyz, ReadsTheExtendedForm) {
  const auto particles = read_text(
      "a.xyz",
      "2\nBare Lattice=\"10 0 0  1 10 0  0 0 10\" Origin=\"-1 -2 -3\" pbc=\"T F 1\" time=2.5 "
      "name='a b' Properties=id:I:1:pos:R:3:velo:R:3:ok:L:1:species:S:1:f:R:2:note:S:1:masses:R:1\n"
      "7 1 2 3 4 5 6 T O 0.5 0.25 a 16\n9 4 5 6 7 8 9 false Si 1.5 1.25 b 28\n");
  ASSERT_EQ(particles.size(), 2u);
  expect_position(particles, 1, {4, 5, 6});
  EXPECT_THAT(species_of(particles), ElementsAre("O", "Si"));
  EXPECT_THAT(particles.ids, ElementsAre(7, 9));
  EXPECT_THAT(particles.find_property("vy")->values, ElementsAre(5, 8));
  EXPECT_THAT(particles.find_property("ok")->values, ElementsAre(1, 0));
  EXPECT_THAT(particles.find_property("f_2")->values, ElementsAre(0.25F, 1.25F));
  EXPECT_THAT(particles.find_property("mass")->values, ElementsAre(16, 28));
  EXPECT_EQ(particles.find_property("note"), nullptr);
  EXPECT_EQ(particles.time, 2.5);
  ASSERT_TRUE(particles.cell);
  EXPECT_EQ(particles.cell->origin, Point3d(-1, -2, -3));
  EXPECT_EQ(particles.cell->vectors[1], Vector3d(1, 10, 0));
  EXPECT_EQ(particles.cell->periodic, (std::array{true, false, true}));
}

class BadXyz : public testing::TestWithParam<BadText> {};

TEST_P(BadXyz, IsRefusedWithTheLine) {
  EXPECT_THAT([&] { read_text("a.xyz", GetParam().text); },
              ThrowsMessage<Error>(HasSubstr(GetParam().message)));
}

INSTANTIATE_TEST_SUITE_P(
    Texts, BadXyz,
    testing::Values(
        BadText{"NoCount", "two\n\nC 0 0 0\n",
                "a.xyz:1: expected the number of atoms, found 'two'"},
        BadText{"FewRows", "2\n\nC 0 0 0\n", "a.xyz:4: the file ends after 1 of 2 atoms"},
        BadText{"LyingCount", "999999999999\n\nC 0 0 0\n",
                "a.xyz:4: the file ends after 1 of 999999999999 atoms"},
        BadText{"ManyRows", "1\n\nC 0 0 0\nC 0 0 0\n",
                "a.xyz:4: expected the number of atoms of a new frame after 1 atoms"},
        BadText{"FewColumns", "1\n\nC 0 0\n",
                "a.xyz:3: expected 4 columns (species x y z), found 3"},
        BadText{"NoNumber", "1\n\nC 0 0 z\n", "a.xyz:3: expected a number for z, found 'z'"},
        BadText{"NoPositions", "1\nProperties=species:S:1\nC\n", "a.xyz:2: expected pos:R:3"},
        BadText{"BadType", "1\nProperties=species:S:1:pos:Q:3\nC 0 0 0\n",
                "a.xyz:2: expected Properties=NAME:TYPE:COUNT"},
        BadText{"ManyColumns", "1\nProperties=species:S:1:pos:R:3:a:R:999999999\nC 0 0 0\n",
                "a.xyz:2: expected Properties=NAME:TYPE:COUNT"},
        BadText{"ShortLattice", "1\nLattice=\"1 2\"\nC 0 0 0\n",
                "a.xyz:2: expected 9 numbers for Lattice, found 2"},
        BadText{"WordLattice", "1\nLattice=\"1 0 0 0 1 0 0 0 one\"\nC 0 0 0\n",
                "a.xyz:2: expected numbers for Lattice, found 'one'"},
        BadText{"BadPbc", "1\nLattice=\"1 0 0 0 1 0 0 0 1\" pbc=\"T T\"\nC 0 0 0\n",
                "a.xyz:2: expected three of T and F for pbc"},
        BadText{"NoLogical", "1\nProperties=species:S:1:pos:R:3:ok:L:1\nC 0 0 0 maybe\n",
                "a.xyz:3: expected T or F for ok, found 'maybe'"}),
    [](const auto& bad) { return bad.param.name; });

}  // namespace
}  // namespace motes
