#!/bin/sh
# Remakes the files of data/density, before xz, in ./work. Needs Quantum ESPRESSO 6.7, CP2K 2023.1 and
# Python 3; set ESPRESSO_PSEUDO and CP2K_DATA_DIR to the data folders of the two programs.
# About five minutes on two cores.
set -e
here=$(cd "$(dirname "$0")" && pwd)
mkdir -p work
cd work
cp "$here"/*.in "$here"/caffeine.* .
export OMP_NUM_THREADS=1
for name in silicon quartz iron; do
  mpirun -np 2 pw.x -in ${name}_scf.in > ${name}_scf.out
  pp.x -in ${name}_pp.in > ${name}_pp.out
done
pp.x -in iron_spin_pp.in > iron_spin_pp.out
mpirun -np 2 cp2k.psmp -i caffeine.inp -o caffeine.out

homo=caffeine-WFN_00037_1-1_0.cube
lumo=caffeine-WFN_00038_1-1_0.cube
density() { python3 "$here/density.py" "$@"; }
density angstrom silicon_density.cube silicon_angstrom.cube
density chgcar quartz_density.cube CHGCAR_quartz
density chgcar iron_density.cube CHGCAR_iron iron_spin.cube
density pack iron_spin.cube iron_spin.cube.gz
density pack caffeine-ELECTRON_DENSITY-1_0.cube caffeine_density.cube.gz
density pack $homo caffeine_homo.cube.gz
density orbitals 2 caffeine_orbitals.cube.gz 37=$homo 38=$lumo
density check *.cube caffeine_*.gz iron_spin.cube.gz CHGCAR_*
