// What a style makes of scenes of particles and of grids.
#include "scene/style.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"

namespace motes {
namespace {

using testing::ThrowsMessage;

constexpr DataContents atoms{}, grids{.particles = false, .grids = true},
    atoms_and_grids{.particles = true, .grids = true};

Scene styled(const std::string& name, const DataContents& data, const std::vector<Field>& fields) {
  Scene scene;
  scene.fields = fields;
  apply_style(name, scene, data);
  return scene;
}

Field grid_field(const std::string& array) {
  Field field;
  field.grid.emplace().array = array;
  return field;
}

TEST(ApplyStyle, ShowsTheGridsOfTheDataWhereThereAreNoFields) {
  for (const std::string name : {"volume", "volume+balls", "surface"}) {
    EXPECT_FALSE(styled(name, atoms, {}).fields.at(0).grid) << name;
    const Scene scene = styled(name, atoms_and_grids, {});
    ASSERT_EQ(scene.fields.size(), 1u);
    FieldGrid expected;
    if (name == "surface") expected.interpolation = Reconstruction::tricubic;
    EXPECT_EQ(scene.fields[0].grid, expected) << name;
    EXPECT_EQ(scene.fields[0].fitted_isosurfaces, name == "surface");
  }
  EXPECT_TRUE(styled("spheres", atoms_and_grids, {}).fields.empty());
}

TEST(ApplyStyle, SurfacesOfGridsKeepThemAndHaveTheAtomsAmongThem) {
  Field field = grid_field("b");
  field.isosurfaces = {{3, {}, 1}};
  field.transfer_function = NamedTransferFunction{"magma", {}, {}, {}};
  const Scene scene = styled("surface", atoms_and_grids, {grid_field("a"), Field{}, field});
  Field surfaces = grid_field("a");
  surfaces.fitted_isosurfaces = true;
  EXPECT_EQ(scene.fields[0], surfaces);
  surfaces.grid->array = "b";
  EXPECT_EQ(scene.fields[1], surfaces);
  EXPECT_FALSE(scene.fields[1].draws_volume());
  EXPECT_EQ(scene.fields.size(), 2u) << "the field of particles is none";
  EXPECT_EQ(scene.geometry, styled("ball-and-stick", atoms, {}).geometry);
  EXPECT_TRUE(styled("surface", grids, {}).geometry.empty());
}

TEST(ApplyStyle, SurfacesOfParticlesAreTheMolecularOne) {
  const Scene scene = styled("surface", atoms, {Field{}});
  ASSERT_EQ(scene.fields.size(), 1u);
  EXPECT_EQ(scene.fields[0].isosurfaces, (std::vector<Isosurface>{{0.5, ColorBy::element, 1}}));
  EXPECT_FALSE(scene.fields[0].fitted_isosurfaces);
  EXPECT_TRUE(scene.geometry.empty());
}

TEST(CheckFieldsOfStyle, RefusesFieldsThatWouldNotBeDrawn) {
  const std::vector<Field> of_grids{grid_field("a")}, of_both{grid_field("a"), Field{}};
  EXPECT_NO_THROW(check_fields_of_style("volume", of_both));
  EXPECT_NO_THROW(check_fields_of_style("surface", of_grids));
  EXPECT_THAT([&] { check_fields_of_style("surface", of_both); },
              ThrowsMessage<Error>("expected no fields of particles with the style 'surface', "
                                   "which draws none of them"));
  EXPECT_THAT([&] { check_fields_of_style("spheres", of_grids); },
              ThrowsMessage<Error>(
                  "expected no fields with the style 'spheres', which draws none of them"));
  EXPECT_THROW(check_fields_of_style("blob", {}), Error);
}

TEST(ParseScene, StylesAreGeometry) {
  const auto parse_style = [](const std::string& rest) {
    return parse_scene(R"({"version": 1, "data": {"path": "a.xyz"}, "style": )" + rest + "}",
                       "s.json");
  };
  EXPECT_TRUE(parse_style(R"("spheres")").fields.empty());
  ASSERT_EQ(parse_style(R"("spheres")").geometry.size(), 1u);
  const Scene both = parse_style(R"("volume+balls", "fields": [{"name": "a"}])");
  ASSERT_EQ(both.fields.size(), 1u);
  EXPECT_EQ(both.fields[0].name, "a");
  ASSERT_EQ(both.geometry.size(), 2u);
  EXPECT_EQ(both.geometry[1].type, Geometry::Type::sticks);
  EXPECT_EQ(parse_style(R"("volume")").fields.size(), 1u);
}

TEST(ParseScene, StylesAreOfWhatTheDataHave) {
  const auto look = [](const std::filesystem::path& path) {
    return DataContents{.particles = path != "dir/heat.nrrd", .grids = !path.empty()};
  };
  const auto parse_style = [&](const std::string& rest) {
    return parse_scene(R"({"version": 1, )" + rest + "}", "dir/s.json", look);
  };
  Scene scene = parse_style(R"("data": {"path": "heat.nrrd"}, "style": "surface")");
  EXPECT_TRUE(scene.fields.at(0).grid);
  EXPECT_TRUE(scene.fields[0].fitted_isosurfaces);
  EXPECT_TRUE(scene.geometry.empty());
  scene =
      parse_style(R"("data": {"path": "a.cube"}, "fields": [{"grid": {}}], "style": "surface")");
  EXPECT_EQ(scene.geometry.size(), 2u);
  // A scene without data.
  scene = parse_scene(R"({"version": 1, "fields": [{"grid": "heat.nrrd"}], "style": "surface"})",
                      "dir/s.json");
  EXPECT_TRUE(scene.geometry.empty());
  EXPECT_TRUE(scene.fields.at(0).fitted_isosurfaces);
}

TEST(Style, SuggestsWhatAnotherProgramsNameMeans) {
  for (const auto& [name, meant] :
       {std::pair{"balls", "did you mean 'spheres' or 'ball-and-stick'?"},
        {"licorice", "did you mean 'ball-and-stick'?"},
        {"surfaces", "did you mean 'surface'?"}}) {
    Scene scene;
    try {
      apply_style(name, scene);
      FAIL() << name;
    } catch (const Error& error) {
      EXPECT_THAT(error.what(), testing::HasSubstr(meant));
    }
  }
}

}  // namespace
}  // namespace motes
