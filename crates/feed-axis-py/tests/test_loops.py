"""Margins and tuning of an axis' loops; axes to begin with."""

from pathlib import Path

import feed_axis as fa
import numpy as np
import pytest


def test_axes_to_begin_with_are_those_of_their_files(root: Path, axis: fa.Axis) -> None:
    all_kinds = fa.examples()
    assert all_kinds["liu2025"] == axis
    for kind in ("belt", "rack", "linear-motor", "rotary-table", "screw-datasheet"):
        assert all_kinds[kind] == fa.Axis.load(root / f"data/axes/{kind}.toml")
        run = all_kinds[kind].simulate(all_kinds[kind].trajectories[0])
        assert 0 < run.max_error < 0.01
    for kind in all_kinds:
        mine = fa.new(kind, 'my "own" axis')
        assert mine.name == 'my "own" axis' and mine == fa.new(kind) == all_kinds[kind]
        assert mine.to_dict().keys() == all_kinds[kind].to_dict().keys()
    with pytest.raises(fa.AxisError, match='no example "screw"; valid: liu2025, ball-screw'):
        fa.new("screw")


def test_margins_are_those_of_the_responses_that_are_given(axis: fa.Axis) -> None:
    found = axis.analyse(positions=[0.6], masses=1.0)
    assert len(found["corners"]) == 2  # sliding, stuck
    for corner, curve in zip(found["corners"], found["curves"], strict=True):
        # The greatest of 1/|1 + L| over the frequencies that are given: the figure's own lies between two of them.
        loop = np.array(curve["open_command"]) @ [1, 1j]
        assert len(loop) == len(curve["frequency_hz"])
        peak = (1 / np.abs(1 + loop)).max()
        assert peak <= corner["command"]["sensitivity"] * (1 + 1e-9)
        assert peak > 0.99 * corner["command"]["sensitivity"]
    # Half a control period more delay leaves less room.
    late = axis.analyse(positions=0.6, masses=[1.0], delay_cycles=0.5)
    assert late["worst"]["sensitivity"] > found["worst"]["sensitivity"]
    assert np.allclose(found["modes_hz"][:2], [62.80, 139.04], rtol=0, atol=0.0051)


def test_a_tuned_axis_keeps_the_limits_and_has_the_keys_that_are_named(axis: fa.Axis) -> None:
    for one, limit in ((axis, 1.6), (fa.new("belt"), 1.4)):
        tuned, found = one.tune(sensitivity=limit)
        worst = tuned.analyse()["worst"]
        assert worst["sensitivity"] <= limit and worst["sensitivity_late"] <= 2.0 and not worst["unstable"]
        before, after = one.to_dict(), tuned.to_dict()
        assert found["keys"] and tuned != one
        for key in found["keys"]:
            assert before["control"].get(key["key"]) == key["before"]
            assert after["control"].pop(key["key"]) == key["value"]
            before["control"].pop(key["key"], None)
        # All else is as it was.
        assert before == after
        # It holds the load better than the file's gains do.
        assert found["tuned"]["compliance_rms"] < found["file"]["compliance_rms"]
        # What limits the gains is nearest to its limit; moves are told before and after.
        nearness = [limit["value"] / limit["limit"] for limit in found["limiting"]]
        assert nearness == sorted(nearness, reverse=True) and 0.98 < nearness[0] < 1.0 + 1e-6
        assert [move["trajectory"] for move in found["moves"]] == [k + 1 for k in range(len(one.trajectories))]
    # A gain of the paper's axis in rpm per mm, on a screw of 10 mm, as 1/s.
    tuned, found = axis.tune(notch=False, acceleration=False)
    kv = tuned.to_dict()["control"]["position_gain_rpm_per_mm"] * 10 / 60
    assert abs(found["tuned_gains"]["kv_per_s"] / kv - 1) < 1e-9
    assert {key["key"] for key in found["keys"]} <= {
        "position_gain_rpm_per_mm",
        "speed_proportional_a_per_rpm",
        "speed_integral_a_per_rpm_s",
    }


def test_loops_that_cannot_be_asked_for_are_refused(axis: fa.Axis) -> None:
    with pytest.raises(fa.LoopError, match="position 9 is outside the axis' stroke; valid: from 0 to 1.5"):
        axis.analyse(positions=9)
    with pytest.raises(fa.LoopError, match="delay is -1; valid: from 0 to 16"):
        axis.analyse(delay_cycles=-1)
    with pytest.raises(TypeError, match="masses holds .*; valid: real numbers"):
        axis.analyse(masses="a")
    with pytest.raises(fa.LoopError, match="sensitivity is 0.5; valid: from 1.1 to 10"):
        axis.tune(sensitivity=0.5)


def excited_slide(axis: fa.Axis, amplitude: float) -> fa.Run:
    """A slide of the rack at 50 mm/s; random signs, held over two cycles, on its command while the speed is constant."""
    move = fa.SCurve(0.5, 0.753, speed_m_s=0.05, acceleration_m_s2=1.0, jerk_m_s3=20.0)
    cycles = round(5.0 / axis.period_s)
    signs = np.repeat(np.random.default_rng(7).choice([-1.0, 1.0], cycles // 2 + 1), 2)[:cycles]
    signs[: round(0.2 / axis.period_s)] = 0.0
    return axis.simulate(move, noise=1.0, excitation=amplitude * signs)


def test_a_delay_that_the_file_lacks_is_measured_and_tuned_with(root: Path) -> None:
    axis = fa.Axis.load(root / "data/axes/rack.toml")
    values = axis.to_dict()
    values["actuator"]["delay_us"] += 300
    machine = fa.Axis.from_dict(values)
    run = excited_slide(machine, 4.0)
    assert run.units["excitation_n_m"] == "N·m" and set(np.unique(run["excitation_n_m"])) == {-4.0, 0.0, 4.0}
    assert "excitation_n_m" not in axis.simulate(axis.trajectories[0])
    (found,) = axis.frf(run)
    assert found["comparison"]["delay_s"]["value"] == pytest.approx(3e-4, abs=6e-6)
    assert found["traps"] == [] and found["fit"]["modes"]
    # A rack's log has the torque that is asked for and not the actual one, of which the compliance would be made.
    assert found["compliance"] is None and "both the command and the actual" in found["compliance_missing"]
    # As arrays with other names, once more.
    log = {name: run[name] for name in run}
    log["added"] = log.pop("excitation_n_m")
    assert axis.frf([log], columns={"added": "excitation_n_m"}) == [found]

    def worst(tuned: fa.Axis) -> float:
        values = tuned.to_dict()
        values["actuator"]["delay_us"] += 300
        return float(fa.Axis.from_dict(values).analyse(masses=1.0)["worst"]["sensitivity"])

    blind, _ = axis.tune(masses=1.0, notch=False)
    seeing, report = axis.tune(masses=1.0, notch=False, frf=run)
    assert worst(blind) > 2.0 and worst(seeing) < 1.7
    assert any("1 measured responses" in note for note in report["notes"])


def test_logs_without_excitation_are_no_responses_to_tune_on(root: Path) -> None:
    axis = fa.Axis.load(root / "data/axes/rack.toml")
    run = axis.simulate(axis.trajectories[0])
    (found,) = axis.frf([run])
    assert found["margins"] is None and any(trap["refused"] for trap in found["traps"])
    with pytest.raises(fa.LoopError, match="measured response 1: the log has no excitation"):
        axis.tune(frf=run)
    with pytest.raises(fa.LoopError, match=r"logs\[0\]: the coherence is 2; valid: from 0 to 1"):
        axis.frf(run, coherence=2.0)
    with pytest.raises(fa.SimulationError, match=r"excitation has \d+ values and the motion \d+ control cycles"):
        axis.simulate(axis.trajectories[0], excitation=np.zeros(10**6))
    with pytest.raises(fa.SimulationError, match=r"excitation\[1\] is inf; valid: finite"):
        axis.simulate(axis.trajectories[0], excitation=[0.0, np.inf])
