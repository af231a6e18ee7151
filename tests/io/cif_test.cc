// mmCIF and CIF: atoms, models, symmetry, faults.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>

#include "core/error.h"
#include "io/reader.h"
#include "support/shared_data.h"
#include "support/truncation.h"

namespace motes {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

ParticleSet read(const std::string& content, std::size_t frame = 0) {
  const TemporaryFile file("a.cif", content);
  Warnings warnings;
  ReadOptions options;
  options.warnings = &warnings;
  return open_trajectory(file.path(), options)->read_frame(frame);
}

std::string error_of(const std::string& content) {
  const TemporaryFile file("a.cif", content);
  return error_of_reading(file.path());
}

std::vector<std::string> warnings_of(const std::string& content) {
  const TemporaryFile file("a.cif", content);
  Warnings warnings;
  ReadOptions options;
  options.warnings = &warnings;
  open_trajectory(file.path(), options)->read_frame(0);
  return warnings.lines();
}

const std::string cubic_cell =
    "data_test\n_cell_length_a 4\n_cell_length_b 4\n_cell_length_c 4.0(2)\n_cell_angle_alpha 90\n"
    "_cell_angle_beta 90\n_cell_angle_gamma 90\n";
const std::string sites =
    "loop_\n_atom_site_label\n_atom_site_type_symbol\n_atom_site_fract_x\n_atom_site_fract_y\n"
    "_atom_site_fract_z\n_atom_site_occupancy\n";
const std::string inversion = "loop_\n_symmetry_equiv_pos_as_xyz\n'x, y, z'\n'-x, -y, -z'\n";

TEST(Cif, ExpandsSymmetryWithoutDoublingSpecialPositions) {
  const ParticleSet particles =
      read(cubic_cell + inversion + sites + "Si1 Si4+ 0 0.5 0.00001 1\nO1 O2- 0.25(3) 0 0 0.5\n");
  ASSERT_EQ(particles.size(), 3u);
  EXPECT_THAT(particles.species_names, ElementsAre("Si", "O"));
  EXPECT_THAT(particles.species, ElementsAre(0, 1, 1));
  EXPECT_NEAR(particles.position(1).x, 1, 1e-6);
  EXPECT_NEAR(particles.position(2).x, 3, 1e-6);
  EXPECT_THAT(particles.find_property("occupancy")->values, ElementsAre(1, 0.5, 0.5));
  EXPECT_EQ(particles.cell->vectors[2].z, 4);
}

TEST(Cif, WarnsOfBlocksThatLackTheirAtoms) {
  const std::string whole = cubic_cell + inversion + sites + "C1 C 0.1 0 0 1\n";
  EXPECT_THAT(warnings_of(whole), ElementsAre());
  EXPECT_THAT(warnings_of(whole + "data_b\n" + cubic_cell.substr(10)),
              ElementsAre(HasSubstr("data_b has a cell but no atoms")));
}

TEST(MmCif, WarnsWhereTheListOfAtomsIsNotClosed) {
  const std::string whole =
      "data_X\n#\n_entry.id X\n#\nloop_\n_atom_site.id\n_atom_site.type_symbol\n"
      "_atom_site.Cartn_x\n_atom_site.Cartn_y\n_atom_site.Cartn_z\n1 C 1 2 3\n2 O 4 5 6\n#\n";
  EXPECT_THAT(warnings_of(whole), ElementsAre());
  const std::string cut = whole.substr(0, whole.size() - 2);
  EXPECT_THAT(warnings_of(cut), ElementsAre(HasSubstr("may be cut short")));
}

TEST(Cif, TakesSymmetryFromTheGroupWhereNoneIsListed) {
  const ParticleSet particles =
      read(cubic_cell + "_symmetry_space_group_name_H-M 'F m -3 m'\n" + sites + "Cu1 Cu 0 0 0 1\n");
  EXPECT_EQ(particles.size(), 4u);
}

TEST(Cif, ReadsBlocksAsFrames) {
  const std::string block = cubic_cell + inversion + sites;
  const TemporaryFile file("a.cif", block + "C1 C 0.1 0 0 1\n" + "data_global\n_audit_date 1\n" +
                                        "data_b" + block.substr(9) +
                                        "C1 C 0.2 0 0 1\nC2 C 0 0 0 1\n");
  const ReadOptions options;
  const auto trajectory = open_trajectory(file.path(), options);
  EXPECT_EQ(trajectory->num_frames(), 2u);
  EXPECT_EQ(trajectory->read_frame(0).size(), 2u);
  EXPECT_EQ(trajectory->read_frame(1).size(), 3u);
}

TEST(Mmcif, ReadsModelsAsFrames) {
  const std::string content =
      "data_x\nloop_\n_atom_site.id\n_atom_site.type_symbol\n_atom_site.label_atom_id\n"
      "_atom_site.Cartn_x\n_atom_site.Cartn_y\n_atom_site.Cartn_z\n"
      "_atom_site.pdbx_PDB_model_num\n5 ZN ZN 1 2 3 1\n6 O \"O5'\" 4 5 6 1\n5 ZN ZN 7 8 9 2\n#\n";
  const TemporaryFile file("a.cif", content);
  EXPECT_EQ(open_trajectory(file.path(), {})->num_frames(), 2u);
  EXPECT_THAT(read(content).species_names, ElementsAre("Zn", "O"));
  EXPECT_THAT(read(content).ids, ElementsAre(5, 6));
  EXPECT_EQ(read(content, 1).position(0), Point3d(7, 8, 9));
}

TEST(Mmcif, KeepsTheFirstOfAlternateLocations) {
  const ParticleSet particles = read(
      "data_x\nloop_\n_atom_site.label_atom_id\n_atom_site.type_symbol\n_atom_site.label_alt_id\n"
      "_atom_site.auth_seq_id\n_atom_site.Cartn_x\n_atom_site.Cartn_y\n_atom_site.Cartn_z\n"
      "N N . 1 0 0 0\nCA C A 1 1 0 0\nCA C B 1 2 0 0\nCA C A 2 3 0 0\nCB C B 1 4 0 0\n");
  ASSERT_EQ(particles.size(), 4u);
  EXPECT_EQ(particles.position(1).x, 1);
  EXPECT_EQ(particles.position(2).x, 3);
  EXPECT_EQ(particles.position(3).x, 4);
}

TEST(Cif, SaysWhatIsWrong) {
  EXPECT_THAT(error_of(cubic_cell + inversion + sites + "C1 C 0 0 0 1\nC2 C 0 0\n"),
              HasSubstr("a.cif:12: Wrong number of values in the loop; expected whole rows"));
  EXPECT_THAT(error_of(cubic_cell + inversion + sites + "C1 C 0 0 zero 1\n"),
              HasSubstr("site 1 has fract_z 'zero'; expected a number"));
  EXPECT_THAT(error_of("data_test\n" + inversion + sites + "C1 C 0 0 0 1\n"),
              HasSubstr("block test has no cell"));
  EXPECT_THAT(
      error_of(cubic_cell + "_symmetry_equiv_pos_as_xyz 'x,y'\n" + sites + "C1 C 0 0 0 1\n"),
      HasSubstr("has the symmetry operation"));
  EXPECT_THAT(error_of(cubic_cell), HasSubstr("has no atoms"));
  EXPECT_THAT(error_of("data_x\n_cell_length_a 1\n_cell_length_a 2\n"), HasSubstr("a.cif:"));
}

TEST(Cif, CutShortIsAnErrorOfOneLineOrCorrect) {
  std::string content = cubic_cell + inversion + sites;
  for (int i = 0; i < 60; ++i) content += "C" + std::to_string(i) + " C 0.125 0.5 0.0078125 1\n";
  expect_clear_errors_when_cut("a.cif", content);
}

TEST(SharedCifs, OfAZeoliteHaveTwoOxygensASilicon) {
  const auto path = shared_file("files/zeolite_cif/MFI.cif");
  if (!path) GTEST_SKIP() << "MFI.cif is not here";
  const ParticleSet particles = open_trajectory(*path, {})->read_frame(0);
  std::map<std::string, std::size_t> counts;
  for (const auto s : particles.species) ++counts[particles.species_names[s]];
  EXPECT_EQ(counts["Si"], 96u);
  EXPECT_EQ(counts["O"], 192u);
}

}  // namespace
}  // namespace motes
