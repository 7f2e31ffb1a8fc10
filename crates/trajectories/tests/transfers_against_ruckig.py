#!/usr/bin/env python3
"""Transfers from any state to any other against ruckig (pip install ruckig==0.19.4), over random states.

    cargo build -p trajectories --example transfers
    python3 crates/trajectories/tests/transfers_against_ruckig.py target/debug/examples/transfers [COUNT] [SEED] [KIND]

KIND: `inside` (start within its limits), `beyond` (start beyond one or more), `corners` (whole numbers, many of them
zero or at a limit), `lasting` (a least duration up to twice the least), `f32` (as `inside`, planned in f32), `jumps`
(infinite jerk), `together` (three axes that end together), `wide` (limits over seven to nine orders of magnitude), `straight` (three axes on a line, standing still at both ends;
ruckig leaves the line where an axis would have to be slower than its limits, and is faster then).
Prints how many each solves, how the durations compare, and how far the end
is missed; lists the cases that differ most. Exit 1 if a duration in f64 is longer than ruckig's by more than 1e-9 relative.

    python3 crates/trajectories/tests/transfers_against_ruckig.py golden > crates/trajectories/tests/golden/transfers.txt
"""

import random
import subprocess
import sys

from ruckig import InputParameter, Result, Ruckig, RuckigError, Synchronization, Trajectory


def case(draw, kind):
    """One line: v0 a0, p1 v1 a1, velocity limits, acceleration limits, jerk, least duration."""
    while True:
        fast, back = draw.uniform(0.2, 3), -draw.uniform(0.2, 3)
        greatest, least = draw.uniform(0.5, 6), -draw.uniform(0.5, 6)
        jerk = 10 ** draw.uniform(0, 3)
        if kind == "wide":
            fast, back = 10 ** draw.uniform(-4, 3), -10 ** draw.uniform(-4, 3)
            greatest, least = 10 ** draw.uniform(-3, 4), -10 ** draw.uniform(-3, 4)
            jerk = 10 ** draw.uniform(-2, 7)
        v1 = draw.choice([0.0, draw.uniform(back, fast)])
        a1 = 0.0 if v1 == 0.0 and draw.random() < 0.5 else draw.choice([0.0, draw.uniform(least, greatest)])
        before = v1 - a1 * abs(a1) / (2 * jerk)
        p1 = draw.choice([-1, 1]) * 10 ** draw.uniform(-3, 1)
        if not back < before < fast:
            continue
        if kind == "beyond":
            v0, a0 = draw.uniform(-5, 5), draw.uniform(-9, 9)
        else:
            v0, a0 = draw.uniform(back, fast), draw.choice([0.0, draw.uniform(least, greatest)])
        after = v0 + a0 * abs(a0) / (2 * jerk)
        inside = back < after < fast and back <= v0 <= fast and least <= a0 <= greatest
        if kind == "jumps":
            return [v0, 0.0, p1, v1, 0.0, back, fast, least, greatest, float("inf"), 0.0]
        if kind == "straight":
            return [0.0, 0.0, p1, 0.0, 0.0, back, fast, least, greatest, jerk, 0.0]
        if inside != (kind == "beyond"):
            return [v0, a0, p1, v1, a1, back, fast, least, greatest, jerk, 0.0]


def corner(draw):
    """As `case`, of whole numbers: limits of 1 or 2, values from limit to limit.

    A start and an end at limits of both velocity and acceleration make ruckig end the process in places: not both.
    """
    while True:
        fast, back, greatest, least = (s * draw.choice([1.0, 2.0]) for s in (1, -1, 1, -1))
        jerk = draw.choice([1.0, 2.0, 4.0, 100.0])
        v0, v1 = draw.choice([0.0, back, fast, 0.5]), draw.choice([0.0, 0.0, back, fast, 0.5])
        a0, a1 = draw.choice([0.0, least, greatest, 0.5]), draw.choice([0.0, 0.0, least, greatest, 0.5])
        before, after = v1 - a1 * abs(a1) / (2 * jerk), v0 + a0 * abs(a0) / (2 * jerk)
        if back <= before <= fast and back < after < fast:
            p1 = draw.choice([0.0, 0.25, 0.5, 1.0, 2.0, 5.0, -0.25, -0.5, -1.0, -2.0, -5.0])
            return [v0, a0, p1, v1, a1, back, fast, least, greatest, jerk, 0.0]


def ruckig_of(cases):
    """Durations, None where ruckig finds nothing."""
    planner, given, trajectory = Ruckig(1), InputParameter(1), Trajectory(1)
    given.current_position = [0.0]
    for v0, a0, p1, v1, a1, back, fast, least, greatest, jerk, lasting in cases:
        given.current_velocity, given.current_acceleration = [v0], [a0]
        given.target_position, given.target_velocity, given.target_acceleration = [p1], [v1], [a1]
        given.min_velocity, given.max_velocity = [back], [fast]
        given.min_acceleration, given.max_acceleration, given.max_jerk = [least], [greatest], [jerk]
        given.minimum_duration = lasting or None
        try:
            solved = planner.calculate(given, trajectory) in (Result.Working, Result.Finished)
        except RuckigError:
            solved = False
        yield trajectory.duration if solved else None


def leaves_line(trajectory, p1):
    """Whether three axes are ever at different shares of their distances."""
    for i in range(1, 20):
        shares = [x / y for x, y in zip(trajectory.at_time(trajectory.duration * i / 20)[0], p1)]
        if max(shares) - min(shares) > 1e-9:
            return True
    return False


def ruckig_of_axes(cases, kind, off_line):
    """Durations of every three cases together; to `off_line`, whether ruckig leaves the line that it is to keep."""
    planner, given, trajectory = Ruckig(3), InputParameter(3), Trajectory(3)
    given.current_position = [0.0] * 3
    given.synchronization = Synchronization.Phase if kind == "straight" else Synchronization.Time
    for three in zip(cases[::3], cases[1::3], cases[2::3]):
        v0, a0, p1, v1, a1, back, fast, least, greatest, jerk, _ = map(list, zip(*three))
        given.current_velocity, given.current_acceleration = v0, a0
        given.target_position, given.target_velocity, given.target_acceleration = p1, v1, a1
        given.min_velocity, given.max_velocity = back, fast
        given.min_acceleration, given.max_acceleration, given.max_jerk = least, greatest, jerk
        try:
            solved = planner.calculate(given, trajectory) in (Result.Working, Result.Finished)
        except RuckigError:
            solved = False
        off_line.append(kind == "straight" and solved and leaves_line(trajectory, p1))
        yield trajectory.duration if solved else None


def ours_of(example, cases, *options):
    lines = "".join(" ".join(map(repr, case)) + "\n" for case in cases)
    answer = subprocess.run([example, *options], input=lines, capture_output=True, text=True, check=True).stdout
    return [None if line == "-" else [float(x) for x in line.split()] for line in answer.splitlines()]


def golden(count):
    """Lines of cases and ruckig's durations: what `tests/golden/transfers.txt` holds."""
    draw = random.Random(5)
    for kind in ("inside", "beyond", "corners", "jumps", "lasting"):
        cases = [corner(draw) if kind == "corners" else case(draw, kind) for _ in range(count)]
        durations = list(ruckig_of(cases))
        if kind == "lasting":
            for one, least in zip(cases, durations):
                one[-1] = least * draw.uniform(1, 2)
            durations = list(ruckig_of(cases))
        for one, duration in zip(cases, durations):
            # ruckig turns away from a target it stands at, in motion.
            there = kind == "corners" and one[2] == 0.0 and one[:2] == one[3:5]
            if duration is not None and not there:
                print(*map(repr, one), repr(duration))


def main(example, count=100_000, seed=1, kind="inside"):
    draw = random.Random(int(seed))
    cases = [corner(draw) if kind == "corners" else case(draw, kind) for _ in range(int(count))]
    if kind == "lasting":
        for one, plan in zip(cases, ours_of(example, cases)):
            one[-1] = plan[0] * draw.uniform(1, 2)
    axes = kind in ("together", "straight")
    ours = ours_of(example, cases, *([kind] if axes or kind == "f32" else []))
    tolerance = 1e-4 if kind == "f32" else 1e-9
    equal = longer = shorter = alone = only_ruckig = neither = 0
    worst, missed, off, off_line, longer_off_line = [], 0.0, [], [], 0
    for one, plan, theirs in zip(cases[::3] if axes else cases, ours, ruckig_of_axes(cases, kind, off_line) if axes else ruckig_of(cases)):
        if plan and not axes:
            total, p, v, a = plan
            a = one[4] if kind == "jumps" else a
            # A rounding of time before the end, in distances the motion covers.
            size = [1e-3 + abs(one[2]) + max(abs(one[0]), 3) * total, max(abs(one[0]), 3), max(abs(one[1]), 6)]
            missed = max([missed] + [abs(x - y) / s for x, y, s in zip((p, v, a), one[2:5], size)])
        if plan is None or theirs is None:
            alone += plan is not None
            only_ruckig += theirs is not None
            neither += plan is None and theirs is None
            if plan is None:
                worst.append((float("inf"), one, plan, theirs))
            continue
        difference = plan[0] / theirs - 1 if theirs else plan[0]
        off.append(abs(difference))
        if abs(difference) <= tolerance:
            equal += 1
            continue
        longer += difference > 0
        longer_off_line += bool(axes and difference > 0 and off_line[-1])
        shorter += difference < 0
        worst.append((difference, one, plan, theirs))
    print(f"{kind}: {len(ours)} tasks (seed {seed}); both solve {equal + longer + shorter}, "
          f"only here {alone}, only ruckig {only_ruckig}, neither {neither}")
    print(f"durations equal to {tolerance:g} relative: {equal}; longer here: {longer}; shorter here: {shorter}")
    if kind == "straight":
        print(f"ruckig leaves the line in {sum(off_line)}, {longer_off_line} of which are longer here")
    off.sort()
    print(f"difference, median {off[len(off) // 2]:.1e}, 99.9 % below {off[int(0.999 * len(off))]:.1e}; "
          f"end missed by at most {missed:.1e} of the motion's size")
    worst.sort(key=lambda w: -w[0])
    for difference, one, plan, theirs in worst[:5] + worst[max(5, len(worst) - 5):]:
        print(f"  {difference:+.3e} here {plan and plan[0]} ruckig {theirs}: {' '.join(map(repr, one))}")
    return kind not in ("f32", "straight") and (longer > 0 or only_ruckig > 0)


if __name__ == "__main__":
    if sys.argv[1] == "golden":
        sys.exit(golden(200))
    sys.exit(main(*sys.argv[1:]))
