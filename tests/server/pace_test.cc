// How pictures keep up with the hand.
#include "server/pace.h"

#include <gtest/gtest.h>

#include <chrono>

namespace motes::server {
namespace {

using namespace std::chrono_literals;

/// What a frame takes whose full picture takes `full_ms`.
double ms_of(double scale, double full_ms) { return 3 + full_ms * scale * scale; }

class PaceOf : public testing::TestWithParam<double> {};

TEST_P(PaceOf, ComesToFifteenFramesASecond) {
  Pace pace;
  for (int frame = 0; frame < 30; ++frame) pace.took(pace.scale(), ms_of(pace.scale(), GetParam()));
  const double ms = ms_of(pace.scale(), GetParam());
  if (pace.scale() > Pace::smallest) {
    EXPECT_LE(ms, 1000.0 / 15);
  }
  if (pace.scale() < 1) {  // and no smaller than it has to be
    EXPECT_GE(ms, 0.5 * Pace::budget_ms);
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, PaceOf, testing::Values(1, 20, 60, 150, 800, 2500, 100000));

TEST(Pace, FallsAtOnceAndRisesSlowly) {
  Pace pace;
  for (int frame = 0; frame < 30; ++frame) pace.took(pace.scale(), 5);
  EXPECT_EQ(pace.scale(), 1);
  pace.took(1, 400);
  EXPECT_LE(ms_of(pace.scale(), 400), 1000.0 / 15);
  const double before = pace.scale();
  pace.took(before, 1);
  EXPECT_LE(pace.scale(), 1.2 * before);
}

TEST(Link, HasRoomForTwo) {
  Link link;
  const auto now = Link::Clock::now();
  EXPECT_TRUE(link.has_room());
  link.sent(1, 1000, now);
  EXPECT_TRUE(link.has_room());
  link.sent(2, 1000, now);
  EXPECT_FALSE(link.has_room());
  link.acknowledged(1, now + 1ms);
  EXPECT_TRUE(link.has_room());
  link.sent(3, 1000, now);
  link.acknowledged(3, now + 2ms);  // what was dropped on the way is no longer waited for
  link.sent(4, 1000, now);
  EXPECT_TRUE(link.has_room());
  link.acknowledged(77, now);  // nonsense does no harm
  EXPECT_TRUE(link.has_room());
}

TEST(Link, HasRoomForWhatWasRecalled) {
  Link link;
  const auto now = Link::Clock::now();
  link.sent(1, 1000, now);
  link.sent(2, 5000000, now);
  link.recalled(2);
  EXPECT_TRUE(link.has_room());
  EXPECT_TRUE(link.is_under_way(2));
  link.sent(3, 400000, now);
  EXPECT_FALSE(link.has_room());
  link.acknowledged(3, now + 400ms);
  EXPECT_FALSE(link.is_under_way(2));
  link.encoded_lossless(1000, 1000);
  EXPECT_NEAR(link.lossless_ms(1000), 1, 0.01);  // the 5 MB have not come in these 400 ms
}

/// A link of so many bytes a millisecond, after some frames of two million pixels.
Link link_of(double bytes_per_ms) {
  Link link;
  auto now = Link::Clock::now();
  for (std::uint32_t frame = 1; frame < 20; ++frame) {
    link.encoded(2000000, 400000, 90);
    link.sent(frame, 400000, now);
    now += std::chrono::microseconds(static_cast<std::int64_t>(400000 / bytes_per_ms * 1000));
    link.acknowledged(frame, now);
  }
  return link;
}

TEST(Link, KeepsTheQualityWhereItIsFast) {
  EXPECT_EQ(link_of(100000).quality(2000000, Pace::budget_ms), 90);
  EXPECT_EQ(link_of(100000).scale(2000000), 1);
}

TEST(Link, GivesUpQualityThenSize) {
  const Link slow = link_of(5000);  // 225 kB in the budget
  EXPECT_LT(slow.quality(2000000, Pace::budget_ms), 90);
  EXPECT_EQ(slow.scale(2000000), 1);
  const Link very_slow = link_of(500);
  EXPECT_EQ(very_slow.quality(2000000, Pace::budget_ms), 40);
  EXPECT_LT(very_slow.scale(2000000), 0.6);
  EXPECT_GT(very_slow.scale(2000000), 0.3);
}

TEST(Link, KnowsHowLongAFullPictureTakes) {
  EXPECT_EQ(Link().lossless_ms(2000000), 0);
  Link link = link_of(1000);
  link.encoded_lossless(2000000, 3000000);
  EXPECT_NEAR(link.lossless_ms(1000000), 1500, 50);
  EXPECT_GT(link.quality(2000000, 500), link.quality(2000000, Pace::budget_ms));
}

}  // namespace
}  // namespace motes::server
