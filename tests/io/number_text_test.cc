// Numbers over any lines.
#include "io/number_text.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <string>

namespace motes {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::ThrowsMessage;

const std::filesystem::path file = "a.cube";

std::vector<double> parse(const NumberText& numbers, std::size_t count) {
  std::vector<double> values(count);
  numbers.parse({}, [&](std::uint64_t i, double value) { values[i] = value; });
  return values;
}

TEST(NumberText, ReadsNumbersOfFortranToo) {
  const NumberText numbers(file, {" 1.5E-2 -.25D+01\n\n\t0.5-101 +3 -1.-5\n1d2", 1}, 6);
  EXPECT_THAT(parse(numbers, 6), ElementsAre(1.5e-2, -2.5, 0.5e-101, 3, -1e-5, 100));
  EXPECT_EQ(numbers.rest().text, "");
}

TEST(NumberText, LeavesWhatFollows) {
  const NumberText numbers(file, {"1 2\n3 4 augmentation\n5\n", 7}, 4);
  EXPECT_THAT(parse(numbers, 4), ElementsAre(1, 2, 3, 4));
  EXPECT_EQ(numbers.rest().text, " augmentation\n5\n");
  EXPECT_EQ(numbers.rest().first_line, 8u);
  EXPECT_THAT(
      [&] { expect_no_more(file, numbers.rest(), 4); },
      ThrowsMessage<Error>(HasSubstr("a.cube:8: expected the end of the file after 4 values, "
                                     "found 'augmentation'")));
  EXPECT_NO_THROW(expect_no_more(file, {" \n\n", 9}, 4));
}

TEST(NumberText, NamesTheLineOfWhatIsNoNumber) {
  for (const char* word : {"***", "1e", "1-2-3", "0x1", "--1", "d"}) {
    const std::string text = std::string("1\n2 ") + word + " 3\n";
    const NumberText numbers(file, {text, 1}, 4);
    EXPECT_THAT([&] { parse(numbers, 4); },
                ThrowsMessage<Error>(
                    HasSubstr("a.cube:2: expected a number, found '" + std::string(word) + "'")));
  }
}

TEST(NumberText, CountsBeforeItParses) {
  EXPECT_THAT(
      [] {
        NumberText(file, {"1 2\n3", 1}, 1000000000000);
      },
      ThrowsMessage<Error>(HasSubstr("a.cube:2: the file ends after 3 of 1000000000000 values")));
}

// More than a chunk, in lines of their own and in a single one.
TEST(NumberText, ReadsLongTextsInOrder) {
  constexpr std::size_t count = 400000;
  for (const char blank : {'\n', ' '}) {
    std::string text;
    for (std::size_t i = 0; i < count; ++i) text += std::to_string(i) + blank;
    text += "end";
    const NumberText numbers(file, {text, 1}, count);
    const std::vector<double> values = parse(numbers, count);
    for (std::size_t i = 0; i < count; ++i) ASSERT_EQ(values[i], static_cast<double>(i));
    EXPECT_EQ(numbers.rest().text, std::string(1, blank) + "end");
    EXPECT_EQ(numbers.rest().first_line, blank == '\n' ? count : 1);
    EXPECT_THAT(
        [&] {
          parse(NumberText(file, {text, 1}, count + 1), count + 1);
        },
        ThrowsMessage<Error>(HasSubstr(blank == '\n'
                                           ? "a.cube:400001: expected a number, found 'end'"
                                           : "a.cube:1: expected a number, found 'end'")));
  }
}

}  // namespace
}  // namespace motes
