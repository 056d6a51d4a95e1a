#!/usr/bin/env python3
"""Writes R23_fractional_delay.csv: where a haptic loop begins to swing when its answer is late by a part of a period.

A device of mass 1 and viscosity beta, sampled with period 1 at n; the wall f[n] = -k x[n] - z (x[n] - x[n-1]) acts from n + d
to n + 1 + d. Python's standard library alone.

stable   device alone: the augmented state (x, v, past positions, the force in use), moved over the two parts of a period by
         exponentials of its matrix (Taylor series, scaled and squared); spectral radius by repeated squaring; bisected over k.
passive  every passive hand: at each frequency w the hand may make 1 / (impedance of hand and device) anything in the disc over
         [0, 1 / beta], apart at each alias w + 2 pi j of the held force. The sum of these discs, taken alias by alias, must
         not reach the critical point; bisected over k.
"""
import cmath
import math
import os

BETAS = (0.003, 0.01, 0.02, 0.1, 0.3)
DELAYS = (0.05, 0.12, 0.25, 0.33, 0.5, 0.75, 0.9, 1.25, 1.5, 2.6)


def times(a, b):
    columns = list(zip(*b))
    return [[sum(x * y for x, y in zip(row, column)) for column in columns] for row in a]


def exponential(a, time):
    size = len(a)
    halvings = 12
    scaled = [[time * x / 2 ** halvings for x in row] for row in a]
    term = [[float(i == j) for j in range(size)] for i in range(size)]
    total = [row[:] for row in term]
    for order in range(1, 12):
        term = [[x / order for x in row] for row in times(term, scaled)]
        total = [[x + y for x, y in zip(p, q)] for p, q in zip(total, term)]
    for _ in range(halvings):
        total = times(total, total)
    return total


def log_radius(a):
    """Natural logarithm of the spectral radius."""
    total, weight = 0.0, 1.0
    for _ in range(44):
        norm = max(sum(abs(x) for x in row) for row in a)
        total += weight * math.log(norm)
        weight *= 0.5
        a = [[x / norm for x in row] for row in a]
        a = times(a, a)
    return total


def unit(rows, columns):
    return [[float(i == j) for j in range(columns)] for i in range(rows)]


def period_matrix(beta, z, k, d):
    """Moves (x, v, force in use, x[n-1], ..., x[n-1-whole]) from one tick to the next."""
    whole = math.floor(d)
    part = d - whole
    size = 4 + whole
    motion = [[0.0, 1.0, 0.0], [0.0, -beta, 1.0], [0.0, 0.0, 0.0]]

    def moved(time):
        matrix = unit(size + 1, size + 1)
        for i, row in enumerate(exponential(motion, time)):
            matrix[i][:3] = row
        return matrix

    sampled = unit(3, size)  # x[n] joins the samples: x[n], x[n-1], ..., x[n-1-whole]
    sampled.append([1.0] + [0.0] * (size - 1))
    sampled += unit(size, size)[3:]
    answered = unit(size + 1, size + 1)
    answered[2] = [0.0] * (size + 1)
    answered[2][3 + whole] = -(k + z)
    answered[2][4 + whole] = z
    total = sampled
    for matrix in (moved(part), answered, moved(1.0 - part), unit(size, size + 1)):
        total = times(matrix, total)
    return total


def bisect(is_fine, low, high):
    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if is_fine(middle) else (low, middle)
    return low


def stable(beta, z, d):
    def is_fine(k):
        return log_radius(period_matrix(beta, z, k, d)) < 1e-13

    before, k = 0.0, 1e-5
    if not is_fine(k):
        return 0.0
    while is_fine(k):
        before, k = k, 1.06 * k
    return bisect(is_fine, before, k)


ALIASES = 3000
FREQUENCIES = [math.pi * i / 240 for i in range(1, 241)] + [1e-3, 3e-3]


def alias_sums(d):
    """For every frequency: sums over the aliases of e^(-i w d) / w^2 and of 1 / w^2."""
    sums = []
    for w in FREQUENCIES:
        late, plain = 0j, 0.0
        for j in range(-ALIASES, ALIASES + 1):
            at = w + 2.0 * math.pi * j
            late += cmath.exp(-1j * at * d) / at ** 2
            plain += 1.0 / at ** 2
        rest = 2.0 / (2.0 * math.pi) ** 2 / (ALIASES + 0.5)  # of the aliases beyond
        plain += rest
        if d == math.floor(d):
            late += rest * cmath.exp(-1j * w * d)
        sums.append((w, late, plain))
    return sums


def passive(beta, z, sums):
    def is_fine(k):
        for w, late, plain in sums:
            turn = 1.0 - cmath.exp(-1j * w)
            gain = (k + z * turn) * turn
            # -gain * (sum over aliases of e^(-iwd) / w^2 D_j), D_j in the disc of centre 1/2b and radius 1/2b
            centre, radius = -gain * late / (2.0 * beta), abs(gain) * plain / (2.0 * beta)
            if abs(1.0 + centre) <= radius:
                return False
        return True

    return bisect(is_fine, 0.0, 50.0) if is_fine(1e-9) else 0.0


def main():
    here = os.path.dirname(os.path.abspath(__file__))
    with open(os.path.join(here, "R23_fractional_delay.csv"), "w", encoding="ascii") as file:
        file.write("beta_bT_over_m,z_BT_over_m,d_delay_steps,Kmax_T2_over_m_stability,Kmax_T2_over_m_passivity\n")
        for d in DELAYS:
            sums = alias_sums(d)
            for beta in BETAS:
                for z in (0.0, 0.5 * beta, 0.05, 0.2):
                    file.write("%.4g,%.4g,%.4g,%.9e,%.9e\n" % (beta, z, d, stable(beta, z, d), passive(beta, z, sums)))


if __name__ == "__main__":
    main()
