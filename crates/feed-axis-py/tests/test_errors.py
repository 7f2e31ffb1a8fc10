"""What a user gets wrong first: the exception a Python user expects, in words, from every function."""

from collections.abc import Callable
from pathlib import Path

import feed_axis as fa
import numpy as np
import pytest

LIMITS = {"speed_m_s": 0.1, "acceleration_m_s2": 1.0, "jerk_m_s3": 10.0}
# What PyO3 says where it is left to itself, and what no user understands.
FOREIGN = ["not an instance of 'ndarray'", "failed to extract", "Can't extract", 'the extension is ""', "PyErr", "panicked", "defect"]


def refused(kind: type[Exception], words: str, call: Callable[[], object]) -> None:
    with pytest.raises(kind, match=words) as raised:
        call()
    said = str(raised.value)
    assert type(raised.value) is not RuntimeError
    assert not [foreign for foreign in FOREIGN if foreign in said], said


def test_a_file_that_is_not_there_is_python_s_own_error(axis: fa.Axis, tmp_path: Path) -> None:
    gone = tmp_path / "gone"
    calls: list[Callable[[], object]] = [
        lambda: fa.Axis.load(gone),
        lambda: fa.Program.load(gone),
        lambda: fa.Network.load(gone),
        lambda: fa.discover(axis, fit=[gone], check=[gone]),
        lambda: fa.discover(axis, fit=[f"{gone}.csv"], check=[gone]),
        lambda: fa.discover(axis, fit=[f"{gone}.csv+{gone}.mat"], check=[gone]),
    ]
    for call in calls:
        with pytest.raises(FileNotFoundError, match="No such file or directory: '.*gone") as raised:
            call()
        assert str(raised.value.filename).startswith(str(gone)) and raised.value.errno == 2
    for call in (lambda: fa.Axis.load(tmp_path), lambda: fa.discover(axis, fit=[tmp_path], check=[gone])):
        with pytest.raises(IsADirectoryError):
            call()
    network = fa.Network.train([0, 1, 2], [0, 1, 2], hidden=1, epochs=1)
    with pytest.raises(FileNotFoundError, match="gone"):
        network.save(gone / "network")
    gone.write_bytes(b"\xff\xfe\x00")
    refused(fa.AxisError, "begins as UTF-16", lambda: fa.Axis.load(gone))
    refused(fa.MotionError, "begins as UTF-16", lambda: fa.Program.load(gone))
    gone.write_text("start_mm = 600,5\n")
    refused(fa.MotionError, r"decimal point: start_mm = 600\.5", lambda: fa.Program.load(gone))


def test_a_motion_of_a_wrong_kind_is_named(axis: fa.Axis) -> None:
    for wrong in ("abc", None, 0.6, {"t_s": [1]}, object()):
        for call in (
            lambda: axis.simulate(wrong),  # type: ignore[arg-type]  # noqa: B023
            lambda: fa.Compensator(axis, "plan", motion=wrong) if wrong is not None else axis.simulate(wrong),  # type: ignore[arg-type]  # noqa: B023
        ):
            refused(TypeError, "is no motion; valid: a Move, an SCurve", call)
    refused(fa.MotionError, r"distance_m is NaN; valid", lambda: fa.Move(distance_m=np.nan, **LIMITS))


def test_whole_numbers_are_whole_and_in_range(axis: fa.Axis) -> None:
    still = fa.Program.from_toml("start_mm = 600.0\n[[steps]]\ndwell = { duration_s = 0.01 }")
    assert axis.simulate(still, seed=np.int64(3)).cycles == axis.simulate(still, seed=np.uint8(3)).cycles
    beam = fa.Beam(length_m=1, diameter_m=0.04)
    calls: list[tuple[str, Callable[[int], object]]] = [
        ("seed", lambda n: axis.simulate(still, seed=n)),
        ("seed", lambda n: axis.identify_friction(seed=n)),
        ("count", lambda n: axis.sample(n)),
        ("count", lambda n: beam.frequencies_hz(n)),
        ("elements", lambda n: fa.Beam(length_m=1, diameter_m=0.04, elements=n)),
        ("n", lambda n: fa.latin_hypercube(n, [(0, 1)])),
        ("epochs", lambda n: fa.Network.train([1, 2], [1, 2], epochs=n)),
        ("threads", lambda n: fa.Network.train([1, 2], [1, 2], threads=n)),
    ]
    for name, call in calls:
        for bad in (-1, 10**30):
            refused(ValueError, f"^{name} is {bad}; valid: a whole number from 0 to", lambda: call(bad))  # noqa: B023
        refused(TypeError, "'float' object cannot be interpreted as an integer", lambda: call(1.5))  # type: ignore[arg-type]  # noqa: B023
    refused(ValueError, "^count is .*; valid", lambda: axis.sample(10**13))


def test_lists_of_names_and_logs_are_lists(axis: fa.Axis, run: fa.Run) -> None:
    def found(**words: object) -> object:
        return fa.discover(axis, fit=[run], check=[run], **words)  # type: ignore[arg-type]

    refused(TypeError, "'backlash' is one name; valid: a list of names", lambda: found(accept="backlash"))
    refused(TypeError, "a int is no name; valid: a list of names", lambda: found(reject=[3]))
    refused(TypeError, "a int is no list; valid: a list of names", lambda: found(reject=3))
    refused(fa.LogError, "fit holds no log; valid: one at least", lambda: fa.discover(axis, fit=[], check=[run]))
    refused(fa.LogError, "check holds no log", lambda: fa.discover(axis, fit=[run], check=[]))
    refused(TypeError, "progress is a int; valid: a function", lambda: axis.simulate(axis.trajectories[0], progress=3))  # type: ignore[arg-type]
    refused(TypeError, "fit 1 has the key 3; valid: strings", lambda: fa.discover(axis, fit=[{"t_s": [1], 3: [2]}], check=[run]))  # type: ignore[dict-item]
    refused(TypeError, "a dict of an axis has the key 1; valid: strings", lambda: fa.Axis.from_dict({1: 2}))  # type: ignore[dict-item]


def test_columns_say_what_they_lack(axis: fa.Axis, run: fa.Run) -> None:
    table = {"time": run["t_s"], "x": run["position_m"]}

    def found(columns: object) -> object:
        return fa.discover(axis, fit=[table], check=[run], columns=columns)  # type: ignore[arg-type]

    refused(fa.LogError, 'fit 1 has no column "y", of which columns speaks; it has: time, x', lambda: found({"y": "t_s"}))
    refused(fa.LogError, "no channel \"position_ref_m\"", lambda: found({"time": "t_s", "x": "position_m"}))
    refused(fa.LogError, "no known unit suffix", lambda: found({"time": "t_s", "x": "position"}))
    refused(fa.LogError, "no known unit suffix.*columns=", lambda: found({}))
    for wrong in ("t_s", ["t_s"], {"time": 3}, {"time": ("t_s", "a")}):
        refused(TypeError, r"valid: a dict from column to channel, or to \(channel, factor\)", lambda: found(wrong))  # noqa: B023


def test_what_is_masked_is_a_hole() -> None:
    network = fa.Network.train([-1, 0, 1], [-1, 0, 1], hidden=1, epochs=5)
    given = np.ma.masked_array([0.5, 7.0, -0.5], mask=[False, True, False])
    predicted = network.predict(given)
    assert np.isnan(predicted[1, 0])
    assert np.array_equal(predicted[[0, 2]], network.predict([0.5, -0.5]))
    whole = np.ma.masked_array([1, 7, 2], mask=[False, True, False])
    refused(fa.NetworkError, "input values.1. is NaN", lambda: fa.Network.train(whole, [1, 2, 3]))
    law = fa.LuGre.liu2025()
    assert np.isnan(law.steady_state(given)[1])


def test_missing_values_of_pandas_are_holes() -> None:
    pandas = pytest.importorskip("pandas")
    law = fa.LuGre.liu2025()
    for kind in ("Int64", "Float64", "Float32"):
        given = pandas.Series([1, None, 2], dtype=kind)
        torque = law.steady_state(given)
        assert np.isnan(torque[1]) and np.array_equal(torque[[0, 2]], law.steady_state([1, 2]))


def test_a_noise_is_a_factor(axis: fa.Axis) -> None:
    for bad in (-1.0, float("nan"), float("inf")):
        refused(ValueError, "^noise is", lambda: axis.simulate(axis.trajectories[0], noise=bad))  # noqa: B023
        refused(ValueError, "^noise is", lambda: axis.identify_friction(noise=bad))  # noqa: B023
