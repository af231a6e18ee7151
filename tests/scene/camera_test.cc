// The camera's axes against the formulas of docs/field.md, and the cameras that are refused.
#include "scene/camera.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <string>

#include "core/error.h"

namespace motes {
namespace {

std::string message_of(const Camera& camera) {
  try {
    camera_axes(camera);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(CameraAxes, DefaultLooksAlongMinusZ) {
  const CameraAxes axes = camera_axes(Camera{});
  EXPECT_EQ(axes.forward, (Vector3d{0, 0, -1}));
  EXPECT_EQ(axes.x, (Vector3d{1, 0, 0}));
  EXPECT_EQ(axes.y, (Vector3d{0, 1, 0}));
}

RC_GTEST_PROP(CameraAxes, AreOrthonormalAndUpIsUp, ()) {
  const auto number = [] { return *rc::gen::inRange(-1000, 1000) / 16.0; };
  Camera camera;
  camera.eye = {number(), number(), number()};
  const Vector3d view{number(), number(), number()};
  camera.up = {number(), number(), number()};
  RC_PRE(length(cross(view, camera.up)) > 0.01 * length(view) * length(camera.up));
  camera.target = camera.eye + view;
  const CameraAxes axes = camera_axes(camera);
  RC_ASSERT(std::abs(length(axes.x) - 1) < 1e-12);
  RC_ASSERT(std::abs(length(axes.y) - 1) < 1e-12);
  RC_ASSERT(std::abs(dot(axes.x, axes.forward)) < 1e-12);
  RC_ASSERT(length(cross(axes.forward, view)) < 1e-9);
  RC_ASSERT(dot(axes.forward, view) > 0);
  RC_ASSERT(length(cross(axes.x, axes.y) + axes.forward) < 1e-12);
  RC_ASSERT(dot(axes.y, camera.up) > 0);
}

TEST(CameraAxes, RefusesWhatIsNoCamera) {
  Camera camera;
  camera.target = camera.eye;
  EXPECT_THAT(message_of(camera), testing::HasSubstr("same point"));
  camera = {};
  camera.up = {0, 0, 3};
  EXPECT_THAT(message_of(camera), testing::HasSubstr("parallel"));
  camera.up = {0, 0, 0};
  EXPECT_THAT(message_of(camera), testing::HasSubstr("not be zero"));
  camera = {};
  camera.eye.x = NAN;
  EXPECT_THAT(message_of(camera), testing::HasSubstr("finite"));
  for (const double fov : {0.0, 180.0, -3.0, double{NAN}}) {
    camera = {};
    camera.fov_degrees = fov;
    EXPECT_THAT(message_of(camera), testing::HasSubstr("fov")) << fov;
  }
  camera = {};
  camera.orthographic_height = 0;
  EXPECT_THAT(message_of(camera), testing::HasSubstr("orthographic"));
}

}  // namespace
}  // namespace motes
