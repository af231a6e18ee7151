// Snapshots of GADGET and its kin, and Phantom's dumps.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <numeric>

#include "core/error.h"
#include "io/reader.h"
#include "particles/radii.h"
#include "support/hdf5_writer.h"
#include "support/shared_data.h"
#include "support/temporary_directory.h"
#include "support/truncation.h"

namespace motes {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

ParticleSet read_first(const std::filesystem::path& path) {
  Warnings warnings;
  ReadOptions options;
  options.warnings = &warnings;
  return open_trajectory(path, options)->read_frame(0);
}

const std::vector<float>& values(const ParticleSet& particles, std::string_view name) {
  const Property* property = particles.find_property(name);
  static const std::vector<float> none;
  EXPECT_NE(property, nullptr) << name;
  return property == nullptr ? none : property->values;
}

std::vector<double> counting(std::size_t n) {
  std::vector<double> numbers(n);
  std::iota(numbers.begin(), numbers.end(), 1.0);
  return numbers;
}

/// Two gas and three dark-matter particles with what all codes write.
void write_snapshot(const std::filesystem::path& path) {
  Hdf5Writer file(path);
  file.group("Header");
  file.attribute("Header", "NumPart_ThisFile", {2, 3});
  file.attribute("Header", "MassTable", {0, 7});
  file.attribute("Header", "BoxSize", {20});
  file.attribute("Header", "Time", {0.5});
  file.dataset("PartType0/Coordinates", {2, 3}, counting(6));
  file.dataset("PartType0/Masses", {2}, {1, 2});
  file.dataset("PartType0/Density", {2}, {3, 4});
  file.dataset("PartType0/Velocities", {2, 3}, counting(6));
  file.dataset("PartType0/ParticleIDs", {2}, {11, 12}, H5T_STD_U64LE);
  file.dataset("PartType1/Coordinates", {3, 3}, counting(9), H5T_IEEE_F64LE);
  file.dataset("PartType1/ParticleIDs", {3}, {13, 14, 15}, H5T_STD_U32LE);
}

TEST(GadgetHdf5, ReadsTypesMassesAndProperties) {
  const TemporaryFile file("snapshot.hdf5");
  write_snapshot(file.path());
  const ParticleSet particles = read_first(file.path());
  EXPECT_THAT(particles.species_names, ElementsAre("gas", "dark matter"));
  EXPECT_THAT(particles.species, ElementsAre(0, 0, 1, 1, 1));
  EXPECT_THAT(particles.ids, ElementsAre(11, 12, 13, 14, 15));
  EXPECT_EQ(particles.position(1), Point3d(4, 5, 6));
  EXPECT_EQ(particles.position(4), Point3d(7, 8, 9));
  EXPECT_THAT(values(particles, "mass"), ElementsAre(1, 2, 7, 7, 7));
  EXPECT_THAT(values(particles, "density"),
              ElementsAre(3, 4, testing::IsNan(), testing::IsNan(), testing::IsNan()));
  EXPECT_EQ(values(particles, "vz")[1], 6);
  EXPECT_EQ(particles.time, 0.5);
  ASSERT_TRUE(particles.cell.has_value());
  EXPECT_EQ(particles.cell->vectors[2], Vector3d(0, 0, 20));
  EXPECT_TRUE(particles.cell->periodic[0]);
  EXPECT_EQ(particles.length_unit, "unknown");
}

TEST(GadgetHdf5, DerivesRadiiFromDensityAndNeighbours) {
  const TemporaryFile file("snapshot.hdf5");
  write_snapshot(file.path());
  const ParticleSet particles = read_first(file.path());
  // The search for neighbours takes long: it is left to whoever needs radii.
  EXPECT_THAT(values(particles, "radius"),
              ElementsAre(testing::Gt(0), testing::Gt(0), testing::IsNan(), testing::IsNan(),
                          testing::IsNan()));
  EXPECT_TRUE(particles.radii_from_neighbors);
  Warnings warnings;
  const std::vector<float> radius = default_radii(particles, warnings).radius;
  // (4/3) pi H^3 density = 32 mass, and the cubic spline's sigma is H / 3.651.
  EXPECT_NEAR(radius[0], std::cbrt(32.0 / 3 * 3 / (4 * std::numbers::pi)) / 3.651484, 1e-5);
  // The two others of three lie at sqrt(27) and 2 sqrt(27) from the first: the second, scaled
  // to 32.
  EXPECT_NEAR(radius[2], 2 * std::sqrt(27.0) * std::cbrt(32 / 2.0) / 3.651484, 1e-4);
}

TEST(GadgetHdf5, ConvertsSmoothingLengthsByCode) {
  const TemporaryFile file("snapshot.hdf5");
  write_snapshot(file.path());
  {
    Hdf5Writer gadget(file.path());
    gadget.dataset("PartType0/Coordinates", {2, 3}, counting(6));
    gadget.dataset("PartType0/SmoothingLength", {2}, {3.651484, 7.302968});
  }
  EXPECT_NEAR(values(read_first(file.path()), "radius")[1], 2, 1e-6);
  EXPECT_NEAR(values(read_first(file.path()), "h")[1], 7.302968, 1e-6);
  {
    Hdf5Writer swift(file.path());
    swift.group("Header");
    swift.text_attribute("Header", "Code", "SWIFT");
    swift.group("Units");
    swift.attribute("Units", "Unit length in cgs (U_L)", {3.08567758e24});
    swift.dataset("PartType0/Coordinates", {2, 3}, counting(6));
    swift.dataset("PartType0/SmoothingLengths", {2}, {1, 3});
  }
  const ParticleSet particles = read_first(file.path());
  EXPECT_THAT(values(particles, "radius"), ElementsAre(0.5, 1.5));
  EXPECT_EQ(particles.length_unit, "Mpc");
}

TEST(GadgetHdf5, LeavesOutIntegersThatWouldLoseDigits) {
  const TemporaryFile file("snapshot.hdf5");
  {
    Hdf5Writer writer(file.path());
    writer.dataset("PartType0/Coordinates", {2, 3}, counting(6));
    writer.dataset("PartType0/GroupNr", {2}, {16777215, -1}, H5T_STD_I32LE);
    writer.dataset("PartType0/Masses", {2}, {1, 20000000}, H5T_STD_I32LE);
    writer.dataset("PartType0/Potential", {2}, {1, 20000000});
    writer.dataset("PartType0/ProgenitorIDs", {2}, {16777217, 5}, H5T_STD_U64LE);
    writer.dataset("PartType0/Tree", {2, 3}, {1, 2, 3, 4, 5, -16777217}, H5T_STD_I64LE);
    writer.dataset("PartType1/Coordinates", {2, 3}, counting(6));
    writer.dataset("PartType1/ProgenitorIDs", {2}, {1, 2}, H5T_STD_U64LE);
  }
  Warnings warnings;
  ReadOptions options;
  options.warnings = &warnings;
  const ParticleSet particles = open_trajectory(file.path(), options)->read_frame(0);
  std::vector<std::string> names;
  for (const Property& property : particles.properties) names.push_back(property.name);
  EXPECT_THAT(names, testing::UnorderedElementsAre("mass", "Potential", "GroupNr"));
  EXPECT_EQ(values(particles, "GroupNr")[0], 16777215);
  EXPECT_THAT(warnings.lines(), ElementsAre("left out as integers beyond single precision: "
                                            "ProgenitorIDs, Tree"));
}

TEST(GadgetHdf5, OfTheHeaderAndTheDataBothMustAgree) {
  const TemporaryFile file("snapshot.hdf5");
  {
    Hdf5Writer writer(file.path());
    writer.group("Header");
    writer.attribute("Header", "NumPart_ThisFile", {3, 0});
    writer.dataset("PartType0/Coordinates", {2, 3}, counting(6));
  }
  EXPECT_THAT(error_of_reading(file.path()),
              HasSubstr("/PartType0 has 2 particles; expected 3, as the header says"));
}

TEST(GadgetHdf5, RefusesColumnsOfAnotherLength) {
  const TemporaryFile file("snapshot.hdf5");
  {
    Hdf5Writer writer(file.path());
    writer.dataset("PartType0/Coordinates", {2, 3}, counting(6));
    writer.dataset("PartType0/Masses", {3}, counting(3));
  }
  EXPECT_THAT(error_of_reading(file.path()), HasSubstr("/PartType0/Masses has 3 rows; expected 2"));
}

TEST(GadgetHdf5, RefusesWhatWasNeverWritten) {
  const TemporaryFile file("snapshot.hdf5");
  { Hdf5Writer(file.path()).empty_dataset("PartType0/Coordinates", {1000000000, 3}, 1000); }
  EXPECT_THAT(error_of_reading(file.path()), HasSubstr("has 0 of its 1000000 blocks of values"));
}

TEST(GadgetHdf5, ReadsAllFilesOfASnapshot) {
  const TemporaryDirectory directory;
  for (const int part : {0, 1}) {
    Hdf5Writer writer(directory / ("snap_007." + std::to_string(part) + ".hdf5"));
    writer.group("Header");
    writer.attribute("Header", "NumFilesPerSnapshot", {2});
    writer.dataset("PartType1/Coordinates", {1, 3}, {double(part), 0, 0});
  }
  const ParticleSet particles = read_first(directory / "snap_007.1.hdf5");
  ASSERT_EQ(particles.size(), 2u);
  EXPECT_EQ(particles.position(0).x, 0);
  EXPECT_EQ(particles.position(1).x, 1);

  std::filesystem::remove(directory / "snap_007.0.hdf5");
  EXPECT_THAT(error_of_reading(directory / "snap_007.1.hdf5"),
              HasSubstr("snap_007.0.hdf5: is missing; expected all 2 files"));
}

TEST(GadgetHdf5, CellOfARunInOpenSpaceIsNotPeriodic) {
  const TemporaryFile file("snapshot.hdf5");
  {
    Hdf5Writer writer(file.path());
    writer.group("Header");
    writer.attribute("Header", "BoxSize", {10});
    writer.dataset("PartType1/Coordinates", {2, 3}, {-3, 0, 0, 3, 0, 0});
  }
  EXPECT_FALSE(read_first(file.path()).cell->periodic[0]);
}

TEST(GadgetHdf5, ReadsABareTableOfCoordinates) {
  const TemporaryFile file("halo.h5");
  { Hdf5Writer(file.path()).dataset("Coordinates", {3, 3}, counting(9)); }
  const ParticleSet particles = read_first(file.path());
  EXPECT_EQ(particles.size(), 3u);
  EXPECT_TRUE(particles.species.empty());
  EXPECT_TRUE(particles.radii_from_neighbors);
  EXPECT_EQ(particles.find_property("radius"), nullptr);
}

TEST(PhantomHdf5, ConvertsTypesAndSmoothingLengths) {
  const TemporaryFile file("dump.h5");
  {
    Hdf5Writer writer(file.path());
    writer.dataset("header/massoftype", {3}, {5, 0, 6});
    writer.dataset("header/udist", {1}, {1.495978707e13}, H5T_IEEE_F64LE);
    writer.dataset("particles/xyz", {2, 3}, counting(6), H5T_IEEE_F64LE);
    writer.dataset("particles/h", {2}, {1, -2});
    writer.dataset("particles/itype", {2}, {1, 3}, H5T_STD_I8LE);
  }
  const ParticleSet particles = read_first(file.path());
  EXPECT_THAT(particles.species_names, ElementsAre("gas", "boundary"));
  EXPECT_THAT(values(particles, "mass"), ElementsAre(5, 6));
  EXPECT_NEAR(values(particles, "radius")[0], 0.5477, 1e-4);
  // The second was accreted: a field leaves out negative radii.
  EXPECT_NEAR(values(particles, "radius")[1], -2 * 0.5477, 1e-4);
  EXPECT_EQ(particles.length_unit, "au");
}

TEST(Hdf5, OfAnUnknownLayoutIsRefusedPolitely) {
  const TemporaryFile file("a.h5");
  { Hdf5Writer(file.path()).dataset("stuff", {1}, {1}); }
  EXPECT_THAT(error_of_reading(file.path()), HasSubstr("HDF5 file of an unknown layout"));
}

TEST(Hdf5, CutShortIsAnErrorOfOneLine) {
  const TemporaryFile file("snapshot.hdf5");
  write_snapshot(file.path());
  expect_clear_errors_when_cut("snapshot.hdf5", file_content(file.path()));
}

struct SharedSnapshot {
  const char* path;
  std::size_t num_particles;
  const char* format;
  const char* length_unit;
};

class SharedSnapshots : public testing::TestWithParam<SharedSnapshot> {};

TEST_P(SharedSnapshots, HaveTheNumberOfParticlesThatTheirNotesGive) {
  const auto path = shared_file(GetParam().path);
  if (!path) GTEST_SKIP() << GetParam().path << " is not here";
  const ReadOptions options;
  const auto trajectory = open_trajectory(*path, options);
  EXPECT_EQ(trajectory->format(), GetParam().format);
  EXPECT_EQ(trajectory->num_frames(), 1u);
  const ParticleSet particles = trajectory->read_frame(0);
  EXPECT_EQ(particles.size(), GetParam().num_particles);
  EXPECT_EQ(particles.length_unit, GetParam().length_unit);
  Warnings warnings;
  const DefaultRadii radii = default_radii(particles, warnings);
  ASSERT_EQ(radii.radius.size(), particles.size());
  for (const float radius : radii.radius) ASSERT_GT(radius, 0);
}

INSTANTIATE_TEST_SUITE_P(
    Files, SharedSnapshots,
    testing::Values(
        SharedSnapshot{"files/gadget_hdf5/sphviewer_dm_halo.h5", 174312, "GADGET HDF5", "unknown"},
        SharedSnapshot{"files/swift/swift_cosmo_0001.hdf5", 16000, "SWIFT HDF5", "Mpc"},
        SharedSnapshot{"files/swift/swift_cosmo_0002.hdf5", 16000, "SWIFT HDF5", "Mpc"},
        SharedSnapshot{"files/derived/cosmo_arepo_layout.hdf5", 16000, "GADGET HDF5", "kpc/h"},
        SharedSnapshot{"files/derived/cosmo_split.0.hdf5", 16000, "GADGET HDF5", "kpc/h"},
        SharedSnapshot{"files/derived/cosmo_split.1.hdf5", 16000, "GADGET HDF5", "kpc/h"},
        SharedSnapshot{"scenes/cosmo_64.hdf5", 262144, "GADGET HDF5", "kpc/h"},
        SharedSnapshot{"files/phantom/adiabatic_00000.h5", 20736, "Phantom HDF5", "cm"},
        SharedSnapshot{"files/phantom/dustseparate_00000.h5", 2000, "Phantom HDF5", "au"},
        SharedSnapshot{"files/phantom/mhd_00000.h5", 4843, "Phantom HDF5", "1e+16 cm"}));

TEST(SharedFiles, OfOtherLayoutsAndDamagedOnesAreRefused) {
  for (const auto& [name, message] :
       {std::pair{"files/openpmd/astra_particles.h5", "openPMD"},
        std::pair{"files/openpmd/bmad_particles.h5", "openPMD"},
        std::pair{"files/openpmd/example-femm-thetaMode.h5", "openPMD"},
        std::pair{"bad/made/hdf5_cut.hdf5", "damaged or cut short"}}) {
    const auto path = shared_file(name);
    if (!path) GTEST_SKIP() << name << " is not here";
    EXPECT_THAT(error_of_reading(*path), HasSubstr(message)) << name;
  }
}

}  // namespace
}  // namespace motes
