// Base64: the examples of RFC 4648, and what files have besides.
#include "core/base64.h"

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

namespace motes {
namespace {

constexpr std::size_t all = 1000;

TEST(Base64, IsThatOfTheStandard) {
  for (const auto& [bytes, text] :
       {std::pair{"", ""}, std::pair{"f", "Zg=="}, std::pair{"fo", "Zm8="},
        std::pair{"foo", "Zm9v"}, std::pair{"foob", "Zm9vYg=="}, std::pair{"fooba", "Zm9vYmE="},
        std::pair{"foobar", "Zm9vYmFy"}}) {
    EXPECT_EQ(encode_base64(bytes), text);
    EXPECT_EQ(decode_base64(text, all), bytes);
  }
  EXPECT_EQ(encode_base64("\xfb\xff"), "+/8=");
}

TEST(Base64, GoesOnBehindPaddingAndBlanks) {
  EXPECT_EQ(decode_base64(" Zg==\n Zm8=Zm9v ", all), "ffofoo");
}

TEST(Base64, StopsWhereItIsTold) {
  EXPECT_EQ(decode_base64("Zm9vYmFy<no base64>", 6), "foobar");
  EXPECT_EQ(decode_base64("Zm9vYmFy", 4), "foob");
  EXPECT_EQ(decode_base64("Zm9vYmFy<no base64>", 7), std::nullopt);
  EXPECT_EQ(decode_base64("Zm9", all), "fo");
}

RC_GTEST_PROP(Base64, GivesAllBytesBack, (const std::string& bytes)) {
  RC_ASSERT(decode_base64(encode_base64(bytes), bytes.size()) == bytes);
}

}  // namespace
}  // namespace motes
