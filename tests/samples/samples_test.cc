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
  int first_sample = 0;
  for (const std::uint64_t word : buffer.touched_words()) {
    for (int i = 0; i < 64; ++i) {
      if ((word >> i & 1) != 0) RC_ASSERT(touched.erase(first_sample + i) == 1);
    }
    first_sample += 64;
  }
  RC_ASSERT(touched.empty());
}

/// With several fields a sample is more than one vector.
RC_GTEST_PROP(SampleBuffer, IsZeroAfterClearing, ()) {
  const int fields = *rc::gen::element(1, 2, 5), num_samples = *rc::gen::inRange(1, 300);
  const SampleLayout layout{.num_fields = fields, .lanes = HWY_NAMESPACE::num_lanes};
  SampleBuffer buffer(layout, num_samples);
  const auto samples = *rc::gen::container<std::set<int>>(rc::gen::inRange(0, num_samples));
  for (const int sample : samples) {
    buffer.touch(sample, sample);
    std::fill_n(buffer.at(sample, 0), layout.floats_per_sample(), 1.0F);
  }
  HWY_NAMESPACE::clear_touched(buffer);
  const float* const values = buffer.at(0, 0);
  const auto size = layout.floats_per_sample() * static_cast<std::size_t>(num_samples);
  RC_ASSERT(std::all_of(values, values + size, [](float v) { return v == 0; }));
  for (const std::uint64_t word : buffer.touched_words()) RC_ASSERT(word == 0u);
}

TEST(SampleBuffer, GrowsToWhatIsAskedFor) {
  SampleBuffer buffer(SampleLayout{}, 10);
  buffer.reserve(5);
  EXPECT_EQ(buffer.capacity(), 10);
  buffer.reserve(1000);
  EXPECT_GE(buffer.capacity(), 1000);
}

}  // namespace
}  // namespace motes
