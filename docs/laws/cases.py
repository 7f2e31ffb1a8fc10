"""Draws cases of hidden laws and effects, and writes their logs: cases.py SEED FIRST LAST FOLDER"""

import json
import sys
from pathlib import Path

import numpy as np

from machine import MACHINES, logged, simulate

# Of each kind, the names that are right; none of a law outside the library.
RIGHT = {
    "clean": [],
    "cogging": ["force-ripple", "cogging-torque", "torque-ripple"],
    # Dry friction that differs between the directions is a constant load while it slides.
    "asym": ["asymmetric-friction", "constant-load"],
    "load": ["constant-load", "asymmetric-friction"],
    "spring": ["spring-force", "constant-load"],
    "bump": ["position-dependent-friction"],
    "cyclic": ["cyclic-load"],
    "stribeck": ["stribeck-friction"],
    "thermal": ["warming-friction"],
    "drift": ["process-force"],
    "lawx": [], "x2": [], "xv": [], "vt": [], "v3": [],
}
# Of laws outside the library, the variable.
OVER = {
    "lawx": "position", "x2": "position", "xv": "the product of speed and position", "vt": "speed", "v3": "speed", "drift": "time",
}
KINDS = ["clean", "clean"] + list(RIGHT)


def draw(seed, i):
    random = np.random.default_rng([seed, i])
    machine = MACHINES[i % len(MACHINES)]
    onset = ["arctan", "slip", "bristle"][random.integers(3)]
    kind = KINDS[random.integers(len(KINDS))]
    dry, middle = machine["coulomb"], machine["middle"]
    reach, top = (max(abs(move[i]) for move in machine["moves"][0]) for i in range(2))
    by, sign, share = random.uniform(0.15, 0.65), random.choice([-1.0, 1.0]), random.random(2)
    value = {
        "cogging": (dry * by, machine["magnets"], 6.28 * share[0]),
        "asym": sign * (0.1 + 0.25 * share[0]),
        "load": sign * dry * by,
        "spring": dry * by / (0.5 * reach),
        "bump": (1.5 * dry * by, middle + 0.25 * reach * (share[0] - 0.5), reach * (0.05 + 0.07 * share[1])),
        "cyclic": (dry * by, 1 + 8 * share[0]),
        "stribeck": (dry * by, top * (0.004 + 0.025 * share[0])),
        "thermal": 0.1 + 0.3 * share[0],
        "drift": sign * dry * by,
        "lawx": (dry * by, reach * (0.08 + 0.12 * share[0])),
        "x2": (dry * by, 0.5 * reach),
        "xv": (dry * by, 0.5 * reach * top),
        "vt": (sign * dry * by, 0.25 * top),
        "v3": (dry * by, top),
    }
    noise = {
        "rate": int(random.choice([1000, 2000, 500])),
        "colour": str(random.choice(["white", "autoregressive", "pink"])),
        "level": float(random.choice([0.004, 0.015, 0.04])) * machine["noise"],
        "bit": machine.get("bit", 0.002 * machine["noise"]),
        "jitter": 0.03 if random.random() < 0.25 else 0.0,
    }
    hidden = {} if kind == "clean" else {kind: value[kind]}
    return machine, onset, kind, hidden, noise


def main(seed, first, last, folder):
    for i in range(first, last):
        machine, onset, kind, hidden, noise = draw(seed, i)
        case = Path(folder) / f"{seed}-{i:03d}"
        case.mkdir(parents=True, exist_ok=True)
        for k, moves in enumerate(machine["moves"]):
            random = np.random.default_rng([seed, i, k])
            motion = simulate(machine, moves, hidden, onset, random)
            table = np.column_stack(logged(machine, *motion, noise, random))
            header = f"t_s,{'motor_angle_rad' if 'ratio' in machine else 'position_m'},{machine['channel']}"
            np.savetxt(case / f"log-{k}.csv", table, "%.9g", ",", header=header, comments="")
        truth = {"axis": machine["axis"], "onset": onset, "kind": kind, "hidden": hidden, "noise": noise}
        (case / "truth.json").write_text(json.dumps(truth))


if __name__ == "__main__":
    main(*map(int, sys.argv[1:4]), sys.argv[4])
