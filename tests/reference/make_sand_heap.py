#!/usr/bin/env python3
"""Writes R24_lammps_sand_heap.json: columns of balls that do not turn, let go on a floor, moved by LAMMPS.

Run with `lmp` in PATH (Debian: apt-get install lammps): python3 make_sand_heap.py. Takes a few minutes.

Each column stands in a plane: COLUMNS x ROWS balls of one mass, in a square lattice with places and radii that a
generator of whole numbers draws, so that every program can draw the same ones. Contacts are springs and dampers
with Cundall and Strack's friction, pair_style gran/hooke/history; fix nve leaves the rotation where it began: at 0.
"""
import json
import math
import os
import subprocess
import tempfile

COLUMNS, ROWS = 16, 25
MASS = 1e-3  # kg
RADIUS = 5e-3  # m, the mean
SPREAD = 0.2  # of the radius, either way
STIFFNESS, TANGENTIAL = 2000.0, 1000.0  # N/m
VISCOSITY, TANGENTIAL_VISCOSITY = 0.4, 0.2  # N s/m, of every contact
STEP, STEPS = 1e-4, 30000  # s; half of it takes 0.6 degrees off the steepest heap
MUS = ("0.2", "0.3", "0.5", "0.8")
SEEDS = (1, 2, 3, 4, 5, 6)


def draws(seed):
    """Numbers in [0, 1): x -> 1664525 x + 1013904223 mod 2^32."""
    state = seed
    while True:
        state = (1664525 * state + 1013904223) % 2**32
        yield state / 2**32


def column(seed):
    """x, y, radius of each ball [m]."""
    draw = draws(seed)
    pitch = 2.0 * RADIUS * (1.0 + SPREAD)
    balls = []
    for row in range(ROWS):
        for i in range(COLUMNS):
            radius = RADIUS * (1.0 + SPREAD * (2.0 * next(draw) - 1.0))
            play = 0.5 * pitch - radius
            x = pitch * (i - 0.5 * (COLUMNS - 1) + 0.25 * (-1) ** row) + play * (2.0 * next(draw) - 1.0)
            y = pitch * (row + 0.5) + play * (2.0 * next(draw) - 1.0)
            balls.append((x, y, radius))
    return balls


def shape(balls):
    """Height of the centre of mass, mean distance from it along the floor [m], and their angle [deg]: that of repose of a
    triangle as high and as wide. It varies by a third of what a line through the surface does."""
    middle = sum(x for x, y in balls) / len(balls)
    height = sum(y for x, y in balls) / len(balls)
    width = sum(abs(x - middle) for x, y in balls) / len(balls)
    return height, width, math.degrees(math.atan2(height, width))


INPUT = """units si
dimension 2
atom_style sphere
boundary f f p
newton off
comm_modify vel yes
read_data data.heap
neighbor 0.002 bin
neigh_modify delay 0
pair_style gran/hooke/history {k} {kt} {g} {gt} {mu} 1{limit}
pair_coeff * *
fix floor all wall/gran hooke/history {k} {kt} {gw} {gtw} {mu} 1{limit} yplane 0.0 NULL
fix weight all gravity 9.81 vector 0 -1 0
fix move all nve
fix plane all enforce2d
timestep {dt}
thermo 20000
thermo_style custom step ke
thermo_modify norm no
dump d all custom {n} dump.heap id x y vx vy
dump_modify d sort id format float %.15g
run {n}
"""


def run(mu, seed, limit=" limit_damping"):
    folder = tempfile.mkdtemp()
    balls = column(seed)
    with open(folder + "/data.heap", "w") as out:
        out.write("heap\n\n%d atoms\n1 atom types\n\n-10 10 xlo xhi\n-1 10 ylo yhi\n-0.05 0.05 zlo zhi\n\nAtoms\n\n" % len(balls))
        for i, (x, y, radius) in enumerate(balls):
            density = MASS / (4.0 / 3.0 * math.pi * radius**3)
            out.write("%d 1 %.17g %.17g %.17g %.17g 0\n" % (i + 1, 2.0 * radius, density, x, y))
    # LAMMPS counts dampers by the mass m m / (m + m) of a pair, and by m at a wall.
    values = dict(k=STIFFNESS, kt=TANGENTIAL, g=VISCOSITY / (0.5 * MASS), gt=TANGENTIAL_VISCOSITY / (0.5 * MASS),
                  gw=VISCOSITY / MASS, gtw=TANGENTIAL_VISCOSITY / MASS, mu=mu, dt=STEP, n=STEPS, limit=limit)
    with open(folder + "/in.heap", "w") as out:
        out.write(INPUT.format(**values))
    done = subprocess.run(["lmp", "-in", "in.heap", "-log", "log.heap"], cwd=folder, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout[-2000:] + done.stderr
    last = open(folder + "/dump.heap").read().split("ITEM: TIMESTEP\n")[-1].splitlines()
    rows = [[float(word) for word in line.split()] for line in last[8:]]
    fastest = max(math.hypot(row[3], row[4]) for row in rows)
    return done.stdout.splitlines()[0], shape([(row[1], row[2]) for row in rows]), fastest


def main():
    heaps = []
    version = ""
    for mu in MUS:
        for seed in SEEDS:
            version, (height, width, angle), fastest = run(mu, seed)
            heaps.append({"mu": mu, "seed": seed, "height_m": "%.6g" % height, "width_m": "%.6g" % width,
                          "angle_deg": "%.4f" % angle, "fastest_m_per_s": "%.2g" % fastest})
            print(heaps[-1], flush=True)
    result = {
        "id": "R24_lammps_sand_heap", "kind": "cross-check", "source": "computed by " + version + ", make_sand_heap.py",
        "model": "a column of balls in a plane, let go on a floor; Hooke contacts with viscosity, Coulomb friction with memory, rotation blocked",
        "columns": COLUMNS, "rows": ROWS, "mass_kg": MASS, "radius_m": RADIUS, "spread": SPREAD, "stiffness_n_per_m": STIFFNESS,
        "tangential_stiffness_n_per_m": TANGENTIAL, "viscosity_n_s_per_m": VISCOSITY,
        "tangential_viscosity_n_s_per_m": TANGENTIAL_VISCOSITY, "time_s": STEP * STEPS, "heaps": heaps,
        "tolerance": "the mean angle of all seeds to 2 degrees: each heap comes to rest by chance",
    }
    with open(os.path.join(os.path.dirname(os.path.abspath(__file__)), "R24_lammps_sand_heap.json"), "w") as out:
        json.dump(result, out, indent=1)
        out.write("\n")


if __name__ == "__main__":
    main()
