// Fields that are grids: which there are, in what colours, with what surfaces.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <set>

#include "scene/scene.h"
#include "scene/transfer_function.h"

namespace motes {
namespace {

LoadedGrid loaded(const std::string& name, const UninitializedVector<float>& values) {
  Grid grid;
  grid.name = name;
  grid.dims = {values.size(), 1, 1};
  grid.steps = {Vector3d{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  grid.values = values;
  grid.periodic = true;
  return {"", std::make_shared<const Grid>(std::move(grid))};
}

/// A scene of all grids of its data.
Scene scene_of_grids() {
  Scene scene;
  scene.fields.emplace_back().grid.emplace();
  return scene;
}

TEST(ExpandFields, FitsIsosurfacesOfGrids) {
  Scene scene = scene_of_grids();
  scene.fields[0].fitted_isosurfaces = true;
  const auto fields =
      expand_fields(scene, {},
                    {loaded("density", {0, 4, 0}), loaded("orbital", {-3, 0, 3}),
                     loaded("hole", {0, -4, 0}), loaded("other orbital", {-1, 0, 1})});
  ASSERT_EQ(fields.size(), 4u);
  for (const Field& field : fields) {
    EXPECT_FALSE(field.fitted_isosurfaces);
    EXPECT_FALSE(field.draws_volume());
    for (const Isosurface& surface : field.isosurfaces) EXPECT_EQ(surface.opacity, 1);
  }
  const auto values = [&fields](std::size_t f) {
    std::vector<double> all;
    for (const Isosurface& surface : fields[f].isosurfaces) all.push_back(surface.value);
    return all;
  };
  EXPECT_THAT(values(0), testing::ElementsAre(2));
  EXPECT_THAT(values(1), testing::ElementsAre(1.5, -1.5));
  EXPECT_THAT(values(2), testing::ElementsAre(-2));
  EXPECT_THAT(values(3), testing::ElementsAre(0.5, -0.5));
  std::set<std::uint32_t> colors;
  for (const Field& field : fields) {
    for (const Isosurface& surface : field.isosurfaces) {
      colors.insert(color_to_srgb(std::get<Color>(surface.color.value())));
    }
  }
  EXPECT_EQ(colors.size(), 6u) << "no two alike";
  for (const std::size_t orbital : {1u, 3u}) {
    const FieldColors own = colors_of_grid(orbital);
    EXPECT_EQ(std::get<Color>(*fields[orbital].isosurfaces[0].color), own.positive);
    EXPECT_EQ(std::get<Color>(*fields[orbital].isosurfaces[1].color), own.negative);
  }
}

// Four colours in one place tell nothing.
TEST(ExpandFields, ShowsOneOfSeveralGridsOfBothSigns) {
  const std::vector<LoadedGrid> grids{loaded("density", {0, 4, 0}), loaded("homo", {-3, 0, 3}),
                                      loaded("lumo", {-1, 0, 1})};
  const auto visible = [&](const Scene& scene) {
    std::vector<bool> all;
    for (const Field& field : expand_fields(scene, {}, grids)) all.push_back(field.visible);
    return all;
  };
  EXPECT_THAT(visible(scene_of_grids()), testing::ElementsAre(true, true, false));
  Scene hidden = scene_of_grids();
  hidden.fields[0].visible = false;
  EXPECT_THAT(visible(hidden), testing::ElementsAre(false, false, false));
  Scene named = scene_of_grids();
  named.fields[0].grid->array = "homo";
  named.fields.emplace_back().grid.emplace().array = "lumo";
  EXPECT_THAT(visible(named), testing::ElementsAre(true, true));
}

// It ends where the grid does: at half of its value.
TEST(ExpandFields, FitsTheSurfaceOfAGridOfOneValue) {
  Scene scene = scene_of_grids();
  scene.fields[0].fitted_isosurfaces = true;
  const auto fields =
      expand_fields(scene, {}, {loaded("seven", {7, 7, 7}), loaded("hole", {-2, -2})});
  ASSERT_EQ(fields.size(), 2u);
  EXPECT_EQ(fields[0].isosurfaces[0].value, 3.5);
  EXPECT_EQ(fields[1].isosurfaces[0].value, -1);
}

TEST(ExpandFields, FitsNoIsosurfaceThatASignDoesNotReach) {
  Scene scene = scene_of_grids();
  scene.fields[0].fitted_isosurfaces = true;
  const auto level_of = [&](const std::vector<float>& values) {
    const auto fields = expand_fields(scene, {}, {loaded("spin", {values.begin(), values.end()})});
    EXPECT_EQ(fields[0].isosurfaces.size(), 1u);
    EXPECT_EQ(std::get<Color>(*fields[0].isosurfaces[0].color), colors_of_grid(0).own);
    return fields[0].isosurfaces[0].value;
  };
  // As if the other sign were not there.
  EXPECT_EQ(level_of({-0.5F, 4, 0}), 2);
  EXPECT_EQ(level_of({0.5F, -4, 0}), -2);
}

/// A bell of that width around a place on the x axis, on n^3 samples in the middle of which it is.
LoadedGrid bell(const std::string& name, double x, double width, int n, double step) {
  Grid grid;
  grid.name = name;
  grid.dims.fill(static_cast<std::size_t>(n));
  const double half = 0.5 * step * (n - 1);
  grid.origin = {x - half, -half, -half};
  // Two axes change places, so that steps are no numbers along the world's.
  grid.steps = {Vector3d{0, step, 0}, {step, 0, 0}, {0, 0, step}};
  for (int k = 0; k < n; ++k) {
    for (int j = 0; j < n; ++j) {
      for (int i = 0; i < n; ++i) {
        const Vector3d r = grid.position(i, j, k) - Point3d{x, 0, 0};
        grid.values.push_back(static_cast<float>(std::exp(-dot(r, r) / (2 * width * width))));
      }
    }
  }
  return {{}, std::make_shared<const Grid>(std::move(grid))};
}

TEST(ExpandFields, MakesFittedIsosurfacesTranslucentThatHideOthers) {
  Scene scene = scene_of_grids();
  scene.fields[0].fitted_isosurfaces = true;
  const auto opacities = [&](const std::vector<LoadedGrid>& grids) {
    std::vector<double> all;
    for (const Field& field : expand_fields(scene, {}, grids)) {
      EXPECT_FALSE(field.fitted_isosurfaces);
      all.push_back(field.isosurfaces.at(0).opacity);
    }
    return all;
  };
  const LoadedGrid outer = bell("outer", 0, 4, 30, 1), inner = bell("inner", 1, 1, 20, 0.5);
  EXPECT_THAT(opacities({outer}), testing::ElementsAre(1));
  EXPECT_THAT(opacities({outer, inner}), testing::ElementsAre(0.35, 1));
  EXPECT_THAT(opacities({inner, outer}), testing::ElementsAre(1, 0.35));
  EXPECT_THAT(opacities({outer, outer}), testing::ElementsAre(1, 1)) << "neither is within";
  EXPECT_THAT(opacities({outer, bell("half out", 9, 1, 20, 0.5)}), testing::ElementsAre(1, 1));
  EXPECT_THAT(opacities({outer, bell("beside", 60, 1, 20, 0.5)}), testing::ElementsAre(1, 1));
  EXPECT_THAT(opacities({bell("small", 0, 0.3, 20, 0.2), inner, outer}),
              testing::ElementsAre(1, 0.35, 0.35));
}

TEST(ColorsOfGrid, AreOrangeAndBlueForBothSignsOfTheFirst) {
  EXPECT_EQ(color_to_srgb(colors_of_grid(0).positive), 0xe8702aU);
  EXPECT_EQ(color_to_srgb(colors_of_grid(0).negative), 0x2f6fe4U);
}

TEST(MakeFieldSources, TellsSeveralGridsApart) {
  const std::vector<LoadedGrid> grids{loaded("a", {0, 1}), loaded("b", {0, 1}),
                                      loaded("c", {0, 1})};
  const auto sources_of = [](const std::vector<LoadedGrid>& some) {
    Warnings warnings;
    return make_field_sources({}, expand_fields(scene_of_grids(), {}, some), {}, warnings, nullptr,
                              some);
  };
  EXPECT_FALSE(sources_of({grids[0]})[0].colors.prefers_own);
  std::set<std::uint32_t> own, signs;
  for (const FieldSource& source : sources_of(grids)) {
    EXPECT_TRUE(source.colors.prefers_own);
    own.insert(color_to_srgb(source.colors.own));
    signs.insert(color_to_srgb(source.colors.positive));
    signs.insert(color_to_srgb(source.colors.negative));
  }
  EXPECT_EQ(own.size(), 3u);
  EXPECT_EQ(signs.size(), 6u);
}

}  // namespace
}  // namespace motes
