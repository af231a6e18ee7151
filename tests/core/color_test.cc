// The sRGB encoding against its standard.
#include "core/color.h"

#include <gtest/gtest.h>

namespace motes {
namespace {

TEST(Srgb, AgreesWithTheStandard) {
  EXPECT_EQ(srgb_to_linear(0), 0);
  EXPECT_DOUBLE_EQ(srgb_to_linear(1), 1);
  EXPECT_NEAR(srgb_to_linear(0.5), 0.21404114, 1e-8);
  EXPECT_NEAR(srgb_to_linear(0.04), 0.04 / 12.92, 1e-15);
  EXPECT_NEAR(linear_to_srgb(0.18), 0.46135613, 1e-8);
}

TEST(Srgb, ThereAndBackIsTheSameByte) {
  for (int byte = 0; byte < 256; ++byte) {
    EXPECT_NEAR(linear_to_srgb(srgb_to_linear(byte / 255.)) * 255, byte, 1e-4);
  }
}

}  // namespace
}  // namespace motes
