#include "core/vec.h"

#include <gtest/gtest.h>

namespace motes {
namespace {

TEST(Vec, AxesFollowTheRightHandRule) {
  const Vector3d x{1, 0, 0}, y{0, 1, 0};
  EXPECT_EQ(cross(x, y), (Vector3d{0, 0, 1}));
  EXPECT_EQ(dot(x, y), 0);
  EXPECT_DOUBLE_EQ(length(Vector3d{3, 4, 12}), 13);
}

TEST(Bounds, EmptyUntilSomethingIsAdded) {
  Bounds3d box;
  EXPECT_TRUE(box.empty());
  box.add(Point3d{1, 2, 3});
  EXPECT_FALSE(box.empty());
  EXPECT_TRUE(box.contains({1, 2, 3}));
  EXPECT_EQ(box.extended(1).min, (Point3d{0, 1, 2}));
  box.add(Bounds3d{});  // adding nothing changes nothing
  EXPECT_EQ(box.max, (Point3d{1, 2, 3}));
}

}  // namespace
}  // namespace motes
