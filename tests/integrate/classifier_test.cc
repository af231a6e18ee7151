#include "integrate/classifier.h"

#include <gtest/gtest.h>

#include <limits>

namespace motes {
namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();

TEST(Classifier, KnowsWhereNothingIsSeen) {
  const TransferFunction late{{{0, {}, 0}, {1, {}, 0}, {2, {}, 3}}, false};
  EXPECT_EQ(compile_transfer_function(late, 1, 0.5).visibility.above, 1);
  EXPECT_FALSE(compile_transfer_function(late, 1, 0.5).visibility.shows_zero());

  const TransferFunction always{{{0, {}, 0.5}, {1, {}, 0}}, false};
  EXPECT_EQ(compile_transfer_function(always, 1, 0.5).visibility.above, -infinity);
  EXPECT_TRUE(compile_transfer_function(always, 1, 0.5).visibility.shows_zero());

  const TransferFunction never{{{0, {}, 0}, {1, {}, 0}}, false};
  EXPECT_EQ(compile_transfer_function(never, 1, 0.5).visibility.above, infinity);
}

TEST(Classifier, FindsTheExtinctionOfEmptySpaceBetweenPoints) {
  // A diverging map: opaque at both ends, clear in the middle, which is zero.
  const TransferFunction clear{{{-1, {}, 2}, {-0.1, {}, 0}, {0.1, {}, 0}, {1, {}, 2}}, false};
  EXPECT_FALSE(compile_transfer_function(clear, 1, 0.5).visibility.shows_zero());
  const TransferFunction foggy{{{-1, {}, 2}, {1, {}, 1}}, false};
  EXPECT_TRUE(compile_transfer_function(foggy, 1, 0.5).visibility.shows_zero());
  // On a logarithmic scale zero lies before the first point.
  const TransferFunction log{{{0.01, {}, 0}, {1, {}, 1}}, true};
  EXPECT_FALSE(compile_transfer_function(log, 1, 0.5).visibility.shows_zero());
}

TEST(Classifier, SpeaksTheBuffersUnits) {
  const TransferFunction f{{{4, {1, 0, 0}, 0}, {8, {1, 1, 0}, 6}}, false};
  const Classifier c = compile_transfer_function(f, 0.25, 0.5);
  EXPECT_EQ(c.num_segments, 1);
  EXPECT_EQ(c.row(Classifier::begin)[0], 1);
  EXPECT_EQ(c.row(Classifier::inverse_width)[0], 1);
  EXPECT_EQ(c.row(Classifier::rise + 3)[0], 3);  // extinction times step
  EXPECT_EQ(c.row(Classifier::rise + 1)[0], 1);
}

TEST(Classifier, KnowsEvenSpacing) {
  const TransferFunction even{{{1, {}, 0}, {3, {}, 1}, {5, {}, 2}, {7, {}, 0}}, false};
  EXPECT_EQ(compile_transfer_function(even, 0.5, 1).inverse_spacing, 1);
  const TransferFunction uneven{{{1, {}, 0}, {3, {}, 1}, {5.1, {}, 2}, {7, {}, 0}}, false};
  EXPECT_EQ(compile_transfer_function(uneven, 1, 1).inverse_spacing, 0);
  const TransferFunction log{{{0.01, {}, 0}, {1, {}, 1}, {100, {}, 2}}, true};
  EXPECT_EQ(compile_transfer_function(log, 1, 1).inverse_spacing, 0.5F);
  const TransferFunction flat{{{1, {}, 1}}, false};
  EXPECT_EQ(compile_transfer_function(flat, 1, 1).inverse_spacing, 0);
}

}  // namespace
}  // namespace motes
