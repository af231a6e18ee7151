// Real files open with the numbers of particles and frames that their descriptions give: those that
// the repository brings with it (data/README.md), and others that may lie beside the checkout.
#include <gtest/gtest.h>

#include <cctype>
#include <filesystem>
#include <ostream>
#include <string>

#include "io/reader.h"
#include "support/shared_data.h"

namespace motes {
namespace {

struct KnownFile {
  const char* path;
  const char* format;
  std::size_t num_particles;  ///< in the first frame
  std::size_t num_frames;
  std::size_t num_at_last = num_particles;  ///< in the last frame
};

void PrintTo(const KnownFile& file, std::ostream* out) { *out << file.path; }

/// Of a file's test: its path.
std::string name_of(const testing::TestParamInfo<KnownFile>& test) {
  std::string name;
  for (const char c : std::string(test.param.path)) {
    name += std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '_';
  }
  return name;
}

/// Reads all frames of `file`, which lies at `path`.
void expect_known(const std::filesystem::path& path, const KnownFile& file) {
  Warnings warnings;
  ReadOptions options;
  options.warnings = &warnings;
  const auto trajectory = open_trajectory(path, options);
  EXPECT_EQ(trajectory->format(), file.format);
  const ParticleSet first = trajectory->read_frame(0);
  EXPECT_EQ(first.size(), file.num_particles);
  ASSERT_EQ(trajectory->num_frames(), file.num_frames);
  for (std::size_t frame = 1; frame < file.num_frames; ++frame) {
    const ParticleSet particles = trajectory->read_frame(frame);
    // Where the last frame has as many as the first, so have those between.
    if (frame + 1 == file.num_frames || file.num_at_last == file.num_particles) {
      EXPECT_EQ(particles.size(), file.num_at_last) << "frame " << frame;
    }
    EXPECT_FALSE(particles.bounds().empty());
    EXPECT_EQ(particles.species.empty(), first.species.empty());
  }
}

class BundledFiles : public testing::TestWithParam<KnownFile> {};

TEST_P(BundledFiles, OpenWithAllParticlesAndFrames) {
  expect_known(std::filesystem::path(MOTES_SOURCE_DIR) / "data" / GetParam().path, GetParam());
}

INSTANTIATE_TEST_SUITE_P(
    Data, BundledFiles,
    testing::Values(KnownFile{"density/CHGCAR_iron.xz", "VASP", 2, 1},
                    KnownFile{"density/caffeine_orbitals.cube.xz", "cube", 24, 1},
                    KnownFile{"density/quartz_density.cube.xz", "cube", 9, 1},
                    KnownFile{"density/silicon_angstrom.cube.xz", "cube", 2, 1},
                    KnownFile{"formats/charge.data", "LAMMPS data", 38, 1},
                    KnownFile{"formats/ortho_lost_atoms.dump.gz", "LAMMPS dump", 147, 5, 38},
                    KnownFile{"formats/swift_cosmo_0002.hdf5", "SWIFT HDF5", 16000, 1},
                    KnownFile{"formats/tri_frame_00000.dump", "LAMMPS dump", 864, 1},
                    KnownFile{"demo/cosmo_64.hdf5", "GADGET HDF5", 262144, 1},
                    KnownFile{"demo/nanobowl_sio2_21k.xyz.gz", "XYZ", 21000, 1},
                    KnownFile{"demo/nanosphere_c_92k.lammpstrj.xz", "LAMMPS dump", 92000, 1},
                    KnownFile{"demo/silica_pull.lammpstrj.xz", "LAMMPS dump", 18075, 10},
                    KnownFile{"demo/zeolite_mfi_3494.xyz", "XYZ", 3494, 1}),
    name_of);

class SharedTextFiles : public testing::TestWithParam<KnownFile> {};

TEST_P(SharedTextFiles, OpenWithAllParticlesAndFrames) {
  const auto path = shared_file(GetParam().path);
  if (!path) GTEST_SKIP() << "no " << GetParam().path << " beside the checkout";
  expect_known(*path, GetParam());
}

INSTANTIATE_TEST_SUITE_P(
    Shared, SharedTextFiles,
    testing::Values(
        KnownFile{"files/lammps_dump/CuZr_metallic_glass.dump.gz", "LAMMPS dump", 108000, 1},
        KnownFile{"files/lammps_dump/NanocrystallinePd.dump.gz", "LAMMPS dump", 218901, 1},
        KnownFile{"files/lammps_dump/albite_triclinic.dump", "LAMMPS dump", 17, 1},
        KnownFile{"files/lammps_dump/chain_dump_1.lammpstrj", "LAMMPS dump", 22, 6},
        KnownFile{"files/lammps_dump/crlf_wat.lammpstrj", "LAMMPS dump", 24, 3},
        KnownFile{"files/lammps_dump/detect_best_pos_repr.lammpstrj", "LAMMPS dump", 854, 5, 856},
        KnownFile{"files/lammps_dump/nacl.lammpstrj", "LAMMPS dump", 512, 6},
        KnownFile{"files/lammps_dump/ovito_simulation.dump", "LAMMPS dump", 7071, 1},
        KnownFile{"files/lammps_dump/properties.lammpstrj", "LAMMPS dump", 4000, 4},
        KnownFile{"files/lammps_dump/spce_all_coords.lammpstrj.bz2", "LAMMPS dump", 4500, 11},
        KnownFile{"files/lammps_generated/ortho_lost_atoms.dump.gz", "LAMMPS dump", 147, 5, 38},
        KnownFile{"files/lammps_generated/tri_atom_scaled.dump", "LAMMPS dump", 864, 5},
        KnownFile{"files/lammps_generated/tri_atom_unscaled_image.dump", "LAMMPS dump", 864, 5},
        KnownFile{"files/lammps_generated/tri_cols_reordered.dump", "LAMMPS dump", 864, 5},
        KnownFile{"files/lammps_generated/tri_no_id.dump", "LAMMPS dump", 864, 5},
        KnownFile{"files/lammps_generated/tri_units_time.dump", "LAMMPS dump", 864, 5},
        KnownFile{"files/lammps_generated/tri.data", "LAMMPS data", 864, 1},
        KnownFile{"files/lammps_generated/charge.data", "LAMMPS data", 38, 1},
        KnownFile{"files/lammps_data/additional_columns.data", "LAMMPS data", 10, 1},
        KnownFile{"files/lammps_data/albite_triclinic.data", "LAMMPS data", 17, 1},
        KnownFile{"files/lammps_data/data.body", "LAMMPS data", 100, 1},
        KnownFile{"files/lammps_data/deletedatoms.data", "LAMMPS data", 10, 1},
        KnownFile{"files/lammps_data/ifabp_apo_100mM.data.bz2", "LAMMPS data", 12421, 1},
        KnownFile{"files/lammps_data/image_vf.data", "LAMMPS data", 7, 1},
        KnownFile{"files/lammps_data/molid.lmp", "LAMMPS data", 12, 1},
        KnownFile{"files/lammps_data/solvated.lmp", "LAMMPS data", 7772, 1},
        KnownFile{"files/lammps_data/triclinic-2.lmp", "LAMMPS data", 0, 1},
        KnownFile{"files/lammps_data/whitespaces.lmp", "LAMMPS data", 1, 1},
        KnownFile{"files/xyz/2r9r-1b.xyz.bz2", "XYZ", 1284, 10},
        KnownFile{"files/xyz/extended.xyz", "XYZ", 192, 3, 8},
        KnownFile{"files/xyz/methane.xyz", "XYZ", 5, 1},
        KnownFile{"files/xyz/mini.xyz", "XYZ", 3, 1},
        KnownFile{"files/xyz/trajectory.xyz", "XYZ", 9, 2},
        KnownFile{"files/xyz/water.6.xyz.gz", "XYZ", 297, 100},
        KnownFile{"files/xyz/water.multistream.7.xyz.gz", "XYZ", 297, 100},
        KnownFile{"files/xyz/water.xyz.xz", "XYZ", 297, 100},
        KnownFile{"files/lammps_generated/tri_traj.xyz", "XYZ", 864, 5},
        KnownFile{"files/gro/1vln-triclinic.gro", "GRO", 14520, 1},
        KnownFile{"files/gro/YiiP_lipids.gro.gz", "GRO", 43480, 1},
        KnownFile{"files/gro/bigbox.gro.bz2", "GRO", 132303, 1},
        KnownFile{"files/gro/cod_4020641.gro", "GRO", 81, 1},
        KnownFile{"files/gro/lysozyme.gro", "GRO", 1960, 3},
        KnownFile{"files/gro/martini_dppc_chol_bilayer.gro", "GRO", 5040, 1},
        KnownFile{"files/gro/residwrap.gro", "GRO", 126, 1},
        KnownFile{"files/gro/sample_velocity_file.gro", "GRO", 6, 1},
        KnownFile{"files/gro/two_water_gro_multiframe.gro", "GRO", 6, 2},
        KnownFile{"files/gro/two_water_gro_widebox.gro", "GRO", 6, 1},
        KnownFile{"files/pdb/1npc.pdb.gz", "PDB", 2699, 1},
        KnownFile{"files/pdb/1vln-triclinic.pdb", "PDB", 14520, 1},
        KnownFile{"files/pdb/4hhb.pdb", "PDB", 4779, 1},
        KnownFile{"files/pdb/5digitResid.pdb", "PDB", 5, 1},
        KnownFile{"files/pdb/MOF-5.pdb", "PDB", 65, 1},
        KnownFile{"files/pdb/chainIDnewres.pdb.gz", "PDB", 22, 1},
        KnownFile{"files/pdb/charges.pdb", "PDB", 36, 1},
        KnownFile{"files/pdb/crystal-maker.pdb", "PDB", 8, 1},
        KnownFile{"files/pdb/elements.pdb", "PDB", 28, 1},
        KnownFile{"files/pdb/fullerene.pdb.gz", "PDB", 60, 1},
        KnownFile{"files/pdb/hemo.pdb", "PDB", 522, 1},
        KnownFile{"files/pdb/namd_cgenff.pdb", "PDB", 130, 1},
        KnownFile{"files/pdb/nmr_neopetrosiamide.pdb", "PDB", 392, 24},
        KnownFile{"files/pdb/psfgen-output.pdb", "PDB", 26, 1},
        KnownFile{"files/pdb/start_128popc.pdb", "PDB", 28526, 1},
        KnownFile{"files/pdb/tz2_2.pdb.gz", "PDB", 5293, 1},
        KnownFile{"files/pdb/xl_serial.pdb", "PDB", 4, 1},
        KnownFile{"files/traj/RANDOM_WALK_TOPO.pdb", "PDB", 100, 1},
        KnownFile{"files/traj/test_topology.pdb", "PDB", 5, 1},
        KnownFile{"files/poscar/BN.selective.dynamics.poscar", "VASP", 2, 1},
        KnownFile{"files/poscar/Cr.velocity.poscar", "VASP", 2, 1},
        KnownFile{"files/poscar/MnO.cartesian.poscar", "VASP", 24, 1},
        KnownFile{"files/mmcif/1544173.cif", "CIF", 100, 1},
        KnownFile{"files/mmcif/1ake.cif.gz", "mmCIF", 3804, 1},
        KnownFile{"files/mmcif/4hhb.cif", "mmCIF", 4779, 1},
        KnownFile{"files/mmcif/Zr-UiO-66-pressure.cif", "CIF", 456, 3},
        KnownFile{"files/zeolite_cif/FAU.cif", "CIF", 576, 1},
        KnownFile{"files/zeolite_cif/LTA.cif", "CIF", 72, 1},
        KnownFile{"files/zeolite_cif/MFI.cif", "CIF", 288, 1}),
    name_of);

}  // namespace
}  // namespace motes
