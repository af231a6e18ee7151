// Numbers in text.
#include "io/text.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <bit>
#include <cmath>
#include <cstdlib>
#include <limits>

namespace motes {
namespace {

void expect_as_strtod(const std::string& text) {
  const auto value = to_real(text);
  ASSERT_TRUE(value) << text;
  const double expected = std::strtod(text.c_str(), nullptr);
  EXPECT_EQ(std::bit_cast<std::uint64_t>(*value), std::bit_cast<std::uint64_t>(expected)) << text;
}

TEST(ToReal, ReadsWhatStrtodReads) {
  for (const char* text : {"0",
                           "-0",
                           "+1",
                           "1.",
                           ".5",
                           "-.5e1",
                           "1e22",
                           "1e23",
                           "1e-22",
                           "1e-23",
                           "9007199254740993",
                           "0.1",
                           "123456789012345678",
                           "1234567890123456789012345",
                           "0.000000000000000000000000001",
                           "1e308",
                           "1e309",
                           "-1e999",
                           "4.9e-324",
                           "1e-400",
                           "inf",
                           "-inf",
                           "INF",
                           "Infinity",
                           "1.0000000000000000000000000000000000001",
                           "1E+05",
                           "1e00005"}) {
    expect_as_strtod(text);
  }
  EXPECT_TRUE(std::isnan(to_real("nan").value()));
  EXPECT_TRUE(std::isnan(to_real("-NaN").value()));
}

TEST(ToReal, RefusesWhatIsNoNumber) {
  for (const char* text : {"", ".", "-", "+", "e5", "1e", "1e+", "1.2.3", "12a", "--1", "+-1", "1 ",
                           " 1", "0x10", "1,5", "*****", "n", "1d5"}) {
    EXPECT_FALSE(to_real(text)) << text;
  }
}

RC_GTEST_PROP(ToReal, IsExact, ()) {
  const auto bits = *rc::gen::arbitrary<std::uint64_t>();
  const auto value = std::bit_cast<double>(bits);
  if (!std::isfinite(value)) return;
  expect_as_strtod(fmt::format("{}", value));
  expect_as_strtod(fmt::format("{:.16e}", value));
  expect_as_strtod(fmt::format("{:g}", value));
  const double small = std::remainder(value, 1e6);
  expect_as_strtod(fmt::format("{:.8f}", small));
  expect_as_strtod(fmt::format("{:g}", small));
}

TEST(ToInteger, KeepsToIntegers) {
  EXPECT_EQ(to_integer("9223372036854775807"), std::numeric_limits<std::int64_t>::max());
  EXPECT_EQ(to_integer("-5"), -5);
  EXPECT_EQ(to_integer("+5"), 5);
  for (const char* text : {"", "9223372036854775808", "1.0", "1e5", "+", "+-5", "5x", " 5"}) {
    EXPECT_FALSE(to_integer(text)) << text;
  }
}

TEST(LineReader, NamesTheLineOfWhatIsNoCount) {
  const std::filesystem::path file("a.txt");
  LineReader lines(file, {" 12 \r\n-1\n", 5}, true);
  EXPECT_EQ(lines.parse_count(lines.next(""), "a count"), 12u);
  EXPECT_THAT([&] { lines.parse_count(lines.next(""), "a count"); },
              testing::ThrowsMessage<Error>("a.txt:6: expected a count, found '-1'"));
}

TEST(LineReader, CountsTheBlankLinesThatItSkips) {
  const std::filesystem::path file("a.txt");
  LineReader lines(file, {"\n \r\n  one\ntwo\n\n ", 5}, true);
  EXPECT_TRUE(lines.skip_blank_lines());
  EXPECT_EQ(lines.rest().first_line, 7u);
  EXPECT_EQ(lines.next(""), "  one");
  EXPECT_TRUE(lines.skip_blank_lines());
  EXPECT_EQ(lines.next(""), "two");
  EXPECT_FALSE(lines.skip_blank_lines());
  EXPECT_EQ(lines.rest().first_line, 11u);
  EXPECT_TRUE(lines.rest().text.empty());
  EXPECT_FALSE(lines.skip_blank_lines());
  EXPECT_EQ(lines.rest().first_line, 11u);
  LineReader part(file, {"\n\n", 5}, false);
  EXPECT_THROW(part.skip_blank_lines(), TextEnds);
}

TEST(LineReader, CountsLinesWhateverTheyEndIn) {
  const std::filesystem::path file("a.txt");
  LineReader lines(file, {"one\r\n\n two \nend", 5}, true);
  EXPECT_EQ(lines.next(""), "one");
  EXPECT_EQ(lines.line(), 5u);
  EXPECT_EQ(lines.next_filled(""), " two ");
  EXPECT_EQ(lines.line(), 7u);
  EXPECT_EQ(lines.peek(), "end");
  EXPECT_EQ(lines.next(""), "end");
  EXPECT_FALSE(lines.skip_blank_lines());
  EXPECT_THROW(lines.next("more"), TextEnds);
}

}  // namespace
}  // namespace motes
