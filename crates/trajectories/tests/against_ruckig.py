#!/usr/bin/env python3
"""Changes of velocity against ruckig (pip install ruckig==0.19.4), over random states.

    cargo build -p trajectories --example velocity_changes
    python3 crates/trajectories/tests/against_ruckig.py target/debug/examples/velocity_changes [COUNT] [SEED]

Prints how many ruckig solves and the greatest relative difference of durations; exit 1 above 1e-9.
"""

import random
import subprocess
import sys

from ruckig import ControlInterface, InputParameter, Result, Ruckig, Trajectory


def main(example, count=100_000, seed=1):
    draw = random.Random(seed)
    cases = []
    for _ in range(count):
        cases.append((
            draw.uniform(-2, 2), draw.uniform(-6, 6), draw.uniform(-2, 2),
            -draw.uniform(0.5, 5), draw.uniform(0.5, 5), 10 ** draw.uniform(0, 3),
        ))
    lines = "".join(" ".join(map(repr, case)) + "\n" for case in cases)
    ours = subprocess.run([example], input=lines, capture_output=True, text=True, check=True).stdout.split("\n")

    planner, given, trajectory = Ruckig(1), InputParameter(1), Trajectory(1)
    given.control_interface = ControlInterface.Velocity
    given.target_acceleration = [0.0]
    solved, off, longer, beyond = 0, 0.0, 0.0, 0
    for case, line in zip(cases, ours):
        v, a, wanted, least, greatest, jerk = case
        given.current_position, given.current_velocity, given.current_acceleration = [0.0], [v], [a]
        given.target_velocity = [wanted]
        given.min_acceleration, given.max_acceleration, given.max_jerk = [least], [greatest], [jerk]
        if planner.calculate(given, trajectory) not in (Result.Working, Result.Finished):
            continue
        solved += 1
        beyond += not least <= a <= greatest
        difference = float(line.split()[0]) / trajectory.duration - 1
        off, longer = max(off, abs(difference)), max(longer, difference)
    print(f"{count} states (seed {seed}), {beyond} of them beyond a limit; solved by ruckig: {solved}, here: {len(cases)}")
    print(f"greatest relative difference of durations: {off:.1e}; longer than ruckig by at most {longer:.1e}")
    return off > 1e-9


if __name__ == "__main__":
    sys.exit(main(sys.argv[1], *map(int, sys.argv[2:])))
