// Which particles, radii and weights a field takes, and what it leaves out.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/error.h"
#include "scene/scene.h"

namespace motes {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr float infinity = std::numeric_limits<float>::infinity();

ParticleSet silica() {
  ParticleSet particles;
  particles.x = {0, 1, 2, 3};
  particles.y = particles.z = {0, 0, 0, 0};
  particles.species_names = {"Si", "O"};
  particles.species = {0, 1, 1, 0};
  particles.properties = {{"charge", {2, -1, -1, 2}}, {"size", {0.5f, 0, NAN, infinity}}};
  particles.length_unit = "angstrom";
  return particles;
}

template <class F>
std::string message_of(F&& function) {
  try {
    function();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

/// The source of one field alone.
FieldSource make_field_source(const ParticleSet& particles, const Field& field,
                              const Kernel& kernel, Warnings& warnings) {
  return make_field_sources(particles, {field}, kernel, warnings).front();
}

TEST(SelectParticles, AllThatIsGivenMustHold) {
  const ParticleSet particles = silica();
  EXPECT_THAT(select_particles(particles, {}), ElementsAre(0, 1, 2, 3));
  EXPECT_THAT(select_particles(particles, {{"O"}, {}, ""}), ElementsAre(1, 2));
  EXPECT_THAT(select_particles(particles, {{"Si", "O"}, {{1, 3}}, ""}), ElementsAre(1, 2, 3));
  EXPECT_THAT(select_particles(particles, {{"O"}, {{2, 99}}, "x < 9"}), ElementsAre(2));
  EXPECT_THAT(select_particles(particles, {{"Si"}, {}, "charge < 0"}), testing::IsEmpty());
}

TEST(SelectParticles, NamesWhatThereIs) {
  EXPECT_THAT(message_of([] {
                select_particles(silica(), {{"Sj"}, {}, ""});
              }),
              HasSubstr("unknown species 'Sj'; did you mean 'Si'?"));
  ParticleSet numbered = silica();
  numbered.species_names = {"1", "2"};
  EXPECT_EQ(message_of([&] {
              select_particles(numbered, {{"Si"}, {}, ""});
            }),
            "unknown species 'Si'; there are: 1, 2; numeric types get names by \"types\" in "
            "\"data\" or --types 1=Si");
  ParticleSet bare = silica();
  bare.species.clear();
  EXPECT_THAT(message_of([&] {
                select_particles(bare, {{"Si"}, {}, ""});
              }),
              HasSubstr("no species"));
}

TEST(MakeFieldSources, DefaultsToCovalentRadiiAndWeightOne) {
  Warnings warnings;
  const FieldSource source = make_field_source(silica(), {}, {}, warnings);
  EXPECT_THAT(source.index, ElementsAre(0, 1, 2, 3));
  EXPECT_THAT(source.radius, ElementsAre(1.11f, 0.66f, 0.66f, 1.11f));
  EXPECT_THAT(source.weight, ElementsAre(1));
  EXPECT_FALSE(source.normalise);
  EXPECT_THAT(warnings.lines(), testing::IsEmpty());
}

TEST(MakeFieldSources, DefaultRadiiGiveAllKernelsTheSameWidth) {
  Warnings warnings;
  const FieldSource gaussian = make_field_source(silica(), {}, {}, warnings);
  Field field;
  field.kernel_shape = KernelShape{KernelType::cubic_spline, {}};
  const FieldSource spline = make_field_source(silica(), field, {}, warnings);
  ASSERT_EQ(spline.radius.size(), gaussian.radius.size());
  for (std::size_t i = 0; i < spline.radius.size(); ++i) {
    // H = 2 h = 3.651 sigma (Dehnen & Aly 2012).
    EXPECT_NEAR(spline.radius[i], 3.651484f / 2 * gaussian.radius[i], 1e-5f);
    EXPECT_NEAR(spline.width_of(i), gaussian.width_of(i), 1e-5);
  }
  field.radius = 3.0;
  EXPECT_THAT(make_field_source(silica(), field, {}, warnings).radius, ElementsAre(3));
  field = {};
  field.kernel_shape = KernelShape{KernelType::tabulated, {"", 0.5, {1, 0.5, 0}}};
  EXPECT_THAT(make_field_source(silica(), field, {}, warnings).radius, ElementsAre(1));
}

TEST(MakeFieldSources, RefusesToNormaliseWhatHasNoIntegral) {
  Warnings warnings;
  Field field;
  field.name = "dipoles";
  field.normalise = true;
  field.kernel_shape = KernelShape{KernelType::tabulated, {"", 1, {0, 0}}};
  EXPECT_EQ(
      message_of([&] { make_field_source(silica(), field, {}, warnings); }),
      "field 'dipoles': its table integrates to 0 and cannot be normalised; expected more than 0");
}

TEST(MakeFieldSources, TakesNumbersAndProperties) {
  Warnings warnings;
  Field field;
  field.select.species = {"O"};
  field.radius = 2.5;
  field.weight = "charge";
  field.normalise = true;
  field.support_factor = 3;
  const FieldSource source = make_field_source(silica(), field, {2.5, 7}, warnings);
  EXPECT_THAT(source.index, ElementsAre(1, 2));
  EXPECT_THAT(source.radius, ElementsAre(2.5f));
  EXPECT_THAT(source.weight, ElementsAre(-1, -1));
  EXPECT_TRUE(source.normalise);
  EXPECT_EQ(source.kernel, (Kernel{3, 7}));
}

TEST(MakeFieldSources, TakesTheElementsRadiiByName) {
  Warnings warnings;
  Field field;
  field.radius = "van_der_waals";
  field.isosurfaces = {{0.5, ColorBy::element, 1}};
  const FieldSource source = make_field_source(silica(), field, {}, warnings);
  // Mantina et al. 2009.
  EXPECT_THAT(source.radius, ElementsAre(2.10F, 1.52F, 1.52F, 2.10F));
  EXPECT_TRUE(source.colored_by_species);
  // A property of that name goes first.
  ParticleSet particles = silica();
  particles.properties.push_back({"covalent", {4, 5, 6, 7}});
  field.radius = "covalent";
  EXPECT_THAT(make_field_source(particles, field, {}, warnings).radius, ElementsAre(4, 5, 6, 7));
  // Without elements there are only the particles' own.
  particles = silica();
  particles.species_names.assign(particles.species_names.size(), "gas");
  particles.properties = {{"radius", {1, 2, 3, 4}}};
  EXPECT_THAT(make_field_source(particles, field, {}, warnings).radius, ElementsAre(1, 2, 3, 4));
}

TEST(MakeFieldSources, TakesADensityWhereParticlesHaveASize) {
  ParticleSet particles = silica();
  particles.properties = {{"h", {2, 2, 2, 2}}, {"radius", {1, 1, 1, 2}}, {"mass", {3, 4, 5, 6}}};
  Warnings warnings;
  FieldSource source = make_field_source(particles, {}, {}, warnings);
  EXPECT_THAT(source.radius, ElementsAre(1, 1, 1, 2));
  EXPECT_THAT(source.weight, ElementsAre(3, 4, 5, 6));
  EXPECT_TRUE(source.normalise);
  particles.properties.pop_back();
  source = make_field_source(particles, {}, {}, warnings);
  EXPECT_THAT(source.weight, ElementsAre(1));
  EXPECT_TRUE(source.normalise) << "without masses, a density of number";
  Field field;
  field.weight = 1.0;
  source = make_field_source(particles, field, {}, warnings);
  EXPECT_THAT(source.weight, ElementsAre(1));
  EXPECT_FALSE(source.normalise);
}

TEST(MakeFieldSources, LeavesOutWhatHasNoKernelAndCounts) {
  ParticleSet particles = silica();
  Warnings warnings;
  Field field;
  field.name = "f";
  field.radius = "size";
  EXPECT_THAT(make_field_source(particles, field, {}, warnings).index, ElementsAre(0));
  EXPECT_THAT(warnings.lines(),
              ElementsAre("field 'f': 3 of 4 particles left out: their radii are not finite "
                          "numbers greater than 0"));

  particles.x[1] = NAN;
  particles.z[2] = -infinity;
  particles.properties[0].values[3] = NAN;
  field.radius = 1.0;
  field.weight = "charge";
  warnings = {};
  EXPECT_THAT(make_field_source(particles, field, {}, warnings).index, ElementsAre(0));
  EXPECT_THAT(warnings.lines(),
              ElementsAre("field 'f': 2 of 4 particles left out: their positions are not finite",
                          "field 'f': 1 of 4 particles left out: their weights are not finite"));
}

TEST(MakeFieldSources, RefusesFieldsWithoutParticles) {
  Warnings warnings;
  Field field;
  field.name = "f";
  field.select.expression = "x > 10";
  EXPECT_EQ(message_of([&] { make_field_source(silica(), field, {}, warnings); }),
            "field 'f' selects none of the 4 particles");
  field.select.expression = "species == 'Si' && species == \"Xe\"";
  EXPECT_EQ(message_of([&] { make_field_source(silica(), field, {}, warnings); }),
            "field 'f' selects none of the 4 particles; unknown species 'Xe'; there are: Si, O");
  EXPECT_THAT(message_of([&] { make_field_source(ParticleSet{}, {}, {}, warnings); }),
              HasSubstr("no particles"));
  field.select = {};
  field.radius = "charg";
  EXPECT_EQ(message_of([&] { make_field_source(silica(), field, {}, warnings); }),
            "radius: unknown property 'charg'; did you mean 'charge'?");
}

/// Counts how often work begins.
class CountedWork : public Progress {
 public:
  void update(std::string_view activity, double fraction) override {
    EXPECT_EQ(activity, "finding neighbours");
    EXPECT_LE(fraction, 1);
    begun += !(fraction > last_fraction);
    last_fraction = fraction;
  }
  int begun = 0;
  double last_fraction = 1;
};

TEST(MakeFieldSources, FindsNeighboursOnceForAllFields) {
  ParticleSet particles;
  for (int i = 0; i < 100; ++i) {
    particles.x.push_back(static_cast<float>(i));
    particles.species.push_back(i % 2 == 0 ? 0 : 1);
  }
  particles.y = particles.z = std::vector<float>(100);
  particles.species_names = {"dark", "stars"};
  particles.radii_from_neighbors = true;
  Warnings warnings;
  const std::vector<float> alone = make_field_source(particles, {}, {}, warnings).radius;

  std::vector<Field> fields(3);
  fields[0].select = {{"dark"}, {{0, 49}}, ""};
  fields[1].select = {{"dark"}, {{30, 69}}, ""};
  fields[2].select = {{"stars"}, {}, ""};
  fields[2].radius = 1.0;
  CountedWork work;
  const std::vector<FieldSource> sources =
      make_field_sources(particles, fields, {}, warnings, &work);
  EXPECT_EQ(work.begun, 1) << "the stars have a radius";
  EXPECT_EQ(work.last_fraction, 1);
  ASSERT_EQ(sources.size(), 3u);
  for (int f : {0, 1}) {
    const FieldSource& source = sources[static_cast<std::size_t>(f)];
    ASSERT_GT(source.index.size(), 0u);
    // Neighbours that no field takes count all the same.
    for (std::size_t i = 0; i < source.index.size(); ++i) {
      EXPECT_EQ(source.radius_of(i), alone[source.index[i]]);
    }
  }
  EXPECT_EQ(sources[2].radius, std::vector<float>{1});
}

TEST(ExpandFields, GivesEveryFieldANameOfItsOwn) {
  Scene scene;
  scene.fields.resize(2);
  scene.fields[0].name = "field1";  // what the second is called for lack of a name
  const std::vector<Field> fields = expand_fields(scene, silica());
  EXPECT_EQ(fields[0].name, "field1");
  EXPECT_EQ(fields[1].name, "field1_2");
}

TEST(ExpandFields, GivesOneFieldOfAllByDefault) {
  const auto fields = expand_fields({}, silica());
  ASSERT_EQ(fields.size(), 1u);
  EXPECT_EQ(fields[0].name, "all");
  EXPECT_EQ(fields[0].select, Selection{});
}

TEST(ExpandFields, SpeciesColoursMakeAFieldOfEachSpecies) {
  Scene scene;
  scene.fields.resize(1);
  scene.fields[0].transfer_function = NamedTransferFunction{"species", {}, {}, {}};
  const auto fields = expand_fields(scene, silica());
  ASSERT_EQ(fields.size(), 2u);
  EXPECT_EQ(fields[0].name, "Si");
  EXPECT_THAT(fields[0].select.species, ElementsAre("Si"));
  EXPECT_EQ(fields[1].name, "O");

  Warnings warnings;
  const Color oxygen = make_field_source(silica(), fields[1], {}, warnings).colors.own;
  EXPECT_GT(oxygen.r, 4 * oxygen.g);
}

TEST(ColorBySpecies, IsTheDefaultWhereSpeciesAreElements) {
  const NamedTransferFunction species{"species", {}, {}, {}};
  const auto colored = [](Scene scene, const ParticleSet& particles) {
    color_by_species(scene, particles);
    return scene.fields;
  };
  ASSERT_EQ(colored({}, silica()).size(), 1u);
  EXPECT_EQ(std::get<NamedTransferFunction>(colored({}, silica())[0].transfer_function), species);

  // What a scene says stays.
  Scene scene;
  scene.fields.resize(1);
  scene.fields[0].transfer_function = NamedTransferFunction{"magma", {}, {}, {}};
  EXPECT_EQ(colored(scene, silica()), scene.fields);
  scene.fields[0] = {};
  scene.fields[0].select.species = {"Si"};
  EXPECT_EQ(colored(scene, silica()), scene.fields);
  scene.fields.assign(2, {});
  EXPECT_EQ(colored(scene, silica()), scene.fields);

  // Several names of an element count once.
  ParticleSet many = silica();
  many.species_names = {"Si", "O", "O1", "O2", "O3", "O4", "O5", "O6", "O7", "O8"};
  many.species = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9};
  EXPECT_EQ(colored({}, many).size(), 1u);
  many.species_names = {"O1", "O2"};
  many.species = {0, 1, 0, 1};
  EXPECT_TRUE(colored({}, many).empty());

  // One species, beads that are no elements, and densities keep the colour map.
  ParticleSet particles = silica();
  particles.species = {1, 1, 1, 1};
  EXPECT_TRUE(colored({}, particles).empty());
  particles = silica();
  particles.species_names[1] = "bead";
  EXPECT_TRUE(colored({}, particles).empty());
  particles = silica();
  particles.properties.push_back({"radius", {1, 1, 1, 1}});
  EXPECT_TRUE(colored({}, particles).empty());
}

TEST(ExpandFields, RefusesMoreThanAnEngineTakes) {
  Scene scene;
  scene.fields.resize(max_fields + 1);
  EXPECT_THAT(message_of([&] { expand_fields(scene, silica()); }), HasSubstr("at most 64"));
}

}  // namespace
}  // namespace motes
