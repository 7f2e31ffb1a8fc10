#!/usr/bin/env python3
"""The pictures of docs/effects.md: what each effect adds to one channel of a log.

    docs/images/effects.py FEED-AXIS [--out FOLDER]    FEED-AXIS: the program; FOLDER: docs/images if left out

The example axis of `feed-axis new` moves forth and back, once as it is and once with the effect; what is drawn is the
difference. Python's standard library is all that it needs.
"""

import csv
import subprocess
import sys
import tempfile
from pathlib import Path

TAU = 6.283185307179586
SPEEDS = {"mm": (600, 660, 100, 1000, 20000), "deg": (0, 90, 180, 1500, 50000)}
LEAD_M = 0.010


def program(unit):
    """Forth and back, with a standstill before, between and after."""
    start, end, speed, acceleration, jerk = SPEEDS[unit]
    lines = [f"start_{unit} = {start}"]
    dwell = "[[steps]]\ndwell = { duration_s = 0.25 }"
    for to in (end, start):
        lines += [dwell, f"[[steps]]\nmove = {{ to_{unit} = {to}, velocity_{unit}_s = {speed}, "
                         f"acceleration_{unit}_s2 = {acceleration}, jerk_{unit}_s3 = {jerk} }}"]
    return "\n\n".join([*lines, dwell]) + "\n"


def current(row):
    return row["iq_a"]


def voltage(row):
    return row["uq_v"]


def between(row):
    """Load against motor, µm."""
    return 1e6 * (row["position_m"] - LEAD_M / TAU * row["motor_angle_rad"])


def error(row):
    return 1e6 * (row["position_ref_m"] - row["position_m"])


A, V, UM = "q current, A", "q voltage, V", "load against motor, µm"
# File: channel in words, its value, and the effects with their numbers (SI).
PICTURES = {
    "friction": (A, current, [
        ("viscous-friction", "coefficient = 4000"),
        ("coulomb-friction", "force = 60"),
        ("asymmetric-friction", "forward = 60\nbackward = 20"),
        ("asymmetric-viscous-friction", "forward = 4000\nbackward = 2000"),
        ("stribeck-friction", "force = 60\nvelocity = 0.02"),
        ("presliding", "stiffness = 5e6"),
        ("position-dependent-friction", "peak = 60\ncentre = 0.63\nwidth = 0.008"),
        ("load-dependent-friction", "ratio = 0.05"),
        ("warming-friction", "force = 120\nwarming_distance = 0.2"),
        ("maxwell-slip-hysteresis", "force = 60\npresliding_distance = 1e-4"),
    ]),
    "loads": (A, current, [
        ("constant-load", "force = 40"),
        ("process-force", "force = 60\nstart = 0.5\nend = 0.8"),
        ("cyclic-load", "amplitude = 60\nperiod = 0.5\nphase = 0"),
        ("spring-force", "stiffness = 600"),
        ("gravity-imbalance", "torque = 60\nphase = 0"),
        ("payload-mass", "mass = 30"),
        ("structural-resonance", "mass = 20\nfrequency = 20\ndamping_ratio = 0.03"),
        ("motor-inertia", "inertia = 4e-4"),
    ]),
    "motor": (A, current, [
        ("torque-constant", "relative_change = 0.05"),
        ("cogging-torque", "amplitude = 0.05\norder = 8\nphase = 0"),
        ("torque-ripple", "relative_amplitude = 0.03\nphase = 0"),
        ("force-ripple", "amplitude = 60\norder = 2\nphase = 0"),
        ("current-sensor-offset", "phase_a = 0.05\nphase_b = 0.05"),
        ("current-sensor-gain", "relative_change = 0.03"),
    ]),
    "transmission": (UM, between, [
        ("backlash", "gap = 4e-6"),
        ("lead-error", "slope = 1e-4"),
        ("periodic-lead-error", "amplitude = 2e-6\nphase = 0"),
        ("kinematic-error-harmonic", "amplitude = 2e-6\norder = 2\nphase = 0"),
        ("thermal-expansion", "strain = 4e-5\ntime_constant = 1"),
        ("transmission-stiffness", "relative_change = -0.2"),
        ("hardening-stiffness", "relative_increase = 8"),
        ("encoder-eccentricity", "amplitude = 1e-3\nphase = 0"),
    ]),
    "inverter": (V, voltage, [
        ("inverter-dead-time", "phase_voltage = 2"),
        ("stator-resistance", "relative_change = 0.15"),
    ]),
    "controller": ("tracking error, µm", error, [
        ("control-delay", "time = 1e-3"),
        ("controller-gain", "relative_change = 0.05"),
        ("speed-controller-gain", "relative_change = 0.05"),
        ("velocity-feedforward", "relative_change = 0.002"),
    ]),
}
# Those that the ball-screw axis cannot have.
OTHER_AXES = {"gravity-imbalance": ("torque-motor", "deg"), "force-ripple": ("linear-motor", "mm")}


class Machine:
    """Runs the program in a folder of its own."""

    def __init__(self, command, folder):
        self.command, self.folder = str(Path(command).resolve()), Path(folder)

    def run(self, *arguments):
        subprocess.run([self.command, *arguments], cwd=self.folder, check=True, capture_output=True)

    def log(self, kind, unit, effect=""):
        axis = self.folder / f"{kind}.toml"
        if not axis.exists():
            self.run("new", kind, "--kind", kind)
        (self.folder / "program.toml").write_text(program(unit))
        (self.folder / "with.toml").write_text(axis.read_text() + effect)
        self.run("simulate", "--axis", "with.toml", "--program", "program.toml", "--log", "log.csv")
        with (self.folder / "log.csv").open() as file:
            return [{name: float(value) for name, value in row.items()} for row in csv.DictReader(file)]


def thinned(times, values, most=110):
    """Least and greatest value of each stretch of time, in their order, so that a thin peak stays."""
    step, points = max(1, len(times) // most), []
    for begin in range(0, len(times), step):
        part = range(begin, min(begin + step, len(times)))
        ends = {min(part, key=values.__getitem__), max(part, key=values.__getitem__)}
        points += [(times[at], values[at]) for at in sorted(ends)]
    return points


def shown(number):
    return f"{number:.3g}".replace("-", "−") if number else "0"


WIDE, HIGH, COLUMNS = 240, 110, 3


def panel(title, points, seconds, at):
    """One curve with its zero line and its greatest value."""
    top = max(abs(value) for _, value in points) or 1.0
    left, width, middle, half = 12, WIDE - 24, 66, 34
    place = " ".join(f"{left + width * t / seconds:.1f},{middle - half * v / top:.1f}" for t, v in points)
    peak = max((value for _, value in points), key=abs)
    return (
        f'<g transform="translate({at[0]},{at[1]})"><text x="{left}" y="14" class="n">{title}</text>'
        f'<text x="{left}" y="27">largest {shown(peak)}</text>'
        f'<path d="M{left} {middle}h{width}" class="z"/><polyline points="{place}"/></g>'
    )


def picture(machine, words, value, effects, bases):
    panels, seconds = [], 0.0
    for number, (name, numbers) in enumerate(effects):
        kind, unit = OTHER_AXES.get(name, ("screw-datasheet", "mm"))
        if (kind, unit) not in bases:
            bases[kind, unit] = machine.log(kind, unit)
        before = bases[kind, unit]
        after = machine.log(kind, unit, f'\n[[effects]]\nname = "{name}"\n{numbers}\n')
        times = [row["t_s"] for row in before]
        points = thinned(times, [value(b) - value(a) for a, b in zip(before, after)])
        at = (WIDE * (number % COLUMNS), 22 + HIGH * (number // COLUMNS))
        panels.append(panel(name, points, times[-1], at))
    columns, rows = min(COLUMNS, len(effects)), -(-len(effects) // COLUMNS)
    wide, high = max(WIDE * columns, 380), 22 + HIGH * rows
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {wide} {high}" width="{wide}" height="{high}">'
        "<style>text{font:11px sans-serif;fill:#777}.n{font-weight:bold}.z{stroke:#999;stroke-dasharray:3}"
        "polyline{fill:none;stroke:#2878c8;stroke-width:1.3}</style>"
        f'<title>{words}: with the effect minus without</title><text x="12" y="14">{words}: with the effect minus '
        "without, over time</text>" + "\n".join(panels) + "</svg>\n"
    )


def main():
    arguments = sys.argv[1:]
    if not arguments or len(arguments) not in (1, 3):
        sys.exit(__doc__)
    out = Path(arguments[2]) if len(arguments) == 3 else Path(__file__).parent
    bases = {}
    with tempfile.TemporaryDirectory() as folder:
        machine = Machine(arguments[0], folder)
        for name, (words, value, effects) in PICTURES.items():
            text = picture(machine, words, value, effects, bases)
            (out / f"effects-{name}.svg").write_text(text)
            print(f"effects-{name}.svg: {len(text) / 1000:.0f} kB")


main()
