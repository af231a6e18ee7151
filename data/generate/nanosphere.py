#!/usr/bin/python3
"""Hollow amorphous nanosphere or nanobowl with an exact number of atoms, carved from a periodic glass block.

  python3 nanosphere.py carbon_glass.data ns_90k.xyz  --atoms 92000  --hollow 0.55   # carbon, 1 species
  python3 nanosphere.py carbon_glass.data ns_740k.h5  --atoms 742000 --hollow 0.55
  python3 nanosphere.py sio2_glass.data   bowl.xyz    --atoms 21000  --hollow 0.70 --bowl --names Si,O
"""
import argparse
import numpy as np
import pio

ap = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
ap.add_argument("block")
ap.add_argument("out")
ap.add_argument("--atoms", type=int, default=92000)
ap.add_argument("--hollow", type=float, default=0.55, help="inner radius / outer radius")
ap.add_argument("--bowl", action="store_true", help="keep the half with z < 0.25 R")
ap.add_argument("--names", default="C")
ap.add_argument("--jitter", type=float, default=0.05)
ap.add_argument("--seed", type=int, default=3)
o = ap.parse_args()
rng = np.random.default_rng(o.seed)
pos, typ, lo, hi = pio.read_lammps_data(o.block)
cell = hi - lo
density = len(pos) / cell.prod()
frac = 1 - o.hollow**3
if o.bowl:                                                   # volume fraction of a sphere below z = 0.25 R, about
    frac *= 0.5 + 0.75 * (0.25 - 0.25**3 / 3)
R = (o.atoms / density / frac * 3 / (4 * np.pi))**(1 / 3) * 1.02


def inside(p):
    r = np.linalg.norm(p, axis=1)
    return (r < R) & (r > o.hollow * R) & ((p[:, 2] < 0.25 * R) | (not o.bowl))


p, t = pio.tile_carve(pos, typ, lo, cell, inside, R, rng, o.jitter)
keep = np.sort(np.argsort(np.linalg.norm(p, axis=1), kind="stable")[:o.atoms])   # drop the outermost few
p, t = p[keep], t[keep]
origin = p.min(0) - 5
pio.write(o.out, p, t, o.names.split(","), p.max(0) + 5 - origin, origin, (False,) * 3,
          comment="nanosphere of %d atoms" % len(p))
print(len(p), "atoms, outer radius %.1f A" % np.linalg.norm(p, axis=1).max())
