#!/usr/bin/python3
"""A LAMMPS data file of a periodic block as a small extended XYZ file: 0.001 A, atoms wrapped into the cell.

  python3 seed_block.py sio2_glass.data ../bench/sio2_glass.xyz.xz Si,O
"""
import lzma
import sys
import pio

pos, typ, lo, hi = pio.read_lammps_data(sys.argv[1])
names = sys.argv[3].split(",")
cell = hi - lo
lines = ["%d" % len(pos),
         'Lattice="%.6f 0 0 0 %.6f 0 0 0 %.6f" Properties=species:S:1:pos:R:3 pbc="T T T"' % tuple(cell)]
lines += ["%s %.3f %.3f %.3f" % (names[t], *p) for t, p in zip(typ, (pos - lo) % cell)]
with lzma.open(sys.argv[2], "wt", preset=9 | lzma.PRESET_EXTREME) as f:
    f.write("\n".join(lines) + "\n")
