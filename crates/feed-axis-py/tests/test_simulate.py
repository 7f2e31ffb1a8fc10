"""Runs: numbers known elsewhere, memory, frames."""

import csv
import sys
from collections.abc import Callable
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


def test_positions_of_one_s_own_are_followed(axis: fa.Axis, run: fa.Run) -> None:
    start, move = axis.stroke[2], axis.trajectories[0]
    limits = {"speed_m_s": move.speed_m_s, "acceleration_m_s2": move.acceleration_m_s2, "jerk_m_s3": move.jerk_m_s3}
    curve = fa.SCurve(start, start + move.distance_m, **limits)
    whole = axis.simulate(curve)
    samples = curve.sample(axis.period_s)
    positions = samples["position_m"]
    later = samples["t_s"] + 7.5
    coarse = curve.sample(10 * axis.period_s)
    for given in (
        positions,
        positions.tolist(),
        (later, positions),
        (later.tolist(), positions[::-1][::-1]),
        (coarse["t_s"], coarse["position_m"]),
    ):
        again = axis.simulate(given)
        count = min(again.cycles, whole.cycles)
        assert abs(again.cycles - whole.cycles) <= 10
        # The spline is off the curve's corners of jerk alone, and there by next to nothing.
        assert np.abs(again["position_ref_m"][:count] - whole["position_ref_m"][:count]).max() < 2e-9
        assert abs(again.max_error - 54.453e-6) < 0.05e-6
    frame = axis.simulate(positions.astype(np.float32))
    assert np.abs(frame["position_ref_m"][: len(positions)] - positions).max() < 1e-7
    plan = fa.Compensator(axis, "plan", motion=positions)
    assert plan.strategy == "plan"
    assert axis.simulate(positions, compensation=plan).max_error < 0.5 * run.max_error


def test_positions_that_are_no_motion_are_refused(axis: fa.Axis) -> None:
    flat = np.full(50, 0.6)
    stamps = np.arange(50) * 1e-3
    jittered = stamps + 1e-4 * (np.arange(50) % 2)
    refused: list[tuple[object, str]] = [
        ([0.6], "there are 1 positions; valid: two"),
        ([0.6, np.nan, 0.6], r"positions\[1\] is NaN; valid: finite"),
        (np.ma.masked_array(flat, mask=flat < 0) * np.where(stamps == 0.003, np.inf, 1), r"positions\[3\] is inf"),
        ((stamps[1:], flat), "49 instants t_s and 50 positions"),
        ((stamps[::-1], flat), "t_s does not rise"),
        ((jittered, flat), r"t_s\[1\] is .*, off the even grid .* valid: instants evenly apart"),
        (np.c_[stamps, flat], r"positions has the shape \(50, 2\)"),
    ]
    for given, words in refused:
        with pytest.raises(fa.MotionError, match=words):
            axis.simulate(given)  # type: ignore[arg-type]


def test_a_table_that_turns_follows_angles(root: Path) -> None:
    table = fa.Axis.load(root / "data/axes/rotary-table.toml")
    curve = fa.SCurve.turn(0.0, 0.05, speed_rad_s=1.0, acceleration_rad_s2=5.0, jerk_rad_s3=50.0)
    run = table.simulate(curve.sample(table.period_s)["position_rad"])
    assert abs(run.max_error / table.simulate(curve).max_error - 1) < 1e-3


def test_a_run_cannot_be_written_to(run: fa.Run) -> None:
    before = run["position_m"].copy()
    with pytest.raises(ValueError, match="read-only"):
        run["position_m"] -= 0.6
    with pytest.raises(ValueError, match="read-only"):
        run.error[0] = 1.0
    assert np.array_equal(run["position_m"], before)
    mine = run["position_m"].copy()
    mine -= 0.6


def test_a_plot_has_what_was_asked_for(run: fa.Run, axis: fa.Axis) -> None:
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    axes = run.plot()
    assert axes.get_ylabel() == "tracking error (µm)" and axes.get_xlabel() == "time (s)"
    assert np.allclose(axes.lines[0].get_ydata(), 1e6 * run.error)
    both = run.plot("position_ref_m", "position_m", ax=axes)
    assert both is axes and len(axes.lines) == 3 and axes.get_ylabel() == "m"
    with pytest.raises(KeyError, match="position_m"):
        run.plot("position")


@pytest.mark.parametrize("package", ["matplotlib", "pandas", "polars"])
def test_what_is_not_installed_says_how_it_comes(run: fa.Run, package: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, package, None)
    calls: dict[str, Callable[[], object]] = {
        "matplotlib": run.plot,
        "pandas": run.to_pandas,
        "polars": run.to_polars,
    }
    with pytest.raises(ImportError, match=f"needs {package}; install it: pip install {package}"):
        calls[package]()
