"""Checks of what is FMI 3.0's alone."""

import contextlib
import ctypes
import io
import re
from pathlib import Path

import fmpy
from fmpy import read_model_description, simulate_fmu
from fmpy.fmi1 import FMICallException
from fmpy.fmi3 import fmi3LogMessageCallback
from fmu_unit import Unit3, in_c


def check_symbols(fmu, _):
    header = Path(fmpy.__file__).parent / "c-code" / "fmi3Functions.h"
    wanted = re.findall(r"FMI3_Export\s+fmi3\w+TYPE\s+(fmi3\w+)", header.read_text())
    unit = Unit3(fmu)
    assert len(wanted) == 75
    missing = [name for name in wanted if not hasattr(unit.fmu.dll, name)]
    assert not missing, missing


def check_orders(fmu, _):
    unit = Unit3(fmu)
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
    unit = Unit3(fmu)
    unit.begin()
    slave, null, count = unit.fmu, ctypes.c_void_p(), ctypes.c_size_t(1)
    number, reference = ctypes.c_double(0.0), ctypes.c_uint(1)
    p, n = null, count
    for name, arguments in {
        "EnterEventMode": [], "EnterStepMode": [], "EvaluateDiscreteStates": [], "UpdateDiscreteStates": [p] * 6,
        "EnterConfigurationMode": [], "ExitConfigurationMode": [],
        "GetNumberOfVariableDependencies": [reference, p], "GetVariableDependencies": [reference, p, p, p, p, n],
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
    unit = Unit3(fmu, earlyReturnAllowed=True, visible=True, loggingOn=True)
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


def check_a_program_in_c(fmu, _):
    return in_c(Unit3(fmu), 3)
