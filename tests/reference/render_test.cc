// The parts of the reference's picture, and small pictures worked out by hand.
#include "reference/render.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "support/particles_at.h"

namespace motes::reference {
namespace {

/// Particles at the given places, with one field of all of them: radius 0.5, weight 1, sigma 2.
struct SmallScene {
  ParticleSet particles;
  ResolvedScene scene;
};

TransferFunction constant_transfer(Color color, double extinction) {
  return {{{.value = 0, .color = color, .extinction = extinction}}, false};
}

/// Seen along +z from z = -10 by an orthographic camera of one pixel; step 0.25, no lighting.
SmallScene small_scene(const std::vector<Point3d>& centers) {
  SmallScene s;
  s.particles = particles_at(centers);
  s.scene.fields = {field_of_all(s.particles, 0.5F, 1, {})};
  s.scene.transfer_functions = {constant_transfer({1, 0.5F, 0.25F}, 0.3)};
  s.scene.camera = {.eye = {0, 0, -10},
                    .target = {0, 0, 0},
                    .up = {0, 1, 0},
                    .fov_degrees = 45,
                    .orthographic_height = 0.1};
  s.scene.step_size = 0.25;
  s.scene.render.width = s.scene.render.height = 1;
  s.scene.render.termination_opacity = 1;
  s.scene.render.lighting.enabled = false;
  return s;
}

TEST(ReferenceCamera, CornerRaysOfAPerspective) {
  // Looking along +x with z up: right is -y.
  const Camera camera{.eye = {1, 2, 3},
                      .target = {5, 2, 3},
                      .up = {0, 0, 1},
                      .fov_degrees = 90,
                      .orthographic_height = {}};
  const CameraRay top_left = camera_ray(camera, 4, 2, 0, 0);
  EXPECT_EQ(top_left.origin, (Point3d{1, 2, 3}));
  EXPECT_NEAR(top_left.direction.x, 1, 1e-15);
  EXPECT_NEAR(top_left.direction.y, 1.5, 1e-15);  // u = (2 * 0.5 / 4 - 1) * 1 * 4 / 2
  EXPECT_NEAR(top_left.direction.z, 0.5, 1e-15);
  const CameraRay bottom_right = camera_ray(camera, 4, 2, 3, 1);
  EXPECT_NEAR(bottom_right.direction.y, -1.5, 1e-15);
  EXPECT_NEAR(bottom_right.direction.z, -0.5, 1e-15);
}

TEST(ReferenceCamera, CornerRaysOfAnOrthographicView) {
  const Camera camera{.eye = {0, 0, 5},
                      .target = {0, 0, 0},
                      .up = {0, 2, 1},  // neither of length 1 nor perpendicular
                      .fov_degrees = 45,
                      .orthographic_height = 6};
  const CameraRay top_left = camera_ray(camera, 4, 2, 0, 0);
  EXPECT_NEAR(top_left.origin.x, -4.5, 1e-15);
  EXPECT_NEAR(top_left.origin.y, 1.5, 1e-15);
  EXPECT_NEAR(top_left.origin.z, 5, 1e-15);
  EXPECT_NEAR(top_left.direction.z, -1, 1e-15);
  EXPECT_NEAR(length(top_left.direction), 1, 1e-15);
}

TEST(ReferenceTransferFunction, IsPiecewiseLinearAndClamped) {
  const TransferFunction f{{{.value = 1, .color = {0, 0, 1}, .extinction = 0},
                            {.value = 2, .color = {1, 0, 1}, .extinction = 4},
                            {.value = 4, .color = {1, 1, 0}, .extinction = 1}},
                           false};
  EXPECT_EQ(classify(f, -5).extinction, 0);
  EXPECT_EQ(classify(f, 9).green, 1);
  EXPECT_DOUBLE_EQ(classify(f, 2).extinction, 4);
  EXPECT_DOUBLE_EQ(classify(f, 1.25).extinction, 1);
  EXPECT_DOUBLE_EQ(classify(f, 1.25).red, 0.25);
  EXPECT_DOUBLE_EQ(classify(f, 3).extinction, 2.5);
  EXPECT_DOUBLE_EQ(classify(f, 3).blue, 0.5);
}

TEST(ReferenceTransferFunction, OfTheLogarithm) {
  const TransferFunction f{{{.value = 0.1, .color = {0, 0, 0}, .extinction = 1},
                            {.value = 1000, .color = {1, 1, 1}, .extinction = 5}},
                           true};
  EXPECT_DOUBLE_EQ(classify(f, 10).extinction, 3);  // halfway from -1 to 3
  EXPECT_DOUBLE_EQ(classify(f, 10).red, 0.5);
  for (const double small : {0.1, 0.01, 0., -7.}) EXPECT_EQ(classify(f, small).extinction, 1);
  EXPECT_EQ(classify(f, 1e6).extinction, 5);
}

TEST(ReferenceShade, IsTwoSidedPhong) {
  const Lighting lighting{.enabled = true,
                          .ambient = 0.3,
                          .diffuse = 0.7,
                          .specular = 0.2,
                          .shininess = 2,
                          .lights = {{Vector3d{0, 2, 0}}}};
  const Classified sample{1, 0.5, 0, 9};
  const Vector3d view{0, 0, 1};
  // n.l = 0.6, n.h = (0.8 + 0.6) / sqrt 2, squared 0.98.
  for (const double side : {1., -1.}) {
    const Vector3d normal{0, side * 0.6, side * 0.8};
    const Classified lit = shade(sample, lighting, normal, view);
    EXPECT_NEAR(lit.red, 0.3 + 0.7 * 0.6 + 0.2 * 0.98, 1e-15);
    EXPECT_NEAR(lit.green, 0.5 * (0.3 + 0.7 * 0.6) + 0.2 * 0.98, 1e-15);
    EXPECT_NEAR(lit.blue, 0.2 * 0.98, 1e-15);
    EXPECT_EQ(lit.extinction, 9);
  }
  EXPECT_NEAR(shade(sample, lighting, {}, view).red, 0.3, 1e-15);
  // Lit from straight behind: no halfway vector.
  const Lighting behind{.ambient = 0.3, .diffuse = 0.7, .specular = 0.2, .lights = {{-view}}};
  EXPECT_NEAR(shade(sample, behind, view, view).red, 0.3 + 0.7, 1e-15);
}

TEST(ReferenceShade, LightsAddUp) {
  const auto red = [](const std::vector<LightSource>& lights) {
    const Lighting lighting{.ambient = 0.3, .shininess = 2, .lights = lights};
    return shade({1, 0.5, 0, 9}, lighting, Vector3d{0, 0.6, 0.8}, {0, 0, 1}).red;
  };
  const LightSource above{Vector3d{0, 1, 0}, 1}, head;
  EXPECT_NEAR(red({}), 0.3, 1e-15);
  EXPECT_NEAR(red({{above.direction, 0.5}, {{}, 2}}),
              0.3 + 0.5 * (red({above}) - 0.3) + 2 * (red({head}) - 0.3), 1e-15);
}

TEST(ReferenceVolume, ReachesTheLargestSupportBeyondAllCenters) {
  std::vector<std::vector<ParticleKernel>> fields(2);
  fields[0] = {{.center = {0, 0, 0}, .radius = 1, .support_radius = 2, .amplitude = 1}};
  fields[1] = {{.center = {5, -1, 0}, .radius = 0.1, .support_radius = 0.3, .amplitude = 1}};
  const Bounds3d box = volume_box(fields);
  EXPECT_EQ(box.min, (Point3d{-2, -3, -2}));
  EXPECT_EQ(box.max, (Point3d{7, 2, 2}));
  EXPECT_TRUE(volume_box({}).empty());
}

TEST(ReferenceRender, HomogeneousSlab) {
  // The box is a cube of side 2, of constant colour and extinction: 8 steps of 0.25.
  const SmallScene s = small_scene({{0, 0, 0}});
  const Image image = render(s.particles, s.scene);
  const double alpha = 1 - std::exp(-0.3 * 2);
  EXPECT_NEAR(image.rgba[3], alpha, 1e-14);
  EXPECT_NEAR(image.rgba[0], alpha, 1e-14);
  EXPECT_NEAR(image.rgba[1], alpha / 2, 1e-14);
  EXPECT_EQ(image.samples, 8U);
  EXPECT_EQ(image.unstable[0], 0);
}

TEST(ReferenceRender, ObliqueRaysStepAsLongAsTheirDirection) {
  SmallScene s = small_scene({{0, 0, 0}});
  s.scene.camera.orthographic_height.reset();
  s.scene.camera.fov_degrees = 4;
  s.scene.render.width = 3;
  const Image image = render(s.particles, s.scene);
  // The ray of the right pixel leaves the axis by u z, still less than 1 at the far face.
  const double u = 2. / 3 * std::tan(2 * std::acos(-1.) / 180) * 3;
  ASSERT_LT(u * 11, 1);
  EXPECT_NEAR(image.rgba[8 + 3], 1 - std::exp(-0.3 * 2 * std::hypot(1, u)), 1e-14);
}

TEST(ReferenceRender, FacesOfTheBoxBelongToIt) {
  SmallScene s = small_scene({{0, 0, 0}});
  // Planes at depths 9 and 11, on both faces, and 7 between; flagged, since rounding may lose them.
  s.scene.camera.eye.z = -10.125;
  const Image image = render(s.particles, s.scene);
  EXPECT_EQ(image.samples, 9U);
  EXPECT_EQ(image.unstable[0], 1);
}

TEST(ReferenceRender, CameraInsideStartsHalfAStepInFrontOfTheEye) {
  SmallScene s = small_scene({{0, 0, 0}});
  s.scene.camera.eye.z = 0;
  s.scene.camera.target.z = 1;
  EXPECT_EQ(render(s.particles, s.scene).samples, 4U);
  s.scene.camera.target.z = -1;
  EXPECT_EQ(render(s.particles, s.scene).samples, 4U);
}

TEST(ReferenceRender, LooksTheRightWay) {
  // One particle to the upper right of the middle of a picture of 3 x 3, seen along +z: right is
  // -x.
  SmallScene s = small_scene({{-3, 3, 0}});
  s.scene.camera.orthographic_height = 9;
  s.scene.render.width = s.scene.render.height = 3;
  const Image image = render(s.particles, s.scene);
  for (int pixel = 0; pixel < 9; ++pixel) {
    EXPECT_EQ(image.rgba[static_cast<std::size_t>(4 * pixel + 3)] > 0, pixel == 2) << pixel;
  }
}

/// Two fields of one particle each at the same place, three planes of samples.
SmallScene two_fields() {
  SmallScene s = small_scene({{0, 0, 0}, {0, 0, 0}});
  FieldSource& first = s.scene.fields[0];
  first.index = {0};
  FieldSource second = first;
  second.index = {1};
  second.weight = {2};
  s.scene.fields.push_back(second);
  // Planes at z = -2/3, 0, 2/3.
  s.scene.step_size = 2. / 3;
  s.scene.camera.eye.z = -10 - 1. / 3;
  // Extinction of both is the field's value.
  s.scene.transfer_functions = {
      {{{0, {1, 0, 0}, 0}, {10, {1, 0, 0}, 10}}, false},
      {{{0, {0, 1, 0}, 0}, {10, {0, 1, 0}, 10}}, false},
  };
  return s;
}

TEST(ReferenceRender, CompositesFieldsInTheirOrderAtEachSample) {
  const SmallScene s = two_fields();
  // The middle of the only pixel lies on the axis, so d = 2/3, 0, 2/3 and 2 r^2 = 1/2.
  const double side = std::exp(-(4. / 9) / 0.5), dt = 2. / 3;
  double red = 0, green = 0, clear = 1;
  for (const double value : {side, 1., side}) {
    const double a = 1 - std::exp(-value * dt);
    red += clear * a;
    clear *= 1 - a;
    const double b = 1 - std::exp(-2 * value * dt);
    green += clear * b;
    clear *= 1 - b;
  }
  const Image image = render(s.particles, s.scene);
  EXPECT_NEAR(image.rgba[0], red, 1e-14);
  EXPECT_NEAR(image.rgba[1], green, 1e-14);
  EXPECT_EQ(image.rgba[2], 0);
  EXPECT_NEAR(image.rgba[3], 1 - clear, 1e-14);
  EXPECT_EQ(image.samples, 3U);
  EXPECT_EQ(image.kernel_evaluations, 6U);
}

TEST(ReferenceRender, StopsAfterAllFieldsOfASample) {
  SmallScene s = two_fields();
  const double side = std::exp(-(4. / 9) / 0.5), dt = 2. / 3;
  const double after_first_field = 1 - std::exp(-side * dt);
  const double after_first_sample = 1 - std::exp(-3 * side * dt);

  s.scene.render.termination_opacity = after_first_field / 2;
  Image image = render(s.particles, s.scene);
  EXPECT_EQ(image.samples, 1U);
  EXPECT_NEAR(image.rgba[3], after_first_sample, 1e-14);
  EXPECT_EQ(image.unstable[0], 0);

  // Just under: stops, just over: goes on; both could be the other way in float.
  for (const double difference : {-5e-6, 5e-6}) {
    s.scene.render.termination_opacity = after_first_sample + difference;
    image = render(s.particles, s.scene);
    EXPECT_EQ(image.samples, difference < 0 ? 1U : 2U);
    EXPECT_EQ(image.unstable[0], 1);
  }
  s.scene.render.termination_opacity = after_first_sample + 2e-5;
  EXPECT_EQ(render(s.particles, s.scene).unstable[0], 0);
}

TEST(ReferenceRender, TerminationAtOneIsNever) {
  SmallScene s = small_scene({{0, 0, 0}});
  s.scene.transfer_functions = {constant_transfer({1, 1, 1}, 1000)};
  const Image image = render(s.particles, s.scene);
  EXPECT_EQ(image.samples, 8U);
  EXPECT_EQ(image.unstable[0], 0);
}

TEST(ReferenceRender, FlagsSamplesNearASupportBoundary) {
  // Two more particles widen the box; the ray passes the first one's sphere at its side, at
  // depth 10.125, where a plane of samples lies.
  const double eye_distance = 10.125;
  const auto unstable = [&](double gap) {
    SmallScene s = small_scene({{0, 1 + gap, 0.125}, {0, 0, -5.05}, {0, 0, 5.05}});
    return render(s.particles, s.scene).unstable[0] != 0;
  };
  EXPECT_TRUE(unstable(0.5e-5 * eye_distance));   // just missed
  EXPECT_TRUE(unstable(-0.5e-5 * eye_distance));  // just hit
  EXPECT_FALSE(unstable(2e-5 * eye_distance));
  EXPECT_FALSE(unstable(-2e-5 * eye_distance));
}

TEST(ReferenceRender, FlagsARayThatGrazesAFaceOfTheBox) {
  const auto unstable = [](double x) {
    const SmallScene s = small_scene({{x, 0, 0}});
    return render(s.particles, s.scene).unstable[0] != 0;
  };
  EXPECT_TRUE(unstable(1 + 5e-5));
  EXPECT_TRUE(unstable(1 - 5e-5));
  EXPECT_FALSE(unstable(1 + 2e-4));
}

TEST(ReferenceRender, ShadesWithTheFieldsOwnNormal) {
  // Seen along the axis through the particle: the normal is the view's, but at the very centre.
  SmallScene s =
      small_scene({{0, 0, 0.125}});  // planes at -0.875, ..., 0.125 (the centre), ..., 0.875
  s.scene.render.lighting = {.enabled = true,
                             .ambient = 0.25,
                             .diffuse = 0.5,
                             .specular = 0.125,
                             .shininess = 32,
                             .lights = {{}}};
  const double opacity = 1 - std::exp(-0.3 * 0.25);
  double red = 0, clear = 1;
  for (double z = -0.875; z < 1.2; z += 0.25) {
    const bool has_normal = std::abs(z - 0.125) > 1e-9;
    red += clear * opacity * (0.25 + (has_normal ? 0.5 + 0.125 : 0));
    clear *= 1 - opacity;
  }
  const Image image = render(s.particles, s.scene);
  EXPECT_EQ(image.samples, 9U);
  EXPECT_NEAR(image.rgba[0], red, 1e-13);
}

TEST(ReferenceRender, TakesNoNormalWhereTheGradientIsSmall) {
  // With a smallest radius of 1e-6, |grad Phi| 1e-6 = (d / 0.25) Phi 1e-6 is too small where d <
  // 0.25: for the 2 samples at -0.125 and 0.125 of 8.
  SmallScene s = small_scene({{0.5, 0.5, 0}, {0, 0, 0}});
  s.scene.fields[0].radius = {1e-6F, 0.5F};
  s.scene.render.lighting.enabled = true;
  s.scene.render.lighting.ambient = 0;
  s.scene.render.lighting.specular = 0;
  s.scene.render.lighting.diffuse = 1;
  const double clear = std::exp(-0.3 * 0.25);
  const double without_normal = std::pow(clear, 3) - std::pow(clear, 5);
  Image image = render(s.particles, s.scene);
  EXPECT_NEAR(image.rgba[0], 1 - std::pow(clear, 8) - without_normal, 1e-12);

  // In a corner of the box, beyond all supports.
  s.scene.camera.eye = {0.95, 0.95, -10};
  s.scene.camera.target = {0.95, 0.95, 0};
  image = render(s.particles, s.scene);
  EXPECT_EQ(image.rgba[0], 0);
  EXPECT_NEAR(image.rgba[3], 1 - std::pow(clear, 8), 1e-12);
}

TEST(ReferenceRender, LeavingOutDistantKernelsChangesNothing) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(-1, 1);
  std::vector<Point3d> centers;
  centers.reserve(200);
  for (int i = 0; i < 200; ++i) {
    centers.push_back({3 * unit(random), 3 * unit(random), 3 * unit(random)});
  }
  SmallScene s = small_scene(centers);
  s.scene.transfer_functions = {{{{0, {1, 0, 0}, 0}, {2, {0, 1, 1}, 1}}, false}};
  s.scene.camera.orthographic_height.reset();
  s.scene.render.width = 7;
  s.scene.render.height = 5;
  const auto kernels = particle_kernels(s.particles, s.scene.fields[0]);
  const Bounds3d box = volume_box({kernels});
  const Image image = render(s.particles, s.scene);
  std::uint64_t evaluations = 0;
  for (int pixel = 0; pixel < 35; ++pixel) {
    const CameraRay ray = camera_ray(s.scene.camera, 7, 5, pixel % 7, pixel / 7);
    RayColor color;
    for (int k = 0; k < 1000; ++k) {
      const Point3d x = ray.origin + (k + 0.5) * 0.25 * ray.direction;
      if (!box.contains(x)) continue;
      const FieldValue field = evaluate_field(kernels, x);
      evaluations += field.num_kernels;
      composite(color, classify(s.scene.transfer_functions[0], field.value),
                0.25 * length(ray.direction));
    }
    EXPECT_NEAR(image.rgba[static_cast<std::size_t>(4 * pixel + 3)], color.alpha, 1e-13);
  }
  EXPECT_EQ(image.kernel_evaluations, evaluations);
}

TEST(ReferenceRender, NoParticlesMakeAnEmptyPicture) {
  SmallScene s = small_scene({});
  const Image image = render(s.particles, s.scene);
  EXPECT_EQ(image.rgba, (std::vector<double>{0, 0, 0, 0}));
  EXPECT_EQ(image.unstable[0], 0);
}

}  // namespace
}  // namespace motes::reference
