"""Reads a LAMMPS dump with ASE and prints the seconds that it took: python3 read_ase.py FILE"""
import sys
import time

import ase.io

start = time.perf_counter()
atoms = ase.io.read(sys.argv[1], format="lammps-dump-text")
print(time.perf_counter() - start, len(atoms))
