"""An axis against the data sheets of its parts."""

from pathlib import Path

import feed_axis as fa
import pytest


def test_a_duty_is_the_files_trajectories_a_motion_or_logs(root: Path) -> None:
    axis = fa.Axis.load(root / "data/axes/screw-rating.toml")
    items = {item["name"]: item for item in axis.check()}
    assert {item["verdict"] for item in items.values()} == {"ok"}
    speed = items["motor_speed"]
    assert speed["unit"] == "rpm" and speed["bound"] == "at most"
    assert speed["margin"] == pytest.approx(speed["limit"] / speed["value"], rel=1e-12)
    # The second trajectory is the faster one: 120 mm/s on a lead of 10 mm.
    assert speed["value"] == pytest.approx(720, rel=0.01)
    move = axis.trajectories[0]
    run = axis.simulate(move)
    by_motion = {item["name"]: item for item in axis.check(motion=move)}
    by_log = {item["name"]: item for item in axis.check(logs=[run])}
    assert by_motion["motor_speed"]["value"] == pytest.approx(600, rel=0.01)
    for name in ("motor_rms_torque", "winding_rise", "nut_life"):
        assert by_log[name]["value"] == pytest.approx(by_motion[name]["value"], rel=0.01)


def test_what_is_missing_is_named(axis: fa.Axis) -> None:
    items = {item["name"]: item for item in axis.check(motion=axis.trajectories[0])}
    assert items["motor_rms_torque"]["verdict"] == "not known"
    assert items["motor_rms_torque"]["give"] == ["continuous_torque_n_m"]
    assert not any(name.startswith("belt") for name in items)
    with pytest.raises(fa.MotionError, match="one of them"):
        axis.check(motion=axis.trajectories[0], logs=[axis.simulate(axis.trajectories[0])])
