// Pass 2 of every engine, on every instruction set: transfer functions, light and several fields
// make the reference's picture.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <thread>
#include <vector>

#include "render/engine_check.h"
#include "render/renderer.h"

namespace motes {
namespace {

TEST(Engines, EvenlySpacedPointsAsNamedMapsHave) {
  for (const int num_points : {4, 17, 33, 34, 80}) {
    for (const bool log_scale : {false, true}) {
      PlainScene s = plain_scene({{0, 0, 0}, {1.5, 0.5, 1}, {0.2, -1, 0}}, 9);
      TransferFunction& f = s.scene.transfer_functions[0];
      f = {{}, log_scale};
      for (int i = 0; i < num_points; ++i) {
        const double at = static_cast<double>(i) / (num_points - 1);
        const auto t = static_cast<float>(at);
        f.points.push_back({.value = log_scale ? std::pow(10, 2 * at - 2) : 0.1 + at,
                            .color = {t, 0.5F + 0.5F * std::sin(9 * t), 1 - t},
                            .extinction = t * (1.2 + std::cos(7 * t))});
      }
      check(s, fmt::format("{} points, {}", num_points, log_scale ? "logarithmic" : "linear"));
    }
  }
}

TEST(Engines, ThousandsOfThinSamples) {
  PlainScene s = plain_scene({{0, 0, 0}, {1, -1, 2}}, 8);
  s.scene.step_size = 0.002;
  s.scene.transfer_functions = {ramp(1, 0.7)};
  s.scene.render.width = 7;
  s.scene.render.height = 5;
  // Too many samples for pixels to be stable: the mean must be right nevertheless.
  Comparison comparison;
  comparison.check(s.particles, s.scene, "thin");
  EXPECT_LT(comparison.rms(), 5e-4);
}

TEST(Engines, SeveralLights) {
  // Thin samples and a whole power, which a single light takes without calls.
  PlainScene s = plain_scene({{0, 0, 0}, {1, 1, 0}, {-1, 1, 1}}, 10);
  s.scene.transfer_functions = {ramp(1, 0.3)};
  s.scene.render.lighting.enabled = true;
  const LightSource side{Vector3d{-0.5, 0.7, 0.4}, 0.5}, head{{}, 0.3}, below{Vector3d{0, -2, 1}};
  using Lights = std::vector<LightSource>;
  for (const Lights& lights :
       {Lights{}, {side}, {head}, {side, head}, {below, side}, {below, side, head, below}}) {
    s.scene.render.lighting.lights = lights;
    check(s, fmt::format("{} lights", lights.size()));
  }
}

TEST(Engines, EveryShininessFromTheSide) {
  // Thin samples, the light anywhere but at the eye; shininess by a few multiplications and by
  // logarithms.
  PlainScene s = plain_scene({{0, 0, 0}, {1, 1, 0}, {-1, 1, 1}}, 10);
  s.scene.transfer_functions = {ramp(1, 0.3)};
  s.scene.render.lighting.enabled = true;
  s.scene.render.lighting.lights = {{Vector3d{-0.5, 0.7, 0.4}}};
  for (int fields = 1; fields <= 2; ++fields) {
    for (const double shininess : {0.0, 0.5, 1.0, 3.0, 20.0, 32.0, 1023.0, 2000.0}) {
      s.scene.render.lighting.shininess = shininess;
      check(s, fmt::format("{} fields, shininess {}", fields, shininess));
    }
    s.scene.fields.push_back(s.scene.fields[0]);
    s.scene.transfer_functions.push_back(ramp(0.7, 0.2));
  }
}

TEST(Engines, ManyUnevenPoints) {
  // More segments than any vector has lanes, found by bisection; then beside a field with few.
  TransferFunction function;
  for (int i = 0; i < 40; ++i) {
    const double value = 0.001 * i * i;
    const auto part = static_cast<float>(i) / 40;
    function.points.push_back({value, {part, 1 - part, 0.5F}, 0.2 + 0.1 * (i % 3)});
  }
  PlainScene s = plain_scene({{0, 0, 0}, {1, 1, 0}, {-1, 1, 1}}, 10);
  s.scene.transfer_functions = {function};
  check(s, "many");
  s.scene.fields.push_back(s.scene.fields[0]);
  s.scene.transfer_functions.push_back(
      {{{0, {1, 0, 0}, 0}, {0.1, {0, 1, 0}, 0.3}, {0.5, {0, 0, 1}, 0.1}}, false});
  check(s, "many, and few");
}

TEST(Engines, FirstOfSeveralFieldsEndsRays) {
  // All fields of the sample at which a ray becomes opaque are seen, though the first would do; its
  // fields are more than are composited together.
  PlainScene s = plain_scene({{0, 0, 0}, {1, 1, 0}, {-1, 1, 1}}, 10);
  s.scene.transfer_functions = {{{{0.3, {1, 0, 0}, 0}, {0.31, {1, 0, 0}, 12}}, false}};
  for (int f = 1; f < 7; ++f) {
    s.scene.fields.push_back(s.scene.fields[0]);
    s.scene.transfer_functions.push_back(ramp(1 + 0.2 * f, 0.2 * f));
  }
  check(s, "seven fields");
  s.scene.render.lighting.enabled = true;
  check(s, "seven fields, lit");
}

TEST(Engines, OneLitFieldAndFourUnlitOnesInTurn) {
  // As many channels in all: what a thread keeps from one frame to the next must fit both.
  PlainScene one = plain_scene({{0, 0, 0}, {1, 1, 0}, {-1, 1, 1}}, 10);
  PlainScene four = one;
  one.scene.render.lighting.enabled = true;
  for (int f = 1; f < 4; ++f) {
    four.scene.fields.push_back(four.scene.fields[0]);
    four.scene.transfer_functions.push_back(ramp(1 + 0.3 * f, 0.3));
  }
  const auto render = [](const PlainScene& s) {
    RenderOptions options;
    options.threads = 1;
    return Renderer(s.particles, s.scene.fields).render(s.scene, options);
  };
  // A new thread has kept nothing.
  const auto render_anew = [&](const PlainScene& s) {
    Framebuffer image;
    std::thread([&] { image = render(s); }).join();
    return image;
  };
  const Framebuffer lit = render_anew(one), unlit = render_anew(four);
  for (int turn = 0; turn < 3; ++turn) {
    EXPECT_EQ(render(one), lit) << turn;
    EXPECT_EQ(render(four), unlit) << turn;
  }
}

TEST(Engines, MoreFieldsThanOnePassHolds) {
  PlainScene s = plain_scene({{0, 0, 0}, {1, 1, 0}, {-1, 1, 1}}, 10);
  const FieldSource first = s.scene.fields[0];
  for (int f = 1; f < 64; ++f) {
    s.scene.fields.push_back(first);
    s.scene.fields.back().kernel.support_factor = 1 + 0.02 * f;
    s.scene.transfer_functions.push_back(ramp(1 + 0.1 * f, 0.05));
  }
  check(s, "64 fields");
}

TEST(Engines, FogShowsTheWholeBox) {
  PlainScene s = plain_scene({{0, 0, 0}, {30, 20, 10}}, 90);
  s.scene.transfer_functions = {{{{.value = 0, .color = {1, 1, 1}, .extinction = 0.01}}, false}};
  check(s, "fog");
}

}  // namespace
}  // namespace motes
