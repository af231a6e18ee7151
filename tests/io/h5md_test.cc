// H5MD: elements fixed or per frame, units, species.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "io/reader.h"
#include "support/compress.h"
#include "support/hdf5_writer.h"
#include "support/shared_data.h"
#include "support/truncation.h"

namespace motes {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

/// Two frames of two particles in nanometres, with a fixed box.
void write_trajectory(Hdf5Writer& file) {
  file.group("h5md");
  const std::string all = "particles/all";
  file.dataset(all + "/position/value", {2, 2, 3}, {0, 0, 0, 1, 1, 1, 0, 0, 0, 2, 2, 2});
  file.dataset(all + "/position/step", {2}, {0, 10}, H5T_STD_I32LE);
  file.dataset(all + "/position/time", {2}, {0, 0.5});
  file.text_attribute(all + "/position/value", "unit", "nm");
  file.dataset(all + "/box/edges", {3}, {3, 4, 5});
}

ParticleSet read(const std::filesystem::path& path, std::size_t frame,
                 const ReadOptions& options = {}) {
  return open_trajectory(path, options)->read_frame(frame);
}

TEST(H5md, ConvertsABoxByItsOwnUnit) {
  const TemporaryFile file("a.h5md");
  {
    Hdf5Writer writer(file.path());
    write_trajectory(writer);
    writer.text_attribute("particles/all/box/edges", "unit", "Angstrom");
  }
  EXPECT_EQ(read(file.path(), 0).cell->vectors[1], Vector3d(0, 4, 0));
}

TEST(H5md, ReadsFramesInAngstrom) {
  const TemporaryFile file("a.h5md");
  {
    Hdf5Writer writer(file.path());
    write_trajectory(writer);
    writer.dataset("particles/all/charge", {2}, {1, -1});
  }
  EXPECT_EQ(open_trajectory(file.path(), {})->num_frames(), 2u);
  const ParticleSet particles = read(file.path(), 1);
  EXPECT_EQ(particles.position(1), Point3d(20, 20, 20));
  EXPECT_EQ(particles.length_unit, "angstrom");
  EXPECT_EQ(particles.time, 0.5);
  ASSERT_TRUE(particles.cell.has_value());
  EXPECT_EQ(particles.cell->vectors[1], Vector3d(0, 40, 0));
  EXPECT_TRUE(particles.species.empty());
  EXPECT_THAT(particles.find_property("charge")->values, ElementsAre(1, -1));
  EXPECT_THROW(read(file.path(), 2), Error);
}

TEST(H5md, ConvertsVelocitiesAsPositionsOrByTheLengthInTheirUnit) {
  const TemporaryFile file("a.h5md");
  const auto velocity = [&](const std::string& position_unit, const std::string& unit) {
    {
      Hdf5Writer writer(file.path());
      writer.group("h5md");
      writer.dataset("particles/all/position", {1, 3}, {1, 2, 3});
      writer.dataset("particles/all/velocity", {1, 3}, {4, 5, 6});
      if (!position_unit.empty()) {
        writer.text_attribute("particles/all/position", "unit", position_unit);
      }
      if (!unit.empty()) writer.text_attribute("particles/all/velocity", "unit", unit);
    }
    return read(file.path(), 0).find_property("vy")->values.at(0);
  };
  EXPECT_EQ(velocity("nm", ""), 50);
  EXPECT_EQ(velocity("nm", "nm ps-1"), 50);
  EXPECT_EQ(velocity("nm", "ps-1 nm+1"), 50);
  EXPECT_EQ(velocity("nm", "Angstrom/fs"), 5);
  EXPECT_EQ(velocity("nm", "m s-1"), 5);
  EXPECT_EQ(velocity("Angstrom", "nm/ps"), 50);
  EXPECT_EQ(velocity("", ""), 5);
  EXPECT_EQ(velocity("sigma", "nm ps-1"), 5);
}

TEST(H5md, LeavesOutIntegersThatWouldLoseDigits) {
  const TemporaryFile file("a.h5md");
  {
    Hdf5Writer writer(file.path());
    write_trajectory(writer);
    writer.dataset("particles/all/molecule", {2}, {16777215, -16777215}, H5T_STD_I64LE);
    writer.dataset("particles/all/parent", {2}, {1, 16777217}, H5T_STD_I64LE);
    writer.dataset("particles/all/energy", {2}, {1, 16777217});
  }
  Warnings warnings;
  ReadOptions options;
  options.warnings = &warnings;
  const ParticleSet particles = read(file.path(), 0, options);
  EXPECT_THAT(particles.find_property("molecule")->values, ElementsAre(16777215, -16777215));
  EXPECT_EQ(particles.find_property("parent"), nullptr);
  EXPECT_NE(particles.find_property("energy"), nullptr);
  EXPECT_THAT(warnings.lines(), ElementsAre("left out as integers beyond single precision: "
                                            "particles/all/parent"));
}

TEST(H5md, NamesSpeciesByElementOrByLabel) {
  const TemporaryFile file("a.h5md");
  {
    Hdf5Writer writer(file.path());
    write_trajectory(writer);
    writer.dataset("particles/all/species", {2}, {14, 8}, H5T_IEEE_F64LE);
  }
  EXPECT_THAT(read(file.path(), 0).species_names, ElementsAre("O", "Si"));
  {
    Hdf5Writer writer(file.path());
    write_trajectory(writer);
    writer.dataset("particles/all/species", {2}, {2, 1}, H5T_STD_I32LE);
  }
  EXPECT_THAT(read(file.path(), 0).species_names, ElementsAre("1", "2"));
  ReadOptions options;
  options.types = {{1, "Si"}, {2, "O"}};
  const ParticleSet named = read(file.path(), 0, options);
  EXPECT_EQ(named.species_names[named.species[0]], "O");
}

TEST(H5md, WarnsOfNamesForTypesThatAreNotThere) {
  const TemporaryFile file("a.h5md");
  const auto warnings_of = [&](const std::map<int, std::string>& types) {
    Warnings warnings;
    ReadOptions options;
    options.warnings = &warnings;
    options.types = types;
    read(file.path(), 0, options);
    return warnings.lines();
  };
  {
    Hdf5Writer writer(file.path());
    write_trajectory(writer);
  }
  EXPECT_THAT(warnings_of({}), ElementsAre());
  EXPECT_THAT(warnings_of({{1, "Si"}}),
              ElementsAre(HasSubstr("has no type 1 to be named Si; there are: none")));
  {
    Hdf5Writer writer(file.path());
    write_trajectory(writer);
    writer.dataset("particles/all/species", {2}, {11, 1}, H5T_STD_I32LE);
    writer.dataset("particles/wall/position/value", {2, 1, 3}, {7, 7, 7, 8, 8, 8});
    writer.dataset("particles/wall/species", {1}, {2}, H5T_STD_I32LE);
  }
  EXPECT_THAT(warnings_of({{1, "Si"}, {2, "O"}, {11, "H"}}), ElementsAre());
  EXPECT_THAT(warnings_of({{1, "Si"}, {2, "O"}}),
              ElementsAre("numbers of species are taken for atomic numbers"));
  EXPECT_THAT(warnings_of({{1, "Si"}, {2, "O"}, {3, "N"}, {11, "H"}}),
              ElementsAre(HasSubstr("a.h5md: has no type 3 to be named N; there are: 1, 2, 11")));
}

TEST(H5md, FindsElementsStoredAtOtherStepsByTheirStep) {
  const TemporaryFile file("a.h5md");
  {
    Hdf5Writer writer(file.path());
    write_trajectory(writer);
    writer.dataset("particles/all/mass/value", {1, 2}, {3, 4});
    writer.dataset("particles/all/mass/step", {1}, {10}, H5T_STD_I32LE);
  }
  EXPECT_EQ(read(file.path(), 0).find_property("mass"), nullptr);
  EXPECT_THAT(read(file.path(), 1).find_property("mass")->values, ElementsAre(3, 4));
}

TEST(H5md, JoinsGroupsAndRemovesPadding) {
  const TemporaryFile file("a.h5md");
  {
    Hdf5Writer writer(file.path());
    write_trajectory(writer);
    writer.dataset("particles/wall/position/value", {2, 1, 3}, {7, 7, 7, 8, 8, 8});
    writer.dataset("particles/all/id", {2}, {5, -1}, H5T_STD_I64LE);
    writer.dataset("particles/wall/id", {1}, {6}, H5T_STD_I64LE);
  }
  const ParticleSet particles = read(file.path(), 0);
  EXPECT_THAT(particles.ids, ElementsAre(5, 6));
  EXPECT_THAT(particles.species_names, ElementsAre("all", "wall"));
  EXPECT_THAT(particles.species, ElementsAre(0, 1));
  EXPECT_EQ(particles.position(1).x, 7);
}

TEST(H5md, RefusesWhatHasNoPositions) {
  const TemporaryFile file("a.h5md");
  { Hdf5Writer(file.path()).group("h5md"); }
  EXPECT_THAT(error_of_reading(file.path()), HasSubstr("has no positions"));
  {
    Hdf5Writer writer(file.path());
    writer.group("h5md");
    writer.dataset("particles/all/position/value", {2, 2}, {1, 2, 3, 4});
  }
  EXPECT_THAT(error_of_reading(file.path()), HasSubstr("expected frames x n x 3"));
}

TEST(H5md, ReadsCompressedFiles) {
  const TemporaryFile plain("a.h5md");
  {
    Hdf5Writer writer(plain.path());
    write_trajectory(writer);
  }
  const TemporaryFile file("a.h5md.gz", compress(file_content(plain.path()), "gzip"));
  EXPECT_EQ(read(file.path(), 1).position(1), Point3d(20, 20, 20));
}

TEST(H5md, CutShortIsAnErrorOfOneLine) {
  const TemporaryFile file("a.h5md");
  {
    Hdf5Writer writer(file.path());
    write_trajectory(writer);
  }
  expect_clear_errors_when_cut("a.h5md", file_content(file.path()));
}

TEST(H5md, ReadsSharedFiles) {
  const auto cobrotoxin = shared_file("files/h5md/cobrotoxin.h5md");
  const auto copper = shared_file("files/h5md/cu.h5md");
  if (!cobrotoxin || !copper) GTEST_SKIP() << "files/h5md is not here";
  EXPECT_EQ(open_trajectory(*cobrotoxin, {})->num_frames(), 3u);
  const ParticleSet protein = read(*cobrotoxin, 2);
  EXPECT_EQ(protein.size(), 19385u);
  EXPECT_NEAR(protein.cell->vectors[0].x, 52.763, 1);  // the file has nanometres

  EXPECT_EQ(open_trajectory(*copper, {})->num_frames(), 20u);
  const ParticleSet metal = read(*copper, 19);
  EXPECT_EQ(metal.size(), 108u);
  EXPECT_THAT(metal.species_names, ElementsAre("Cu"));
  EXPECT_NEAR(metal.cell->vectors[0].x, 10.83, 1e-6);
}

}  // namespace
}  // namespace motes
