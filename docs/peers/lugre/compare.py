"""Friction of the example `family`, by SciPy: python compare.py OURS.csv

The equations as their papers print them, in forces and deflections, by Radau with a relative
tolerance of 1e-11 between the knots of the motion and its reversals; elements of the Maxwell-slip
model change between sticking and slipping by events. Exit code 1 if a law differs by more than
its limit, three times what was measured.
"""

import csv
import itertools
import sys

import numpy as np
import scipy
from scipy.integrate import solve_ivp

KNOTS = [(0, 0), (0.05, 0.02), (0.15, 0.02), (0.2, -0.01), (0.3, -0.01), (0.35, 0), (0.4, 0), (0.45, 0.003),
         (0.55, 0.003), (0.6, -0.002), (0.7, 0.001), (0.8, 0.05), (1.0, -0.03)]
STIFFNESS = 4e6
TOLERANCE = dict(method="Radau", rtol=1e-11)


def speed(t):
    return np.interp(t, *zip(*KNOTS))


def coulomb(v):
    return 60.0 if v > 0 else 70.0


def level(v):
    coulomb_level, stiction = (60.0, 85.0) if v > 0 else (70.0, 80.0)
    return coulomb_level + (stiction - coulomb_level) * np.exp(-((abs(v) / 4e-3) ** 1.4))


def viscous(v):
    return 300.0 * v + 200.0 * v * abs(v) + 50.0 * v**3


def pieces():
    """Times between which the speed is linear and has one sign."""
    for (t0, v0), (t1, v1) in itertools.pairwise(KNOTS):
        crossing = [t0 + (t1 - t0) * v0 / (v0 - v1)] if v0 * v1 < 0 else []
        yield from itertools.pairwise([t0, *crossing, t1])


def lugre(z, v):
    return v - STIFFNESS * abs(v) * z / level(v)


def dahl(z, v):
    left = 1 - STIFFNESS * z * np.sign(v) / level(v)
    return v * abs(left) ** 1.5 * np.sign(left)


def elasto_plastic(z, v):
    greatest, elastic = level(v) / STIFFNESS, 0.5 * coulomb(v) / STIFFNESS
    if z * v <= 0 or abs(z) <= elastic:
        alpha = 0.0
    elif abs(z) >= greatest:
        alpha = 1.0
    else:
        alpha = 0.5 * np.sin(np.pi * (abs(z) - (greatest + elastic) / 2) / (greatest - elastic)) + 0.5
    return v * (1 - alpha * np.sign(v) * z / greatest)


def bouc_wen(z, v):
    whole = (level(v) / STIFFNESS) ** -2.5
    beta, gamma = 0.8 * whole, 0.2 * whole
    return v - beta * abs(v) * abs(z) ** 1.5 * z - gamma * v * abs(z) ** 2.5


def deflections(rate, times):
    """z at the times. In µm, so that the tolerance is one of a number near 1."""
    z, out = 0.0, {}
    for begin, end in pieces():
        inside = times[(times > begin + 1e-12) & (times <= end + 1e-12)]
        if speed(0.5 * (begin + end)) == 0:
            out.update(dict.fromkeys(inside, z))
            continue
        solution = solve_ivp(lambda t, y: [1e6 * rate(1e-6 * y[0], speed(t))], (begin, end), [1e6 * z],
                             t_eval=np.unique(np.append(np.minimum(inside, end), end)), atol=1e-10, max_step=2e-3, **TOLERANCE)
        found = 1e-6 * solution.y[0]
        out.update(zip(inside, found))
        z = found[-1]
    return np.array([out[t] for t in times])


def one_state(rate, damping):
    def force(times):
        z = deflections(rate, times)
        v = speed(times)
        moving = np.array([rate(a, b) if b != 0 else 0.0 for a, b in zip(z, v)])
        return STIFFNESS * z + damping * moving + viscous(v)

    return force


def maxwell(times):
    shares, stiffness, attraction = np.array([0.1, 0.2, 0.3, 0.4]), np.array([2e6, 1e6, 0.5e6, 0.25e6]), 4e4
    force, out = np.zeros(4), {}
    slips, last = np.zeros(4, bool), 0.0
    for begin, end in pieces():
        sign = np.sign(speed(0.5 * (begin + end)))
        if sign == 0 or sign * last < 0:
            slips[:] = False
        last = sign
        at = begin
        inside = times[(times > begin + 1e-12) & (times <= end + 1e-12)]
        if sign == 0:
            out.update(dict.fromkeys(inside, force.sum()))
            continue
        while at < end:
            def rate(t, f, slips=slips.copy()):
                v = speed(t)
                return np.where(slips, attraction * (shares * sign - f / level(sign * max(abs(v), 1e-300))), stiffness * v)

            def event(i):
                def reached(t, f):
                    v = speed(t)
                    return -1.0 if slips[i] else sign * f[i] - shares[i] * level(sign * max(abs(v), 1e-300))

                reached.terminal, reached.direction = True, 1
                return reached

            asked = inside[inside > at + 1e-12]
            solution = solve_ivp(rate, (at, end), force, t_eval=np.unique(np.append(np.minimum(asked, end), end)), atol=1e-9,
                                 max_step=2e-3, events=[event(i) for i in range(4)], **TOLERANCE)
            met = [i for i in range(4) if len(solution.t_events[i])]
            for t, value in zip(solution.t, np.reshape(solution.y, (4, -1)).T):
                near = inside[abs(inside - t) < 1e-12]
                if len(near):
                    out[near[0]] = value.sum()
            if met:
                at = solution.t_events[met[0]][0]
                force = solution.y_events[met[0]][0].copy()
                for i in met:
                    slips[i] = True
            else:
                at, force = end, solution.y[:, -1]
    return np.array([out[t] for t in times]) + viscous(speed(times))


def static(sign):
    return lambda times: np.array([level(v) * sign(v / 1e-3) + viscous(v) for v in speed(times)])


# Limits: differences in N at steps of 1 and 0.1 ms.
LAWS = {
    "static tanh": (static(np.tanh), (5e-12, 5e-12)),
    "static arctan": (static(lambda x: 2 / np.pi * np.arctan(x)), (5e-12, 5e-12)),
    "LuGre": (one_state(lugre, 400.0), (8e-2, 8e-4)),
    "Dahl": (one_state(dahl, 0.0), (5e-2, 5e-4)),
    "elasto-plastic": (one_state(elasto_plastic, 400.0), (1.4e-1, 1.4e-3)),
    "Bouc-Wen": (one_state(bouc_wen, 0.0), (2.4e-1, 2.4e-3)),
    "Maxwell slip": (maxwell, (3.3e-1, 1.2e-2)),
}

ours = {}
with open(sys.argv[1], newline="") as file:
    for row in csv.DictReader(file):
        ours.setdefault((row["law"], float(row["step"])), []).append((float(row["time"]), float(row["force"])))

failed = set(name for name, _ in ours) != set(LAWS)
print(f"SciPy {scipy.__version__}; greatest difference of the force, N, and the greatest force")
print(f"{'law':<15} {'1 ms':>9} {'0.1 ms':>9} {'force':>7}")
for name, (law, limits) in LAWS.items():
    line, greatest = f"{name:<15}", 0.0
    for step, limit in zip((1e-3, 1e-4), limits):
        times, forces = map(np.array, zip(*ours[name, step]))
        theirs = law(times)
        off, greatest = np.max(np.abs(forces - theirs)), np.max(np.abs(theirs))
        failed |= not off <= limit
        line += f" {off:9.1e}"
    print(f"{line} {greatest:7.1f}")
sys.exit(1 if failed else 0)
