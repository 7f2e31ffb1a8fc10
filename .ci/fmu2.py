"""Checks of what is FMI 2.0's alone."""

import contextlib
import ctypes
import re
from pathlib import Path

import fmpy
from fmpy.fmi1 import FMICallException
from fmpy.fmi2 import fmi2CallbackFunctions, fmi2DoStepStatus, fmi2LastSuccessfulTime, fmi2PendingStatus, fmi2Terminated
from fmu_unit import Unit2, callbacks, in_c

# Of fmi2Functions.h, functions for model exchange alone.
MODEL_EXCHANGE = {
    "fmi2EnterEventMode", "fmi2NewDiscreteStates", "fmi2EnterContinuousTimeMode", "fmi2CompletedIntegratorStep",
    "fmi2SetTime", "fmi2SetContinuousStates", "fmi2GetDerivatives", "fmi2GetEventIndicators",
    "fmi2GetContinuousStates", "fmi2GetNominalsOfContinuousStates",
}


def check_symbols(fmu, _):
    header = Path(fmpy.__file__).parent / "c-code" / "fmi2Functions.h"
    named = re.findall(r"FMI2_Export\s+fmi2\w+TYPE\s+(fmi2\w+)", header.read_text())
    wanted = [name for name in named if name not in MODEL_EXCHANGE]
    assert (len(named), len(wanted)) == (44, 34)
    unit = Unit2(fmu)
    missing = [name for name in wanted if not hasattr(unit.fmu.dll, name)]
    assert not missing, missing
    assert unit.fmu.getVersion() == "2.0" and unit.fmu.getTypesPlatform() == "default"


def check_orders(fmu, _):
    unit = Unit2(fmu)
    size, slave = unit.step_size, unit.fmu
    unit.refuses("instantiated", unit.step, 0)
    unit.refuses("instantiated", slave.exitInitializationMode)
    unit.refuses("instantiated", slave.terminate)
    unit.refuses("stop time", lambda: slave.setupExperiment(startTime=1.0, stopTime=0.5))
    slave.setupExperiment(stopTime=100 * size)
    slave.enterInitializationMode()
    unit.refuses("initialization mode", slave.setupExperiment)
    unit.refuses("initialization mode", slave.enterInitializationMode)
    unit.refuses("initialization mode", unit.step, 0)
    slave.exitInitializationMode()
    for step in (0.0, -size, float("nan"), float("inf")):
        unit.refuses("above 0", slave.doStep, 0.0, step)
    unit.refuses("where the unit is", slave.doStep, size, size)
    unit.refuses("stop time", slave.doStep, 0.0, 101 * size)
    for reference in (len(unit.references), 2**32 - 1):
        unit.refuses("value reference", slave.getReal, [reference])
        unit.refuses("value reference", slave.setReal, [reference], [0.0])
    unit.refuses("output", slave.setReal, [unit.of_causality("output")[0].valueReference], [0.0])
    unit.refuses("no finite number", slave.setReal, [1], [float("nan")])
    one, two, null = (ctypes.c_uint * 1)(1), (ctypes.c_double * 1)(), None
    for call in (slave.fmi2GetReal, slave.fmi2SetReal):
        unit.refuses("null", call, slave.component, null, 1, two)
        unit.refuses("null", call, slave.component, one, 1, null)
        call(slave.component, null, 0, null)
    assert slave.getReal([]) == [] and slave.getInteger([]) == []
    unit.refuses("Real", slave.getInteger, [1])
    unit.step(0)
    assert slave.getRealStatus(fmi2LastSuccessfulTime) == size, "a refused call left something behind"
    slave.terminate()
    unit.refuses("terminated", slave.terminate)
    unit.refuses("terminated", unit.step, 1)
    unit.refuses("terminated", unit.set, unit.of_causality("input")[0].name, 0.1)
    slave.reset()
    slave.enterInitializationMode()  # Without a set-up: from 0 on, without an end.
    slave.exitInitializationMode()
    unit.step(0, 500)
    slave.terminate()
    slave.setDebugLogging(False, ["logStatusError"])
    told = len(unit.told)
    with contextlib.suppress(FMICallException):
        slave.terminate()
    assert len(unit.told) == told
    slave.freeInstance()


def check_values_of_many(fmu, _):
    """An array of all variables is read and written as its elements are, in any order."""
    unit = Unit2(fmu)
    unit.begin()
    unit.step(0, 20)
    references = list(unit.references.values())[::-1]
    together = unit.fmu.getReal(references)
    assert together == [unit.fmu.getReal([reference])[0] for reference in references]
    inputs = [v.valueReference for v in unit.of_causality("input")]
    values = [0.5 + i for i in range(len(inputs))]
    unit.fmu.setReal(inputs, values)
    assert unit.fmu.getReal(inputs[::-1]) == values[::-1]


def check_status(fmu, _):
    """Steps are over when they return, and a run that is given up says so."""
    unit = Unit2(fmu)
    unit.begin()
    slave = unit.fmu
    unit.step(0, 3)
    status = ctypes.c_int(-1)
    slave.fmi2GetStatus(slave.component, fmi2DoStepStatus, ctypes.byref(status))
    assert status.value == 0
    assert abs(slave.getRealStatus(fmi2LastSuccessfulTime) - 3 * unit.step_size) < 1e-15
    assert slave.getBooleanStatus(fmi2Terminated) is False
    discarded = {"status": 2, "category": "logStatusDiscard"}
    for call, kind in (
        (slave.getIntegerStatus, fmi2DoStepStatus),
        (slave.getStringStatus, fmi2PendingStatus),
        (slave.getRealStatus, fmi2Terminated),
        (slave.getBooleanStatus, 77),
    ):
        unit.refuses("no step goes on", call, kind, **discarded)
    unit.refuses("no step goes on", slave.fmi2GetStatus, slave.component, fmi2DoStepStatus, None, **discarded)
    unit.refuses("canRunAsynchronuously", slave.cancelStep)
    unit.set(unit.of_causality("input")[0].name, 1e3)
    unit.refuses("following_error_limit", unit.step, 3)
    slave.fmi2GetStatus(slave.component, fmi2DoStepStatus, ctypes.byref(status))
    assert status.value == 3 and slave.getBooleanStatus(fmi2Terminated) is True


def check_absent(fmu, _):
    """Every function of what is not offered says so, whatever it is given; none minds that there is no instance."""
    unit = Unit2(fmu)
    unit.begin()
    slave, p, n, library = unit.fmu, ctypes.c_void_p(), ctypes.c_size_t(1), ctypes.CDLL(unit.fmu.dll._name)
    for name, arguments in {
        **{f"{way}{kind}": [p, n, p] for way in ("Get", "Set") for kind in ("Integer", "Boolean", "String")},
        "GetDirectionalDerivative": [p, n, p, n, p, p], "SetRealInputDerivatives": [p, n, p, p],
        "GetRealOutputDerivatives": [p, n, p, p], "CancelStep": [],
    }.items():
        function = getattr(library, f"fmi2{name}")
        before = len(unit.told)
        assert function(ctypes.c_void_p(slave.component), *arguments) == 3, name
        assert len(unit.told) == before + 1 and "not offered" in unit.told[-1][3], name
        assert function(p, *arguments) == 3, f"{name} of no instance"
    number, whole = ctypes.c_double(0.0), ctypes.c_int(0)
    for name, arguments in {
        "GetReal": [p, n, p], "SetReal": [p, n, p], "SetDebugLogging": [whole, n, p],
        "SetupExperiment": [whole, number, number, whole, number], "EnterInitializationMode": [],
        "ExitInitializationMode": [], "Terminate": [], "Reset": [], "DoStep": [number, number, whole],
        "GetFMUstate": [p], "SetFMUstate": [p], "FreeFMUstate": [p],
        "SerializedFMUstateSize": [p, p], "SerializeFMUstate": [p, p, n], "DeSerializeFMUstate": [p, n, p],
        **{f"Get{kind}Status": [whole, p] for kind in ("", "Real", "Integer", "Boolean", "String")},
    }.items():
        assert getattr(library, f"fmi2{name}")(p, *arguments) == 3, f"{name} of no instance"
    library.fmi2FreeInstance(p)
    unit.step(0)


def check_instantiation(fmu, _):
    """Another unit's GUID, no resources and model exchange give no instance; percent signs are no formats."""
    unit = Unit2(fmu, visible=True, loggingOn=True)
    library, told = ctypes.CDLL(unit.fmu.dll._name), []
    functions = callbacks(lambda *message: told.append(message))
    make = library.fmi2Instantiate
    make.restype = ctypes.c_void_p
    resources = (Path(unit.folder) / "resources").as_uri()
    null, no = ctypes.c_void_p(), ctypes.c_int(0)
    guid, resources = unit.description.guid.encode(), resources.encode()
    for words, (kind, *arguments) in {
        "GUID": (1, b"{of another unit}", resources),
        "/no-such%s-folder%n": (1, guid, b"file:///no-such%25s-folder%25n"),
        "no file": (1, guid, b"https://example.org/resources"),
        "axis.toml": (1, None, None),
        "the instantiation token": (1, b"\xff\xfe", resources),
        "co-simulation alone": (0, guid, resources),
    }.items():
        assert make(b"two %d", ctypes.c_int(kind), *arguments, ctypes.byref(functions), no, no) is None
        # The environment is given back as it came: importers find themselves by it.
        assert told[-1][:4] == (functions.componentEnvironment, b"two %d", 3, b"logStatusError"), told[-1]
        assert words in told[-1][4].decode(), (words, told[-1])
        assert make(b"two", ctypes.c_int(kind), *arguments, null, no, no) is None
        assert make(b"two", ctypes.c_int(kind), *arguments, ctypes.byref(fmi2CallbackFunctions()), no, no) is None
    # A path, too, and no logger: an instance nevertheless, whose errors nobody hears.
    folder = (str(Path(unit.folder) / "resources")).encode()
    silent = ctypes.c_void_p(make(None, ctypes.c_int(1), guid, folder, null, no, no))
    assert silent.value and library.fmi2ExitInitializationMode(silent) == 3
    library.fmi2FreeInstance(silent)


def check_a_program_in_c(fmu, _):
    """With a variadic logger."""
    return in_c(Unit2(fmu), 2)
