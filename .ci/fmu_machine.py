"""Checks of units of machines with FMPy, by FMI 3.0 and 2.0: fmu_machine.py PROGRAM LIBRARY MACHINE..."""

import math
import sys
import tempfile
from pathlib import Path

import numpy as np
from fmpy import simulate_fmu
from fmpy.validation import validate_fmu
from fmu_unit import Unit, in_c, run

PROGRAM, LIBRARY, MACHINES = sys.argv[1], sys.argv[2], sys.argv[3:]
QUANTITIES = ("position_ref_m", "velocity_ref_m_s", "acceleration_ref_m_s2")


def export(machine, version, folder):
    fmu = Path(folder) / f"{machine}-{version}.fmu"
    file = f"data/machines/{machine}.toml"
    run(PROGRAM, "export", "fmu", "--fmi", version, "--machine", file, "--out", str(fmu), "--library", LIBRARY)
    return fmu


def letters(unit):
    return [name[0] for name in unit.references if name.endswith(f".{QUANTITIES[0]}")]


def references(unit, t):
    """A motion of some 0.4 mm of each axis, and a force on its load."""
    starts = {v.name: float(v.start) for v in unit.of_causality("input")}
    values = {}
    for axis, letter in enumerate(letters(unit)):
        omega, radius = 20.0 + 3.0 * axis, 2e-4
        sine, cosine = math.sin(omega * t), math.cos(omega * t)
        numbers = (radius * (1.0 - cosine), radius * omega * sine, radius * omega**2 * cosine)
        for quantity, number in zip(QUANTITIES, numbers):
            name = f"{letter}.{quantity}"
            values[name] = starts[name] + number
        values[f"{letter}.load_force_n"] = 10.0 * math.sin(50.0 * t)
    return values


def follow(unit, first, last, share=1.0):
    """All outputs, at each step of a share of the period."""
    outputs = [v.valueReference for v in unit.of_causality("output")]
    step, rows = share * unit.step_size, []
    for k in range(first, last):
        values = references(unit, k * step)
        unit.write([unit.references[name] for name in values], list(values.values()))
        unit.fmu.doStep(k * step, step)
        rows.append(unit.read(outputs))
    return rows


def check_run(fmus):
    """Every output moves with the same bits in both versions; the tool is not where the scales are."""
    rows = []
    for fmu in fmus:
        unit = Unit.of(fmu)
        unit.begin()
        rows.append(follow(unit, 0, 1000))
        assert not unit.told, unit.told
    assert rows[0] == rows[1]
    names = [v.name for v in unit.of_causality("output")]
    columns = dict(zip(names, np.array(rows[0]).T))
    for letter in letters(unit):
        assert np.ptp(columns[f"tool.{letter}_m"]) > 1e-4, letter
        assert np.ptp(columns[f"{letter}.drive.position_m"]) > 1e-4, letter
    apart = max(np.abs(columns[f"tool.{letter}_m"] - columns[f"{letter}.machine.position_m"]).max() for letter in letters(unit))
    assert apart > 1e-9
    return f"1000 periods, {len(names)} outputs, the same bits; the tool up to {apart:.1e} m from a scale"


def check_steps(fmus):
    """Steps that no period divides, the machine held or as it is between two samples."""
    for exact in (0.0, 1.0):
        rows = []
        for fmu in fmus:
            unit = Unit.of(fmu)
            unit.set("unit.exact_between_samples", exact)
            unit.begin()
            rows.append(follow(unit, 0, 700, 0.37))
        assert rows[0] == rows[1]


def check_states(fmus):
    """Restored, in another instance, and as bytes in a third."""
    for fmu in fmus:
        unit = Unit.of(fmu)
        unit.begin()
        follow(unit, 0, 200)
        state = unit.save()
        written = unit.to_bytes(state)
        first = follow(unit, 200, 300)
        unit.restore(state)
        assert follow(unit, 200, 300) == first
        late = Unit.of(fmu)
        read = late.of_bytes(written)
        late.restore(read)
        assert follow(late, 200, 300) == first
        late.refuses("damaged", late.of_bytes, written[:-1])
        unit.free(state)
        late.free(read)
        unit.set(f"{letters(unit)[1]}.position_ref_m", 1e3)
        unit.refuses("axis 2", lambda: unit.fmu.doStep(300 * unit.step_size, 1.0))


def check_parameters(fmus):
    """Those of axes and those of the machine have limits and count; what is outside is refused."""
    for fmu in fmus:
        unit, plain = Unit.of(fmu), Unit.of(fmu)
        parameters = unit.of_causality("parameter")
        for v in parameters:
            assert float(v.min) <= float(v.start) <= float(v.max), v.name
        of_machine = [v for v in parameters if v.name.split(".")[0] in ("coupling", "base", "gantry")]
        of_axis = [v for v in parameters if v.name.startswith("y.") and "mass" in v.name]
        assert of_machine and of_axis
        plain.begin()
        nominal = follow(plain, 0, 300)
        for v in (of_machine[0], of_axis[0]):
            changed = Unit.of(fmu)
            changed.set(v.name, 0.5 * float(v.start))
            changed.begin()
            assert follow(changed, 0, 300) != nominal, v.name
            changed.refuses("fixed", changed.set, v.name, float(v.start))
            changed.fmu.reset()
            changed.set(v.name, 2.0 * float(v.max))
            changed.enter()
            changed.refuses("valid:", changed.fmu.exitInitializationMode)
    return f"{len(parameters)} parameters, {len(of_machine)} of the machine file"


def check_plain_call(fmus):
    results = [simulate_fmu(str(fmu), stop_time=0.05, output_interval=1e-3) for fmu in fmus]
    assert results[0].tobytes() == results[1].tobytes()
    for fmu in fmus:
        # Without a stop time: the longest first trajectory of its axes.
        assert simulate_fmu(str(fmu))["time"][-1] > 0.1


def check_c(fmus):
    said = [in_c(Unit.of(fmu), int(fmu.stem[-1])) for fmu in fmus]
    return said[0]


def main():
    checks = [value for name, value in globals().items() if name.startswith("check_")]
    with tempfile.TemporaryDirectory() as folder:
        for machine in MACHINES:
            fmus = [export(machine, version, folder) for version in ("2", "3")]
            for fmu in fmus:
                problems = validate_fmu(str(fmu))
                assert not problems, problems
            for check in checks:
                said = check(fmus)
                print(f"{machine}: {check.__name__[6:].replace('_', ' ')}" + (f": {said}" if said else ""), flush=True)
    print(f"{len(MACHINES) * len(checks)} passed, 0 failed")


main()
