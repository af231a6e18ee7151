#include "render/clip.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace motes {
namespace {

const Bounds3d box{{-1, -2, -3}, {1, 2, 3}};

void expect_range(const DepthRange& range, double near, double far) {
  EXPECT_EQ(range.near, near);
  EXPECT_EQ(range.far, far);
}

TEST(Clip, CountsDepthsInLengthsOfTheDirection) {
  expect_range(clip(box, {0, 0, -5}, {0, 0, 1}), 2, 8);
  expect_range(clip(box, {0, 0, -5}, {0, 0, 2}), 1, 4);
  expect_range(clip(box, {0, 8, 0}, {0, -1, 0}), 6, 10);
}

TEST(Clip, StartsAtTheOriginInsideTheBox) {
  expect_range(clip(box, {0.5, 0, 0}, {1, 0, 0}), 0, 0.5);
}

TEST(Clip, FindsNothingBehindTheOriginOrBesideTheRay) {
  for (const DepthRange& range : {clip(box, {0, 0, 5}, {0, 0, 1}), clip(box, {0, 3, -5}, {0, 0, 1}),
                                  clip(box, {-9, 0, 0}, {1, 1, 0})}) {
    EXPECT_GT(range.near, range.far);
  }
}

TEST(Clip, HasTheFacesInTheBox) {
  expect_range(clip(box, {1, 2, -5}, {0, 0, 1}), 2, 8);  // along edges
  expect_range(clip(box, {-1, -2, -5}, {0, 0, 1}), 2, 8);
  expect_range(clip(box, {-5, 0, 0}, {2, 1, 0}), 2, 2);  // touches an edge
}

// Whole numbers and eighths, so that nothing is rounded but quotients by 3, which no eighth meets.
RC_GTEST_PROP(Clip, HoldsTheDepthsWhosePointsAreInTheBox, ()) {
  const auto component = [](int low, int high) {
    return static_cast<double>(*rc::gen::inRange(low, high + 1));
  };
  const Point3d origin{component(-6, 6), component(-6, 6), component(-6, 6)};
  const Vector3d direction{component(-3, 3), component(-3, 3), component(-3, 3)};
  const DepthRange range = clip(box, origin, direction);
  for (int k = 0; k < 100; ++k) {
    const double z = k / 8.0;
    const Point3d p = origin + z * direction;
    bool inside = true;
    for (int axis = 0; axis < 3; ++axis) {
      inside = inside && p[axis] >= box.min[axis] && p[axis] <= box.max[axis];
    }
    RC_ASSERT((z >= range.near && z <= range.far) == inside);
  }
}

}  // namespace
}  // namespace motes
