"""Axes and motions: the same from a file and from a dict, numbers known elsewhere."""

from pathlib import Path

import feed_axis as fa
import numpy as np
import pytest


def test_a_dict_gives_the_same_axis(axis: fa.Axis) -> None:
    values = axis.to_dict()
    assert fa.Axis.from_dict(values).fingerprint == axis.fingerprint
    values["mechanism"]["table_mass_kg"] = 600
    assert fa.Axis.from_dict(values).fingerprint != axis.fingerprint
    values["mechanism"]["table_mass_kg"] = object()
    with pytest.raises(TypeError, match="table_mass_kg"):
        fa.Axis.from_dict(values)


def test_every_axis_of_the_project_comes_back_from_its_dict(root: Path) -> None:
    paths = sorted((root / "data/axes").glob("*.toml"))
    assert len(paths) > 10
    for path in paths:
        axis = fa.Axis.load(path)
        again = fa.Axis.from_dict(axis.to_dict())
        assert again.fingerprint == axis.fingerprint, path


def test_the_table_swings_on_the_nut(axis: fa.Axis) -> None:
    # The table on the nut at 62 Hz (the specification of the axis), the motor against the
    # screw, and two of the screw's torsion (docs/theory/feed-dynamics.md), to the last digit.
    expected = np.array([62.80, 139.04, 1039.12, 1229.87])
    found = axis.frequencies_hz(0.6)[:4]
    assert np.allclose(found, expected, rtol=0, atol=0.0051)
    assert np.array_equal(axis.frequencies_hz(), axis.frequencies_hz(axis.stroke[2]))
    with pytest.raises(fa.ParameterError, match="1.5"):
        axis.frequencies_hz(2.0)


def test_an_s_curve_takes_the_time_of_its_closed_form() -> None:
    curve = fa.SCurve(0.6, 0.9, speed_m_s=0.1, acceleration_m_s2=0.225, jerk_m_s3=1.2)
    assert abs(curve.duration_s - (0.3 / 0.1 + 0.1 / 0.225 + 0.225 / 1.2)) < 1e-12
    samples = curve.sample(1e-3)
    way = np.sum(samples["speed_m_s"]) * 1e-3  # rest at both ends: the rule of trapezia
    assert abs(way - 0.3) < 1e-4


def test_a_program_comes_back_from_its_text(tmp_path: Path) -> None:
    text = 'start_mm = 600.0\n[[steps]]\ndwell = { duration_s = 0.25 }\n'
    program = fa.Program.from_toml(text)
    assert program.duration_s == 0.25
    path = tmp_path / "program.toml"
    path.write_text(program.to_toml())
    again = fa.Program.load(path).sample(0.05)
    assert again["t_s"].size == 6 and np.all(again["position_m"] == 0.6)


def test_errors_have_the_library_s_words(axis: fa.Axis, tmp_path: Path) -> None:
    text = axis.to_toml()
    with pytest.raises(fa.AxisError, match="did you mean `lead_mm`"):
        fa.Axis.from_toml(text.replace("lead_mm", "laed_mm"))
    with pytest.raises(FileNotFoundError, match="none.toml"):
        fa.Axis.load(tmp_path / "none.toml")
    with pytest.raises(fa.MotionError, match="velocity is -1 m/s"):
        fa.Move(distance_m=1, speed_m_s=-1, acceleration_m_s2=1, jerk_m_s3=1)
    with pytest.raises(fa.MotionError, match="period_s"):
        fa.Program.from_toml("start_mm = 0.0\nsteps = []").sample(0.0)
    turning = fa.Program.from_toml("start_deg = 30.0\n[[steps]]\ndwell = { duration_s = 0.1 }")
    with pytest.raises(fa.MotionError, match="start_mm, to_mm"):
        axis.simulate(turning)
    assert issubclass(fa.AxisError, fa.FeedAxisError)
    assert issubclass(fa.FeedAxisError, ValueError)


def test_motions_of_an_axis_that_turns_are_in_its_unit(root: Path, axis: fa.Axis) -> None:
    table = fa.Axis.load(root / "data/axes/rotary-table.toml")
    first = table.trajectories[0]
    assert first.distance_rad == pytest.approx(np.pi / 2)
    with pytest.raises(AttributeError, match="in rad"):
        _ = first.distance_m
    limits = {"speed_rad_s": 1.0, "acceleration_rad_s2": 5.0, "jerk_rad_s3": 50.0}
    move = fa.Move.turn(distance_rad=0.1, **limits)
    assert repr(move).startswith("Move.turn(distance_rad=0.1, speed_rad_s=1")
    run = table.simulate(move)
    assert run.error_unit == "rad" and run["position_rad"][-1] == pytest.approx(0.1, abs=1e-2)
    curve = fa.SCurve.turn(0.0, 0.1, **limits)
    assert curve.sample(1e-3)["position_rad"][-1] == pytest.approx(0.1)
    refused: list[tuple[fa.Move | fa.SCurve, fa.Axis, str]] = [
        (move, axis, "moves along a line"),
        (curve, axis, "moves along a line"),
        (axis.trajectories[0], table, r"turns: give Move\.turn"),
    ]
    for motion, other, words in refused:
        with pytest.raises(fa.MotionError, match=words):
            other.simulate(motion)
