"""What is learned from logs: corrections of a move, friction, controllers."""

import copy
import pickle
from pathlib import Path

import feed_axis as fa
import pytest


def test_a_repeated_move_gets_better(axis: fa.Axis, tmp_path: Path) -> None:
    move = axis.trajectories[0]
    values = axis.to_dict()
    values["friction"]["coulomb_n_m"] *= 1.1
    values["friction"]["stiction_n_m"] *= 1.1
    machine = fa.Axis.from_dict(values)
    correction, peaks = None, []
    for _ in range(3):
        plan = fa.Compensator(axis, "plan", correction=correction)
        run = machine.simulate(move, compensation=plan, noise=1.0)
        peaks.append(run.max_error)
        correction, found = fa.learn(axis, run, correction)
    assert correction is not None
    assert found["rounds"] == correction.rounds == 3
    assert found["advice"] in ("again", "done", "enough")
    assert peaks[2] < 0.5 * peaks[0], peaks
    correction.save(tmp_path / "c.json")
    assert fa.MoveCorrection.load(tmp_path / "c.json") == correction == pickle.loads(pickle.dumps(correction))
    assert copy.copy(fa.Compensator(axis, "plan", correction=correction)) == fa.Compensator(axis, "plan", correction=correction)
    with pytest.raises(fa.StrategyError, match="the reference is not that of the move"):
        axis.simulate(axis.trajectories[1], compensation=fa.Compensator(axis, "plan", correction=correction))
    with pytest.raises(fa.StrategyError, match="valid: a strategy that plans"):
        fa.Compensator(axis, "lugre", friction=fa.LuGre.liu2025(), correction=correction)
    (tmp_path / "bad.json").write_text("{}")
    with pytest.raises(fa.StrategyError, match="this is no correction of a move"):
        fa.MoveCorrection.load(tmp_path / "bad.json")


def test_friction_is_that_of_the_logged_runs(axis: fa.Axis) -> None:
    runs = [
        axis.simulate(fa.Move(distance_m=sign * min(0.3, 20 * speed), speed_m_s=speed, acceleration_m_s2=0.5, jerk_m_s3=10.0))
        for speed in (0.0005, 0.001, 0.002, 0.004, 0.01, 0.02, 0.05, 0.1)
        for sign in (1, -1)
    ]
    friction, found = fa.identify(axis, runs)
    truth = axis.to_dict()["friction"]["coulomb_n_m"]
    value, interval = found["parameters"]["T_C"]
    assert friction.coulomb_n_m == value and abs(value / truth - 1) < 0.02
    assert interval is None or interval[0] < interval[1]
    with pytest.raises(fa.LogError):
        fa.identify(axis, [])


def test_an_unknown_controller_is_found(axis: fa.Axis, root: Path) -> None:
    programs = [fa.Program.load(root / f"data/programs/there-and-back{name}.toml") for name in ("", "-check")]
    fit, check = (axis.simulate(program, noise=1.0, seed=seed) for seed, program in enumerate(programs, 1))
    values = axis.to_dict()
    truth = values["control"]["position_gain_rpm_per_mm"]
    values["control"]["position_gain_rpm_per_mm"] = 2 * truth
    found_axis, found = fa.identify_control(fa.Axis.from_dict(values), [fit], [check])
    value, (low, high) = found["gains"]["position_gain_rpm_per_mm"]
    assert abs(value / truth - 1) < 0.02 and low < value < high
    assert abs(found_axis.to_dict()["control"]["position_gain_rpm_per_mm"] / value - 1) < 1e-5
    assert found["explained_check"] > 0.9
    with pytest.raises(fa.SearchError, match="frequency_hz is 0; valid"):
        fa.identify_control(axis, [fit], [check], frequency_hz=0)
    with pytest.raises(fa.LogError, match="check holds no log"):
        fa.identify_control(axis, [fit], [])
