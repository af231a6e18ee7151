// Filled-in scenes: nothing is open, and what is plain is a number or a colour map.
#include "scene/fill_in.h"

#include <gtest/gtest.h>

#include "scene/fit.h"

namespace motes {
namespace {

const NamedTransferFunction viridis{"viridis", {{0.1, 0.7}}, 0.3, false};

struct Resolved {
  std::vector<Field> fields;
  std::vector<FieldSource> sources;
  ResolvedScene scene;
};

/// Two fields: of one radius and weight in viridis; of several radii and masses in a species'
/// colour.
Resolved two_fields() {
  Resolved resolved;
  resolved.fields.resize(2);
  resolved.sources.resize(2);
  resolved.sources[0].radius = {1.11f, 1.11f};
  resolved.sources[0].weight = {1};
  resolved.sources[1].radius = {1, 2};
  resolved.sources[1].weight = {3, 4};
  resolved.sources[1].normalise = true;
  resolved.fields[1].transfer_function =
      NamedTransferFunction{std::string(species_colors), {}, {}, {}};
  resolved.scene.transfer_functions = {
      fit_transfer_function(viridis, {}, {}, 0),
      TransferFunction{{{0.1, {1, 0, 0}, 0}, {0.7, {1, 1, 0}, 2}}, false}};
  resolved.scene.camera.eye = {1, 2, 3};
  resolved.scene.step_size = 0.25;
  return resolved;
}

TEST(FillIn, LeavesNothingOpen) {
  const Resolved resolved = two_fields();
  const Scene filled = fill_in({}, resolved.fields, resolved.sources, resolved.scene);
  EXPECT_EQ(filled.eye, (Point3d{1, 2, 3}));
  EXPECT_EQ(filled.target, resolved.scene.camera.target);
  EXPECT_EQ(filled.up, resolved.scene.camera.up);
  EXPECT_EQ(filled.fov_degrees, 45);
  EXPECT_EQ(filled.orthographic_height, std::nullopt);
  EXPECT_EQ(filled.render.step_size, 0.25);
  ASSERT_EQ(filled.fields.size(), 2u);
  const Field &plain = filled.fields[0], &masses = filled.fields[1];
  EXPECT_EQ(plain.radius, NumberOrProperty(1.11));  // no digits that a float does not have
  EXPECT_EQ(plain.weight, NumberOrProperty(1.0));
  EXPECT_EQ(plain.normalise, false);
  EXPECT_EQ(masses.radius, std::nullopt);
  EXPECT_EQ(masses.weight, NumberOrProperty("mass"));
  EXPECT_EQ(masses.normalise, true);
}

TEST(FillIn, NamesAColourMapWhereItIsTheSame) {
  Resolved resolved = two_fields();
  const auto function = [&](std::size_t field) {
    return fill_in({}, resolved.fields, resolved.sources, resolved.scene)
        .fields[field]
        .transfer_function;
  };
  EXPECT_EQ(std::get<NamedTransferFunction>(function(0)), viridis);
  EXPECT_EQ(std::get<TransferFunction>(function(1)), resolved.scene.transfer_functions[1]);
  // As for values of both signs: its extinction does not rise from 0.
  resolved.scene.transfer_functions[0].points.front().extinction = 0.3;
  EXPECT_EQ(std::get<TransferFunction>(function(0)), resolved.scene.transfer_functions[0]);
}

TEST(FillIn, KeepsWhatWasGiven) {
  Resolved resolved = two_fields();
  resolved.fields[0].radius = "h";
  resolved.fields[0].weight = "charge";
  resolved.scene.camera.orthographic_height = 9;
  Scene scene;
  scene.frame = 3;
  scene.orthographic_height = 9;
  const Scene filled = fill_in(scene, resolved.fields, resolved.sources, resolved.scene);
  EXPECT_EQ(filled.fields[0].radius, NumberOrProperty("h"));
  EXPECT_EQ(filled.fields[0].weight, NumberOrProperty("charge"));
  EXPECT_EQ(filled.frame, 3u);
  EXPECT_EQ(filled.orthographic_height, 9);
  EXPECT_EQ(filled.fov_degrees, std::nullopt);
}

}  // namespace
}  // namespace motes
