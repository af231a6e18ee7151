#include "core/error.h"

#include <gtest/gtest.h>

namespace motes {
namespace {

TEST(Error, NamesFileAndLine) {
  EXPECT_STREQ(Error("a.xyz", 3, "expected a number").what(), "a.xyz:3: expected a number");
  EXPECT_STREQ(Error("a.xyz", "is empty").what(), "a.xyz: is empty");
  EXPECT_STREQ(Error("no memory").what(), "no memory");
}

TEST(Error, StaysOnOneLineWhateverTheFileIsCalled) {
  EXPECT_EQ(std::string(Error("a\nb", "bad").what()), "a\\x0ab: bad");
}

TEST(Printable, EscapesAndCuts) {
  EXPECT_EQ(printable("tab\there"), "tab\\x09here");
  EXPECT_EQ(printable(std::string(100, 'x'), 10), "xxxxxxxxxx...");
}

TEST(NearestWord, FindsTypingMistakes) {
  const std::vector<std::string> words{"radius", "weight", "select"};
  EXPECT_EQ(nearest_word("raduis", words), "radius");
  EXPECT_EQ(nearest_word("wieght", words), "weight");
  EXPECT_EQ(nearest_word("zzzzzzzz", words), "");
  EXPECT_EQ(nearest_word("nmae", {"range", "name"}), "name");
}

TEST(NearestWord, FindsPartsInAnyCase) {
  const std::vector<std::string> words{"vx", "v_q", "magma", "SmoothingLength"};
  EXPECT_EQ(nearest_word("q", words), "v_q");
  EXPECT_EQ(nearest_word("mag", words), "magma");
  EXPECT_EQ(nearest_word("MAGMA", words), "magma");
  EXPECT_EQ(nearest_word("smoothing", words), "SmoothingLength");
  EXPECT_EQ(nearest_word("magma_r", words), "magma");
  EXPECT_EQ(nearest_word("magma", {"magma2", "magma"}), "magma");
}

TEST(NearestWord, SuggestsNothingThatIsOnlyAsShort) {
  EXPECT_EQ(nearest_word("q", {"vx", "x"}), "");
  EXPECT_EQ(nearest_word("type", {"c_pe"}), "");
  EXPECT_EQ(nearest_word("jet", {"heat"}), "");
  EXPECT_EQ(nearest_word("Si", {"1", "S", "Ca"}), "");
  EXPECT_EQ(nearest_word("", {"x"}), "");
}

TEST(ClosestWord, IsThereHoweverFar) {
  EXPECT_EQ(closest_word("WIDTH", {"radius", "weight", "select"}), "weight");
  EXPECT_EQ(closest_word("q", {"version", "data", "name"}), "data");
  EXPECT_EQ(closest_word("q", {}), "");
}

TEST(UnknownName, NamesTheNearestOrAll) {
  EXPECT_STREQ(unknown_name("key", "raduis", {"radius", "weight"}).what(),
               "unknown key 'raduis'; did you mean 'radius'?");
  EXPECT_STREQ(unknown_name("property", "zzzzzzzz", {"radius", "weight"}).what(),
               "unknown property 'zzzzzzzz'; there are: radius, weight");
  EXPECT_STREQ(unknown_name("property", "q", {}).what(),
               "unknown property 'q'; there is none here");
}

}  // namespace
}  // namespace motes
