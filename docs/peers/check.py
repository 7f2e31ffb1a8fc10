"""Checks the peers where the answer is known in closed form: a rigid slide on prescribed motion.

Each peer must name what hides, at its size, and must say nothing of a machine that is as told.
"""

import json
import sys
import tempfile
from pathlib import Path

import numpy as np

import compare
import score
from library import bristle
from machine import Machine

AXIS = Path(__file__).parents[2] / "data/axes/linear-motor.toml"
PERIOD = 1e-3
NOISE = 0.02  # A, of the current


def motion(seed, moves=8):
    """Rest, then moves to and fro of unlike length and speed, each a quintic in time."""
    random, start, parts = np.random.default_rng(seed), 0.1, [np.full(200, 0.1)]
    for k in range(moves):
        end = 0.1 + (0.2 + 0.4 * random.random() if k % 2 == 0 else 0.1 * random.random())
        t = np.linspace(0.0, 1.0, int(400 + 800 * random.random()))
        parts += [start + (end - start) * (10 * t**3 - 15 * t**4 + 6 * t**5), np.full(150, end)]
        start = end
    return np.concatenate(parts)


def log(machine, hidden, seed):
    """Position and current of the slide; `hidden` adds a force of position, speed and bristle."""
    x = motion(seed)
    v = np.gradient(x, PERIOD)
    s = bristle(x, machine.presliding)
    force = machine.inertia * np.gradient(v, PERIOD) + machine.viscous * v + machine.coulomb * s + hidden(x, v, s)
    noise = NOISE * np.random.default_rng(seed + 100).standard_normal(len(x))
    return np.column_stack([PERIOD * np.arange(len(x)), x, force / machine.gain + noise])


def main():
    machine = Machine(AXIS)
    wave = 2.0 * np.pi / machine.pole_pitch
    questions = {
        "nothing": (lambda x, v, s: 0.0, None),
        "viscous-friction": (lambda x, v, s: 40.0 * v, [40.0]),
        "force-ripple": (lambda x, v, s: 15.0 * np.sin(wave * x + 1.0), [15.0]),
        "spring-force": (lambda x, v, s: 150.0 * (x - x[0]), [150.0]),
    }
    wrong = []
    for name, (hidden, truth) in questions.items():
        with tempfile.TemporaryDirectory() as folder:
            folder = Path(folder)
            (folder / "axis.toml").write_text(AXIS.read_text())
            for file, seed in (("fit.csv", 1), ("check.csv", 2)):
                np.savetxt(folder / file, log(machine, hidden, seed), delimiter=",", header="t_s,position_m,iq_a", comments="")
            for peer, (derivative, regression) in compare.PEERS.items():
                names, value, _ = compare.searched(folder, {"period_s": PERIOD, "tolerance": 0.05}, derivative, regression)
                size = score.estimates(name, value, machine, names)
                print(f"{name:18} {peer:9} {[n for n, _ in names]} {size}", flush=True)
                right = not names if truth is None else any(name in effects for _, effects in names)
                if not right or (truth and abs(size[0] / truth[0] - 1.0) > 0.1):
                    wrong.append((name, peer))
    if wrong:
        sys.exit(f"not found, or found where nothing is: {wrong}")


if __name__ == "__main__":
    main()
