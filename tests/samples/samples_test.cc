#include "samples/samples.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <set>

#include "samples/lanes-inl.h"

namespace motes {
namespace {

TEST(SamplePlanes, LieInTheMiddleOfTheirSteps) {
  const SamplePlanes planes{10, 0.5};
  EXPECT_DOUBLE_EQ(planes.depth(0), 5.25);
  EXPECT_DOUBLE_EQ(planes.depth(3), 6.75);
}

TEST(SampleLayout, CountsChannels) {
  SampleLayout layout{.num_fields = 2, .lanes = 8};
  EXPECT_EQ(layout.channels(), 1);
  EXPECT_EQ(layout.floats_per_sample(), 16u);
  layout.gradients = true;
  EXPECT_EQ(layout.channels(), 4);
  layout.absolute = true;
  EXPECT_EQ(layout.channels(), 5);
  EXPECT_EQ(layout.absolute_channel(), 4);
  EXPECT_EQ(layout.floats_per_sample(), 80u);
}

RC_GTEST_PROP(SampleBuffer, RemembersWhatWasTouched, ()) {
  const int capacity = *rc::gen::inRange(1, 300);
  SampleBuffer buffer(SampleLayout{.num_fields = 2, .lanes = 4}, capacity);
  std::set<int> touched;
  const int times = *rc::gen::inRange(0, 5);
  for (int i = 0; i < times; ++i) {
    const int first = *rc::gen::inRange(0, capacity);
    const int last = *rc::gen::inRange(first, capacity);
    buffer.touch(first, last);
    for (int k = first; k <= last; ++k) touched.insert(k);
  }
  for (int k = 0; k < capacity; ++k) RC_ASSERT(buffer.touched(k) == (touched.count(k) == 1));
  int first_cell = 0;
  for (const std::uint64_t word : buffer.touched_words()) {
    for (int i = 0; i < 64; ++i) {
      if ((word >> i & 1) != 0) RC_ASSERT(touched.erase(first_cell + i) == 1);
    }
    first_cell += 64;
  }
  RC_ASSERT(touched.empty());
}

/// Several blocks and channels: a cell is more than one vector.
RC_GTEST_PROP(SampleBuffer, IsZeroAfterClearing, ()) {
  const int channels = *rc::gen::element(1, 2, 5), samples = *rc::gen::inRange(1, 40);
  const SampleLayout layout{.num_fields = channels, .lanes = HWY_NAMESPACE::num_lanes};
  SampleBuffer buffer(layout, samples, 16);
  const auto cells = *rc::gen::container<std::set<int>>(rc::gen::inRange(0, 16 * samples));
  for (const int cell : cells) {
    buffer.touch(cell, cell);
    std::fill_n(buffer.at(cell, 0), layout.floats_per_sample(), 1.0F);
  }
  HWY_NAMESPACE::clear_touched(buffer);
  const float* const values = buffer.at(0, 0);
  const auto size = layout.floats_per_sample() * 16 * static_cast<std::size_t>(samples);
  RC_ASSERT(std::all_of(values, values + size, [](float v) { return v == 0; }));
  RC_ASSERT(buffer.touched_blocks() == 0u);
}

TEST(SampleBuffer, TellsWhichBlocksWereTouched) {
  SampleBuffer buffer(SampleLayout{.lanes = 4}, 9, 16);
  EXPECT_EQ(buffer.capacity(), 9);
  EXPECT_EQ(buffer.touched_blocks(), 0u);
  buffer.touch(buffer.cell(8, 5), buffer.cell(8, 5));
  buffer.touch_word(1, std::uint64_t{1} << (2 * 16 + 11));  // sample 6
  EXPECT_TRUE(buffer.touched(buffer.cell(6, 11)));
  EXPECT_EQ(buffer.touched_blocks(), 1u << 5 | 1u << 11);
  SampleBuffer wide(SampleLayout{.lanes = 4}, 2, 64);
  wide.touch(wide.cell(1, 63), wide.cell(1, 63));
  EXPECT_EQ(wide.touched_blocks(), std::uint64_t{1} << 63);
}

TEST(SampleBuffer, GrowsToWhatIsAskedFor) {
  SampleBuffer buffer(SampleLayout{}, 10);
  buffer.reserve(5);
  EXPECT_EQ(buffer.capacity(), 10);
  buffer.reserve(1000);
  EXPECT_GE(buffer.capacity(), 1000);
  EXPECT_FALSE(buffer.touched(999));
}

}  // namespace
}  // namespace motes
