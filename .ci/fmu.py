"""Checks of exported units with FMPy, by FMI 3.0 and 2.0: fmu.py PROGRAM LIBRARY AXIS..."""

import contextlib
import ctypes
import io
import sys
import tempfile
from pathlib import Path

import fmu2
import fmu3
import numpy as np
from fmpy import read_model_description, simulate_fmu
from fmpy.validation import validate_fmu
from fmu_unit import Unit, follow, late_log_of, log_of, run, shared, told

PROGRAM, LIBRARY, AXES = sys.argv[1], sys.argv[2], sys.argv[3:]
TOLERANCE = 1e-12  # of the channel's greatest value
STRATEGIES = {"liu2025": ["plan", "feedback"]}
STEPS = {"liu2025": 1, "liu2025-machine": 1, "joint": 1}  # internal steps of a control period; 2 of the others


def check_validation(fmu, _):
    problems = validate_fmu(str(fmu))
    assert not problems, problems


def check_run(fmu, log):
    unit = Unit.of(fmu)
    unit.begin()
    rows = follow(unit, log, 0, len(log["t_s"]))
    worst, same = 0.0, True
    for i, name in enumerate(shared(unit, log)):
        column = log[name[6:]]
        scale = max(map(abs, column)) or 1.0
        off = max(abs(row[i] - value) for row, value in zip(rows, column)) / scale
        assert off <= TOLERANCE, f"{name} is off by {off}"
        worst, same = max(worst, off), same and off == 0.0
    assert len(shared(unit, log)) + 3 == len(log), "a channel of the log was not compared"
    assert not unit.told, unit.told
    return f"{len(rows)} cycles, {len(shared(unit, log))} channels, off by {worst:.1e}{', the same bits' if same else ''}"


def check_restore(fmu, log):
    unit = Unit.of(fmu)
    unit.begin()
    before = follow(unit, log, 0, 300)
    state = unit.save()
    first = follow(unit, log, 300, 600)
    unit.restore(state)
    assert follow(unit, log, 300, 600) == first
    # Another instance takes it up; then the first forgets everything.
    other = Unit.of(fmu)
    other.restore(state)
    unit.free(state)
    assert follow(other, log, 300, 600) == first
    unit.fmu.reset()
    unit.begin()
    assert follow(unit, log, 0, 300) == before
    # After an error, too.
    state = unit.save()
    unit.set(unit.of_causality("input")[0].name, 1e3)
    unit.refuses("following_error_limit", unit.step, 300)
    unit.restore(state)
    assert follow(unit, log, 300, 600) == first
    unit.free(state)
    unit.free(ctypes.c_void_p())
    # As bytes, in an instance that knows nothing of the first.
    unit.fmu.reset()
    unit.begin()
    follow(unit, log, 0, 300)
    state = unit.save()
    written = unit.to_bytes(state)
    late = Unit.of(fmu)
    read = late.of_bytes(written)
    late.restore(read)
    assert follow(late, log, 300, 600) == first
    assert late.to_bytes(read) == written
    late.refuses("damaged", late.of_bytes, written[:-1])
    late.refuses("damaged", late.of_bytes, b"")
    late.refuses("null", late.to_bytes, ctypes.c_void_p())
    for one in (state, read):
        late.free(one)
    unit.refuses("null", unit.restore, ctypes.c_void_p())


def check_parameters(fmu, _):
    """One that is set counts, and only before the start; what is out of range is told."""
    unit, plain = Unit.of(fmu), Unit.of(fmu)
    parameter = next(v for v in unit.of_causality("parameter") if "mass" in v.name or "inertia" in v.name)
    name, start = parameter.name, float(parameter.start)
    unit.set(name, 0.5 * start)
    reference = unit.of_causality("input")[0]
    outputs = [v.valueReference for v in unit.of_causality("output")]
    values = []
    for one in (unit, plain):
        one.begin()
        one.set(reference.name, float(reference.start) + 1e-4)
        one.step(0, 200)
        values.append(one.read(outputs))
    assert values[0] != values[1]
    assert unit.get(name) == [0.5 * start]
    unit.refuses("fixed", unit.set, name, start)
    unit.fmu.reset()
    unit.set(name, -1.0)
    unit.enter()
    unit.refuses("a number from", unit.fmu.exitInitializationMode)


def check_plain_calls(fmu, log):
    """As the first lines of a user are: whatever stop time, whatever output interval, none at all."""
    size = float(read_model_description(str(fmu)).defaultExperiment.stepSize)
    with contextlib.redirect_stdout(io.StringIO()):
        for stop in (2.5, 3, 3.632, 5, 7, 0.00305, 1 / 3):
            result = simulate_fmu(str(fmu), stop_time=stop)
            assert abs(result["time"][-1] - stop) <= 1e-9 * stop, (stop, result["time"][-1])
        result = simulate_fmu(str(fmu))
        # To the end of the axis' first trajectory, which is at or behind the log's last sample.
        assert -1e-9 <= result["time"][-1] - log["t_s"][-1] <= 1.01 * size, result["time"][-1]
        # Steps that no control period divides, the machine held or as it is between two samples.
        for exact in (0, 1):
            result = simulate_fmu(
                str(fmu), stop_time=0.01, output_interval=0.37 * size,
                start_values={"unit.exact_between_samples": exact},
            )
            assert abs(result["time"][-1] - 0.01) < 1e-12, result["time"][-1]


def check_limits(fmu, _):
    """Parameters have limits, their values are inside, and what is outside is refused at the start."""
    unit = Unit.of(fmu)
    parameters = unit.of_causality("parameter")
    for v in parameters:
        assert float(v.min) <= float(v.start) <= float(v.max), v.name
    v = next(v for v in parameters if "mass" in v.name or "inertia" in v.name)
    unit.set(v.name, 2.0 * float(v.max))
    unit.enter()
    unit.refuses(v.name.rsplit(".", 1)[1], unit.fmu.exitInitializationMode)
    return f"of {len(parameters)} parameters"


def same_in_both(units, log):
    """What an importer records of a plain call, references and disturbances given, is the same."""
    inputs = Unit.of(units[0]).of_causality("input")
    rows = np.zeros(len(log["t_s"]), dtype=[("time", float), *((v.name, float) for v in inputs)])
    rows["time"] = log["t_s"]
    for v in inputs[:3]:
        rows[v.name] = log[v.name]
    rows[inputs[3].name] = 0.01 * np.sin(50.0 * rows["time"])
    rows[inputs[4].name] = np.sin(30.0 * rows["time"])
    outputs = [v.name for v in Unit.of(units[0]).of_causality("output")]
    results = [
        simulate_fmu(str(fmu), stop_time=0.4, output_interval=step, input=rows, output=outputs)
        for step in (1e-3, 0.00137)
        for fmu in units
    ]
    for two, three in (results[:2], results[2:]):
        assert two.dtype == three.dtype and two.tobytes() == three.tobytes()
        assert max(np.ptp(two[name]) for name in outputs) > 0.0
    return f"{len(results[0])} and {len(results[2])} points, {len(outputs)} outputs, the same bits"


def plant_beside_loop(plant, loop, steps):
    """Under the torque of the closed loop's motor the machine moves as it does there, whatever the control."""
    plant, loop = Unit.of(plant), Unit.of(loop)
    loop.set("unit.exact_between_samples", 1.0)
    assert not any(v.name.startswith(("control.", "drive.t_s")) for v in plant.description.modelVariables)
    motor = plant.of_causality("input")[0].name
    seen = [v.name for v in plant.of_causality("output")]
    assert set(seen) < {v.name for v in loop.of_causality("output")}
    reference = loop.of_causality("input")[0]
    for unit in (plant, loop):
        unit.begin()
    size, count = loop.step_size / steps, 2000 * steps
    for k in range(count):
        if k % steps == 0:
            loop.set(reference.name, float(reference.start) + 1e-6 * k / steps)
        loop.fmu.doStep(k * size, size)
        plant.set(motor, *loop.get(f"machine.{motor}"))
        plant.fmu.doStep(k * size, size)
        if k % steps == steps - 1:
            assert plant.get(*seen) == loop.get(*seen), k
    assert not plant.told, plant.told
    plant.refuses("left its stroke", lambda: (plant.set(motor, 1e6), plant.fmu.doStep(count * size, 1.0)))
    return f"{count} steps, {len(seen)} outputs, the same bits"


def compensated(fmu, log, late):
    """The correction in the unit: what `simulate --compensation` makes of the motion after as long a standstill."""
    unit = Unit.of(fmu)
    unit.begin()
    inputs = unit.of_causality("input")[:3]
    names = [name for name in log if name != "t_s"]
    outputs = [unit.references[f"drive.{name}"] for name in names]
    worst, count = 0.0, len(log["t_s"]) - late
    scales = [max(map(abs, log[name])) or 1.0 for name in names]
    for k in range(count):
        unit.write([v.valueReference for v in inputs], [log[v.name][k + late] for v in inputs])
        unit.step(k)
        row = unit.read(outputs)
        worst = max(worst, *(abs(a - log[n][k]) / s for n, a, s in zip(names, row, scales)))
    assert worst <= TOLERANCE, worst
    assert not unit.told, unit.told
    error = [a - b for a, b in zip(log[inputs[0].name], log[inputs[0].name.replace("_ref", "")])]
    return f"{late} periods late, {count} cycles, {len(names)} channels, off by {worst:.1e}; greatest error {max(map(abs, error)):.3e}"


def checks_of(*modules):
    for names in modules:
        yield from (value for name, value in names.items() if name.startswith("check_"))


def main():
    passed = 0

    def show(axis, what, said):
        nonlocal passed
        passed += 1
        print(f"{axis}: {what}" + (f": {said}" if said else ""), flush=True)

    with tempfile.TemporaryDirectory() as folder:
        for axis in AXES:
            log, units = log_of(PROGRAM, axis, folder), []
            for version, own in (("2", fmu2), ("3", fmu3)):
                fmu = Path(folder) / f"{axis}-{version}.fmu"
                file = f"data/axes/{axis}.toml"
                run(PROGRAM, "export", "fmu", "--fmi", version, "--axis", file, "--out", str(fmu), "--library", LIBRARY)
                units.append(fmu)
                for check in checks_of(globals(), vars(own)):
                    said = check(fmu, log)
                    show(axis, f"FMI {version}: {check.__name__[6:].replace('_', ' ')}", said)
                plant = Path(folder) / f"{axis}-{version}-plant.fmu"
                export = ["export", "fmu", "--plant", "--fmi", version, "--axis", file, "--out", str(plant)]
                run(PROGRAM, *export, "--library", LIBRARY)
                check_validation(plant, log)
                said = plant_beside_loop(plant, fmu, STEPS.get(axis, 2))
                show(axis, f"FMI {version}: plant", said)
                for strategy in STRATEGIES.get(axis, ["plan"]):
                    corrected = Path(folder) / f"{axis}-{version}-{strategy}.fmu"
                    export = ["export", "fmu", "--strategy", strategy, "--fmi", version, "--axis", file]
                    export += ["--out", str(corrected), "--library", LIBRARY]
                    late = told(PROGRAM, *export)["look_ahead_cycles"]
                    check_validation(corrected, log)
                    start = log[next(name for name in log if name.startswith("position_ref"))][0]
                    standstill = late * Unit.of(fmu).step_size
                    late_log = late_log_of(PROGRAM, axis, folder, strategy, start, standstill)
                    said = compensated(corrected, late_log, late)
                    show(axis, f"FMI {version}: {strategy}", said)
            show(axis, "FMI 2 beside 3", same_in_both(units, log))
    print(f"{passed} passed, 0 failed")


main()
