"""Runs: numbers known elsewhere, memory, frames."""

import csv
from pathlib import Path

import feed_axis as fa
import numpy as np
import pytest


def test_trajectory_1_has_the_independent_program_s_errors(run: fa.Run) -> None:
    # Converged, by a program that shares no code: 54.453 and 5.3491 µm.
    assert abs(run.max_error - 54.453e-6) < 0.02e-6
    assert abs(run.mean_error - 5.3491e-6) < 0.005e-6


def test_trajectory_1_is_the_golden_one_every_millisecond(run: fa.Run, root: Path) -> None:
    golden = root.parent / "shared/golden/trajectory1_published.csv"
    if not golden.exists():
        pytest.skip("shared golden/trajectory1_published.csv")
    with golden.open() as file:
        rows = list(csv.DictReader(file))
    for name, most in [("position_m", 0.05e-6), ("position_ref_m", 1e-11)]:
        there = np.array([float(row[name]) for row in rows])
        assert np.abs(run[name][::10][: len(there)] - there).max() < most


def test_a_channel_is_the_same_memory_each_time_and_rust_s(run: fa.Run) -> None:
    first, second = run["position_m"], run["position_m"]
    assert first is second
    # Not NumPy's own memory: the array stands on what Rust allocated.
    assert not first.flags.owndata and first.base is not None
    assert len(first) == run.cycles
    assert run.error is run.error


def test_memory_outlives_its_run(axis: fa.Axis) -> None:
    still = fa.Program.from_toml("start_mm = 600.0\n[[steps]]\ndwell = { duration_s = 0.1 }")
    position = axis.simulate(still)["position_m"]
    for _ in range(3):
        axis.simulate(still)
    assert np.abs(position - 0.6).max() < 1e-12


def test_a_run_is_a_mapping_with_units(run: fa.Run, axis: fa.Axis) -> None:
    assert list(run) == run.keys() == axis.channels and len(run) == len(axis.channels)
    assert run.units["position_m"] == "m" and run.units["motor_speed_rad_s"] == "rad/s"
    assert "position_m" in run and "position" not in run
    with pytest.raises(KeyError, match="position_m"):
        run["position"]
    assert "µm" in repr(run) and "<th>channel</th>" in run._repr_html_()


def test_pandas_holds_the_channels(run: fa.Run) -> None:
    pandas = pytest.importorskip("pandas")
    frame = run.to_pandas()
    assert isinstance(frame, pandas.DataFrame) and list(frame.columns) == run.keys()
    assert np.array_equal(frame["position_m"].to_numpy(), run["position_m"])


def test_polars_holds_the_channels(run: fa.Run) -> None:
    polars = pytest.importorskip("polars")
    frame = run.to_polars()
    assert isinstance(frame, polars.DataFrame) and frame.columns == run.keys()
    assert np.array_equal(frame["iq_a"].to_numpy(), run["iq_a"])


def test_noise_is_that_of_its_seed(axis: fa.Axis) -> None:
    still = fa.Program.from_toml("start_mm = 600.0\n[[steps]]\ndwell = { duration_s = 0.2 }")
    runs = [axis.simulate(still, noise=1.0, seed=seed)["motor_speed_rad_s"] for seed in (1, 1, 2)]
    assert np.array_equal(runs[0], runs[1]) and not np.array_equal(runs[0], runs[2])
    for noise in (-1.0, float("nan")):
        with pytest.raises(ValueError, match="noise is"):
            axis.simulate(still, noise=noise)


def test_a_run_that_fails_says_when_and_why(axis: fa.Axis) -> None:
    far = fa.Move(distance_m=5, speed_m_s=0.3, acceleration_m_s2=1, jerk_m_s3=10)
    with pytest.raises(fa.SimulationError, match="the load left its stroke"):
        axis.simulate(far)
