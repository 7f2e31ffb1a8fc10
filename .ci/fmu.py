"""Checks of exported units with FMPy: fmu.py PROGRAM LIBRARY AXIS..."""

import contextlib
import csv
import ctypes
import io
import re
import subprocess
import sys
import tempfile
from pathlib import Path

import fmpy
from fmpy import extract, read_model_description, simulate_fmu
from fmpy.fmi1 import FMICallException
from fmpy.fmi3 import FMU3Slave, fmi3LogMessageCallback
from fmpy.validation import validate_fmu

PROGRAM, LIBRARY, AXES = sys.argv[1], sys.argv[2], sys.argv[3:]
TOLERANCE = 1e-12  # of the channel's greatest value


class Unit:
    """An instance, its variables by name, and what its logger was told."""

    def __init__(self, fmu, **options):
        self.folder = extract(str(fmu))
        self.description = read_model_description(str(fmu))
        self.told = []
        self.references = {v.name: v.valueReference for v in self.description.modelVariables}
        self.step_size = float(self.description.coSimulation.fixedInternalStepSize)
        self.fmu = FMU3Slave(
            guid=self.description.guid,
            unzipDirectory=self.folder,
            modelIdentifier=self.description.coSimulation.modelIdentifier,
            instanceName="one",
        )
        self.fmu.instantiate(logMessage=self.log, **options)

    def log(self, environment, status, category, message):
        self.told.append((environment, status, category.decode(), message.decode()))

    def of_causality(self, causality):
        return [v for v in self.description.modelVariables if v.causality == causality]

    def begin(self, **options):
        self.fmu.enterInitializationMode(**options)
        self.fmu.exitInitializationMode()

    def get(self, *names):
        return self.fmu.getFloat64([self.references[name] for name in names])

    def set(self, name, value):
        self.fmu.setFloat64([self.references[name]], [value])

    def step(self, cycle, cycles=1):
        return self.fmu.doStep(cycle * self.step_size, cycles * self.step_size)

    def refuses(self, words, call, *arguments):
        """The call returns fmi3Error, and the logger is told these words."""
        before = len(self.told)
        try:
            call(*arguments)
        except FMICallException as error:
            assert error.status == 3, error
        else:
            raise AssertionError(f"{call} {arguments} was accepted")
        new = self.told[before:]
        assert len(new) == 1 and words in new[0][3], f"told {new} instead of {words!r}"
        assert new[0][1:3] == (3, "logStatusError"), new


def run(*arguments):
    subprocess.run([PROGRAM, *arguments], check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)


def log_of(axis, folder):
    """The columns of what `simulate` makes of the first trajectory."""
    file = Path(folder) / f"{axis}.csv"
    run("simulate", "--axis", f"data/axes/{axis}.toml", "--trajectory", "1", "--log", str(file))
    with open(file, newline="") as rows:
        rows = list(csv.reader(rows))
    return {name: [float(row[i]) for row in rows[1:]] for i, name in enumerate(rows[0])}


def check_validation(fmu, _):
    problems = validate_fmu(str(fmu))
    assert not problems, problems


def check_symbols(fmu, _):
    header = Path(fmpy.__file__).parent / "c-code" / "fmi3Functions.h"
    wanted = re.findall(r"FMI3_Export\s+fmi3\w+TYPE\s+(fmi3\w+)", header.read_text())
    unit = Unit(fmu)
    assert len(wanted) == 75
    missing = [name for name in wanted if not hasattr(unit.fmu.dll, name)]
    assert not missing, missing


def follow(unit, log, first, last):
    """The rows of the drive's channels that the unit makes of the log's references."""
    inputs = [v.valueReference for v in unit.of_causality("input")[:3]]
    references = [log[v.name] for v in unit.of_causality("input")[:3]]
    outputs = [unit.references[name] for name in shared(unit, log)]
    rows = []
    for k in range(first, last):
        unit.fmu.setFloat64(inputs, [reference[k] for reference in references])
        unit.step(k)
        rows.append(unit.fmu.getFloat64(outputs))
    return rows


def shared(unit, log):
    names = [v.name for v in unit.of_causality("output")]
    return [name for name in names if name.startswith("drive.") and name[6:] in log]


def check_run(fmu, log):
    unit = Unit(fmu)
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
    unit = Unit(fmu)
    unit.begin()
    before = follow(unit, log, 0, 300)
    state = unit.fmu.getFMUState()
    first = follow(unit, log, 300, 600)
    unit.fmu.setFMUState(state)
    assert follow(unit, log, 300, 600) == first
    # Another instance takes it up; then the first forgets everything.
    other = Unit(fmu)
    other.fmu.setFMUState(state)
    unit.fmu.freeFMUState(state)
    assert follow(other, log, 300, 600) == first
    unit.fmu.reset()
    unit.begin()
    assert follow(unit, log, 0, 300) == before
    # After an error, too.
    state = unit.fmu.getFMUState()
    unit.set(unit.of_causality("input")[0].name, 1e3)
    unit.refuses("following_error_limit", unit.step, 300)
    unit.fmu.setFMUState(state)
    assert follow(unit, log, 300, 600) == first
    unit.fmu.freeFMUState(state)
    unit.fmu.freeFMUState(ctypes.c_void_p())
    unit.refuses("null", unit.fmu.setFMUState, ctypes.c_void_p())


def check_parameters(fmu, _):
    """One that is set counts, and only before the start; what is out of range is told."""
    unit, plain = Unit(fmu), Unit(fmu)
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
        values.append(one.fmu.getFloat64(outputs))
    assert values[0] != values[1]
    assert unit.get(name) == [0.5 * start]
    unit.refuses("fixed", unit.set, name, start)
    unit.fmu.reset()
    unit.set(name, -1.0)
    unit.fmu.enterInitializationMode()
    unit.refuses("a number from", unit.fmu.exitInitializationMode)


def check_orders(fmu, _):
    unit = Unit(fmu)
    size, slave = unit.step_size, unit.fmu
    unit.refuses("instantiated", unit.step, 0)
    unit.refuses("instantiated", slave.exitInitializationMode)
    unit.refuses("instantiated", slave.terminate)
    slave.enterInitializationMode(stopTime=100 * size)
    unit.refuses("initialization mode", slave.enterInitializationMode)
    unit.refuses("initialization mode", unit.step, 0)
    slave.exitInitializationMode()
    for step in (0.0, -size, float("nan"), float("inf")):
        unit.refuses("above 0", slave.doStep, 0.0, step)
    unit.refuses("where the unit is", slave.doStep, size, size)
    unit.refuses("stop time", slave.doStep, 0.0, 101 * size)
    for reference in (len(unit.references), 2**32 - 1):
        unit.refuses("value reference", slave.getFloat64, [reference])
        unit.refuses("value reference", slave.setFloat64, [reference], [0.0])
    unit.refuses("output", slave.setFloat64, [unit.of_causality("output")[0].valueReference], [0.0])
    unit.refuses("no finite number", slave.setFloat64, [1], [float("nan")])
    one = (ctypes.c_uint * 1)(1)
    two = (ctypes.c_double * 2)()
    unit.refuses("2 values of 1 variables", slave.fmi3GetFloat64, slave.component, one, 1, two, 2)
    assert slave.getFloat64([]) == [] and slave.getInt32([]) == []
    unit.refuses("Float64", slave.getInt32, [1])
    assert unit.step(0)[3] == size, "a refused call left something behind"
    slave.terminate()
    unit.refuses("terminated", slave.terminate)
    unit.refuses("terminated", unit.step, 1)
    unit.refuses("terminated", unit.set, unit.of_causality("input")[0].name, 0.1)
    slave.setDebugLogging(False, ["logStatusError"])
    told = len(unit.told)
    with contextlib.suppress(FMICallException):
        slave.terminate()
    assert len(unit.told) == told
    slave.freeInstance()


def check_absent(fmu, _):
    """Every function of what is not offered says so, whatever it is given."""
    unit = Unit(fmu)
    unit.begin()
    slave, null, count = unit.fmu, ctypes.c_void_p(), ctypes.c_size_t(1)
    number, reference = ctypes.c_double(0.0), ctypes.c_uint(1)
    p, n = null, count
    for name, arguments in {
        "EnterEventMode": [], "EnterStepMode": [], "EvaluateDiscreteStates": [], "UpdateDiscreteStates": [p] * 6,
        "EnterConfigurationMode": [], "ExitConfigurationMode": [],
        "GetNumberOfVariableDependencies": [reference, p], "GetVariableDependencies": [reference, p, p, p, p, n],
        "SerializedFMUStateSize": [p, p], "SerializeFMUState": [p, p, n], "DeserializeFMUState": [p, n, p],
        "GetDirectionalDerivative": [p, n] * 4, "GetAdjointDerivative": [p, n] * 4,
        "GetOutputDerivatives": [p, n, p, p, n], "EnterContinuousTimeMode": [],
        "CompletedIntegratorStep": [ctypes.c_bool(False), p, p], "SetTime": [number],
        "SetContinuousStates": [p, n], "GetContinuousStateDerivatives": [p, n], "GetEventIndicators": [p, n],
        "GetContinuousStates": [p, n], "GetNominalsOfContinuousStates": [p, n],
        "GetNumberOfEventIndicators": [p], "GetNumberOfContinuousStates": [p],
        "ActivateModelPartition": [reference, number], "GetClock": [p, n, p], "SetClock": [p, n, p],
        "GetIntervalDecimal": [p, n, p, p], "GetIntervalFraction": [p, n, p, p, p], "GetShiftDecimal": [p, n, p],
        "GetShiftFraction": [p, n, p, p], "SetIntervalDecimal": [p, n, p], "SetIntervalFraction": [p, n, p, p],
        "SetShiftDecimal": [p, n, p], "SetShiftFraction": [p, n, p, p],
        "GetBinary": [p, n, p, p, n], "SetBinary": [p, n, p, p, n],
        **{f"{way}{kind}": [p, n, p, n]
           for way in ("Get", "Set")
           for kind in ("Float32", "Int8", "UInt8", "Int16", "UInt16", "Int32", "UInt32", "Int64", "UInt64", "Boolean", "String")},
    }.items():
        function = getattr(ctypes.CDLL(slave.dll._name), f"fmi3{name}")
        before = len(unit.told)
        assert function(ctypes.c_void_p(slave.component), *arguments) == 3, name
        assert len(unit.told) == before + 1 and "not offered" in unit.told[-1][3], name
        assert function(null, *arguments) == 3, f"{name} of no instance"
    assert unit.step(0)[3] == unit.step_size


def check_instantiation(fmu, _):
    """Another unit's token, no resources, the other interfaces and event mode give no instance."""
    unit = Unit(fmu, earlyReturnAllowed=True, visible=True, loggingOn=True)
    library = ctypes.CDLL(unit.fmu.dll._name)
    told, environment = [], ctypes.c_void_p(0x1234)
    log = fmi3LogMessageCallback(lambda *message: told.append(message))
    resources = str(Path(unit.folder) / "resources") + "/"
    make = library.fmi3InstantiateCoSimulation
    make.restype = ctypes.c_void_p
    null, token, no, yes = ctypes.c_void_p(), unit.description.guid, ctypes.c_bool(False), ctypes.c_bool(True)

    def instance(token, resources, event_mode, log):
        return make(b"two", token, resources, no, no, event_mode, no, null, ctypes.c_size_t(0), environment, log, null)

    token, resources = token.encode(), resources.encode()
    for words, arguments in {
        "token": (b"{of another unit}", resources, no),
        "no-such-folder": (token, b"/no-such-folder", no),
        "hasEventMode": (token, resources, yes),
        "axis.toml": (None, None, no),
        "instantiation token": (b"\xff\xfe", resources, no),
    }.items():
        assert instance(*arguments, log) is None
        # The environment is given back as it came: importers find themselves by it.
        assert told[-1][0] == 0x1234 and words in told[-1][3].decode(), (words, told[-1])
        assert instance(*arguments, null) is None
    for name, more in (("ModelExchange", []), ("ScheduledExecution", [null] * 3)):
        other = getattr(library, f"fmi3Instantiate{name}")
        other.restype = ctypes.c_void_p
        assert other(b"two", token, resources, no, no, environment, log, *more) is None
        assert "co-simulation alone" in told[-1][3].decode()
    library.fmi3FreeInstance(null)
    library.fmi3GetVersion.restype = ctypes.c_char_p
    assert library.fmi3GetVersion() == b"3.0"


def check_fmpys_own_run(fmu, _):
    """As a user of FMPy runs it, with an early return allowed; event mode is not offered."""
    description = read_model_description(str(fmu))
    size = float(description.coSimulation.fixedInternalStepSize)
    with contextlib.redirect_stdout(io.StringIO()):
        runs = [
            simulate_fmu(str(fmu), stop_time=500 * size, output_interval=10 * size, early_return_allowed=early)
            for early in (False, True)
        ]
    assert len(runs[0]) == 51 and (runs[0] == runs[1]).all()
    try:
        simulate_fmu(str(fmu), stop_time=size, use_event_mode=True, logger=lambda *message: None)
    except Exception as error:  # FMPy raises a plain one.
        assert "instantiate" in str(error), error
    else:
        raise AssertionError("event mode was accepted")


def check_plain_calls(fmu, log):
    """As the first lines of a user are: whatever stop time, whatever output interval, none at all."""
    size = float(read_model_description(str(fmu)).coSimulation.fixedInternalStepSize)
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


def main():
    passed = 0
    checks = [value for name, value in globals().items() if name.startswith("check_")]
    with tempfile.TemporaryDirectory() as folder:
        for axis in AXES:
            fmu = Path(folder) / f"{axis}.fmu"
            run("export", "fmu", "--axis", f"data/axes/{axis}.toml", "--out", str(fmu), "--library", LIBRARY)
            log = log_of(axis, folder)
            for check in checks:
                said = check(fmu, log)
                passed += 1
                print(f"{axis}: {check.__name__[6:].replace('_', ' ')}" + (f": {said}" if said else ""), flush=True)
    print(f"{passed} passed, 0 failed")


main()
