"""Units in FMPy: an instance of either version, and what a run is compared with."""

import csv
import ctypes
import json
import math
import shutil
import subprocess
import tomllib
from pathlib import Path

import fmpy
from fmpy import extract, read_model_description
from fmpy.fmi1 import FMICallException
from fmpy.fmi2 import (
    FMU2Slave,
    fmi2CallbackFunctions,
    fmi2CallbackLoggerTYPE,
)
from fmpy.fmi3 import FMU3Slave
from fmpy.logging import addLoggerProxy


class Unit:
    """An instance, its variables by name, and what its logger was told."""

    def __init__(self, fmu, **options):
        self.folder = extract(str(fmu))
        self.description = read_model_description(str(fmu))
        self.told = []
        self.references = {v.name: v.valueReference for v in self.description.modelVariables}
        self.step_size = float(self.description.defaultExperiment.stepSize)
        self.fmu = self.Slave(
            guid=self.description.guid,
            unzipDirectory=self.folder,
            modelIdentifier=self.description.coSimulation.modelIdentifier,
            instanceName="one",
        )
        self.instantiate(**options)

    @staticmethod
    def of(fmu, **options):
        """Of the version that the file is of."""
        version = read_model_description(str(fmu)).fmiVersion
        return (Unit2 if version == "2.0" else Unit3)(fmu, **options)

    def of_causality(self, causality):
        return [v for v in self.description.modelVariables if v.causality == causality]

    def begin(self, **options):
        self.enter(**options)
        self.fmu.exitInitializationMode()

    def get(self, *names):
        return self.read([self.references[name] for name in names])

    def set(self, name, value):
        self.write([self.references[name]], [value])

    def step(self, cycle, cycles=1):
        return self.fmu.doStep(cycle * self.step_size, cycles * self.step_size)

    def refuses(self, words, call, *arguments, status=3, category="logStatusError"):
        """The call returns an error, and the logger is told these words."""
        before = len(self.told)
        try:
            call(*arguments)
        except FMICallException as error:
            assert error.status == status, error
        else:
            raise AssertionError(f"{call} {arguments} was accepted")
        new = self.told[before:]
        assert len(new) == 1 and words in new[0][3], f"told {new} instead of {words!r}"
        assert new[0][1:3] == (status, category), new


class Unit3(Unit):
    """By FMI 3.0."""

    Slave = FMU3Slave
    enter = property(lambda self: self.fmu.enterInitializationMode)
    read = property(lambda self: self.fmu.getFloat64)
    write = property(lambda self: self.fmu.setFloat64)
    save = property(lambda self: self.fmu.getFMUState)
    restore = property(lambda self: self.fmu.setFMUState)
    free = property(lambda self: self.fmu.freeFMUState)
    to_bytes = property(lambda self: self.fmu.serializeFMUState)
    of_bytes = property(lambda self: self.fmu.deserializeFMUState)

    def instantiate(self, **options):
        self.fmu.instantiate(logMessage=self.log, **options)

    def log(self, environment, status, category, message):
        self.told.append((environment, status, category.decode(), message.decode()))


class Unit2(Unit):
    """By FMI 2.0; FMPy's logger makes the texts of the formats and what follows them."""

    Slave = FMU2Slave
    read = property(lambda self: self.fmu.getReal)
    write = property(lambda self: self.fmu.setReal)
    save = property(lambda self: self.fmu.getFMUstate)
    restore = property(lambda self: self.fmu.setFMUstate)
    free = property(lambda self: self.fmu.freeFMUstate)
    to_bytes = property(lambda self: self.fmu.serializeFMUstate)
    of_bytes = property(lambda self: self.fmu.deSerializeFMUstate)

    def instantiate(self, **options):
        self.fmu.instantiate(callbacks=callbacks(self.log), **options)

    def enter(self, **options):
        self.fmu.setupExperiment(**options)
        self.fmu.enterInitializationMode()

    def log(self, environment, name, status, category, message):
        assert name == b"one"
        self.told.append((environment, status, category.decode(), message.decode()))


LISTENERS = {}  # by environment: FMPy's proxy knows one logger in a process


@fmi2CallbackLoggerTYPE
def heard(environment, *message):
    LISTENERS[environment](environment, *message)


def callbacks(log):
    """fmi2CallbackFunctions with this logger; what is only for asynchronous steps is null."""
    functions = fmi2CallbackFunctions()
    functions.logger = heard
    addLoggerProxy(ctypes.byref(functions))
    functions.componentEnvironment = 0x1000 + len(LISTENERS)
    LISTENERS[functions.componentEnvironment] = log
    return functions


def run(program, *arguments):
    subprocess.run([program, *arguments], check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)


def told(program, *arguments):
    """What the program says, in JSON."""
    said = subprocess.run([program, *arguments, "--format", "json"], check=True, capture_output=True)
    return json.loads(said.stdout)


def log_of(program, axis, folder):
    """The columns of what `simulate` makes of the first trajectory."""
    file = Path(folder) / f"{axis}.csv"
    run(program, "simulate", "--axis", f"data/axes/{axis}.toml", "--trajectory", "1", "--log", str(file))
    return columns(file)


def late_log_of(program, axis, folder, compensation, start, standstill):
    """The same of the trajectory after a standstill (s), compensated."""
    with open(f"data/axes/{axis}.toml", "rb") as file:
        move = tomllib.load(file)["trajectory"][0]
    unit = "mm" if "displacement_mm" in move else "deg"
    start = 1e3 * start if unit == "mm" else math.degrees(start)
    names = {f"speed_{unit}_per_s": f"velocity_{unit}_s"}
    keys = {names.get(key, key.replace("_per_", "_")): value for key, value in move.items()}
    keys[f"to_{unit}"] = start + keys.pop(f"displacement_{unit}")
    program_file, file = (Path(folder) / f"{axis}-{compensation}.{end}" for end in ("toml", "csv"))
    inner = ", ".join(f"{key} = {value!r}" for key, value in keys.items())
    steps = f"[[steps]]\ndwell = {{ duration_s = {standstill!r} }}\n[[steps]]\nmove = {{ {inner} }}\n"
    program_file.write_text(f"start_{unit} = {start!r}\n{steps}")
    arguments = ["--axis", f"data/axes/{axis}.toml", "--compensation", compensation, "--program", str(program_file)]
    run(program, "simulate", *arguments, "--log", str(file))
    return columns(file)


def columns(file):
    with open(file, newline="") as rows:
        rows = list(csv.reader(rows))
    return {name: [float(row[i]) for row in rows[1:]] for i, name in enumerate(rows[0])}


def follow(unit, log, first, last):
    """The rows of the drive's channels that the unit makes of the log's references."""
    inputs = [v.valueReference for v in unit.of_causality("input")[:3]]
    references = [log[v.name] for v in unit.of_causality("input")[:3]]
    outputs = [unit.references[name] for name in shared(unit, log)]
    rows = []
    for k in range(first, last):
        unit.write(inputs, [reference[k] for reference in references])
        unit.step(k)
        rows.append(unit.read(outputs))
    return rows


def shared(unit, log):
    names = [v.name for v in unit.of_causality("output")]
    return [name for name in names if name.startswith("drive.") and name[6:] in log]


def in_c(unit, version):
    """A program in C by the standard's own headers: signatures, the logger, states as bytes. Under valgrind if it is there."""
    if shutil.which("cc") is None:
        with open("target/skipped-tests", "a") as skipped:
            skipped.write("program\tcc\t.ci/fmu: a program in C takes a unit\n")
        return "left out: no C compiler"
    headers = Path(fmpy.__file__).parent / "c-code"
    library, program = unit.fmu.dll._name, Path(unit.folder) / "importer"
    flags = ["-std=c99", "-Wall", "-Wextra", "-Werror", "-O2", f"-I{headers}", "-o", program]
    subprocess.run(["cc", *flags, Path(__file__).with_name(f"fmu{version}.c"), library], check=True)
    size, input = 10.4 * unit.step_size, unit.of_causality("input")[0]
    output = unit.of_causality("output")[0].valueReference
    folder = Path(unit.folder) / "resources"
    resources = folder.as_uri() if version == 2 else str(folder)
    valgrind = ["valgrind", "-q", "--leak-check=full", "--error-exitcode=9"] if shutil.which("valgrind") else []
    call = [*valgrind, program, unit.description.guid, resources, repr(size), str(input.valueReference), str(output)]
    said = subprocess.run(call, check=True, stdout=subprocess.PIPE, text=True).stdout
    rows = [float(line) for line in said.split()]
    unit.begin()
    unit.set(input.name, float(input.start) + 1e-4)
    expected = []
    for k in range(20):
        unit.fmu.doStep(k * size, size)
        expected += unit.read([output])
    assert rows == expected + expected[10:], (rows, expected)
    return "under valgrind" if valgrind else None
