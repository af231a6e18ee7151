// Tables of kernels from files.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>

#include "core/error.h"
#include "scene/kernel.h"

namespace motes {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

std::filesystem::path write_file(const std::string& text) {
  // Tests run side by side.
  const std::string test = testing::UnitTest::GetInstance()->current_test_info()->name();
  auto path = std::filesystem::path(testing::TempDir()) / (test + "_profile.txt");
  std::ofstream(path) << text;
  return path;
}

std::string message_of(const std::string& text) {
  try {
    read_radial_profile(write_file(text));
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(RadialProfile, ReadsTwoColumns) {
  const RadialProfile profile =
      read_radial_profile(write_file("# r rho\n0 2.5\r\n0.5,1\n\n1.0\t; 0.25\n  1.5 0"));
  EXPECT_DOUBLE_EQ(profile.spacing, 0.5);
  EXPECT_THAT(profile.values, ElementsAre(2.5, 1, 0.25, 0));
}

TEST(RadialProfile, TakesRoundedDistancesForEven) {
  const RadialProfile profile = read_radial_profile(write_file("0 3\n0.3333 2\n0.6667 1\n1 0.5\n"));
  EXPECT_EQ(profile.values.size(), 4U);
  EXPECT_NEAR(profile.spacing, 1. / 3, 1e-12);
}

TEST(RadialProfile, MakesUnevenDistancesEven) {
  // A parabola, which the monotone cubic follows closely where points are close.
  std::string text;
  for (int i = 0; i <= 300; ++i) {
    const double q = 2 * std::pow(i / 300., 1.5);
    text += std::to_string(q) + " " + std::to_string(1 - q * q / 4) + "\n";
  }
  const RadialProfile profile = read_radial_profile(write_file(text));
  ASSERT_EQ(profile.values.size(), 1025U);
  for (std::size_t i = 0; i < profile.values.size(); i += 50) {
    const double q = static_cast<double>(i) * profile.spacing;
    EXPECT_NEAR(profile.values[i], 1 - q * q / 4, 2e-5);
  }
}

TEST(RadialProfile, NamesFileAndLine) {
  EXPECT_THAT(
      message_of("0 1\n1 x\n"),
      HasSubstr("NamesFileAndLine_profile.txt:2: expected a distance and a value, found '1 x'"));
  EXPECT_THAT(message_of("0 1\n1\n"), HasSubstr(":2: expected a distance and a value"));
  EXPECT_THAT(message_of("0 1 2\n1 3 4\n"), HasSubstr(":1: expected a distance and a value"));
  EXPECT_THAT(message_of("0 1\n1 nan\n"), HasSubstr(":2: expected a distance and a value"));
  EXPECT_THAT(message_of("0.1 1\n1 0\n"), HasSubstr(":1: expected distances from 0 on"));
  EXPECT_THAT(
      message_of("0 1\n2 0.5\n2 0\n"),
      HasSubstr(":3: expected distances from 0 on, each larger than the one before, found 2"));
  EXPECT_THAT(message_of("0 1\n"), HasSubstr("expected two or more lines"));
  EXPECT_THAT(message_of(""), HasSubstr("expected two or more lines"));
}

}  // namespace
}  // namespace motes
