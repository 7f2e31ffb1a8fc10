"""Hours of heat: of a duty, fitted to logs, predicted along them."""

from pathlib import Path

import feed_axis as fa
import numpy as np
import pytest


def test_an_hour_is_that_of_the_command(root: Path) -> None:
    axis = fa.Axis.load(root / "data/axes/screw-heat.toml")
    hour = axis.heat(at_m=[0.45, 0.95])
    assert hour["measures_at"] == "motor" and len(hour["nodes"]) == 8
    # docs/heat.md.
    assert hour["places"][1]["screw_um"][-1] == pytest.approx(133.63, abs=0.01)
    assert hour["viscous_factor"][-1] == pytest.approx(0.781, abs=0.001)
    with pytest.raises(fa.SimulationError, match="valid"):
        axis.heat(losses="none")  # type: ignore[arg-type]
    with pytest.raises(fa.SimulationError, match="at_m 1.6: the table is between 0 and 1.5 m"):
        axis.heat(at_m=[1.6])
    for duration in (0.0, -1.0, float("nan"), float("inf")):
        with pytest.raises(fa.SimulationError, match="duration_s is .*valid: above 0"):
            axis.heat(duration_s=duration)
    # What was refused, and why.
    away = axis.to_dict()
    away["thermal"]["viscous_fall_percent_per_k"] = -15
    with pytest.raises(fa.SimulationError, match="come to rest thermally: after .* losses grow"):
        fa.Axis.from_dict(away).heat(duration_s=1e6)


def test_a_fitted_model_predicts_hours_that_were_not_fitted(root: Path) -> None:
    axis = fa.Axis.load(root / "data/axes/screw-heat.toml")
    heat = root / "data/heat"
    duties = [fa.Program.load(heat / f"duty-{n}.toml") for n in range(1, 10)]
    fitted, found = axis.fit_heat(heat / "probed.csv", duties=duties)
    assert found["fitted_numbers"]["greatest_um"] < 6 < found["assumed_numbers"]["greatest_um"]
    assert "thermal" in fitted.to_dict() and fitted.name == axis.name
    check = heat / "probed-check.csv"
    before, after = (a.predict_growth(check, duties=duties, at_m=[0.95]) for a in (axis, fitted))
    assert after["figures"]["greatest_um"] < 0.3 * before["figures"]["greatest_um"]
    assert np.shape(after["growth_at_m"]) == (1, len(after["t_s"]))
    right = axis.predict_growth(check, duties=duties, probe_each_s=3600.0)
    # The readings next after one and two hours, at 3890 and 7490 s; the log ends before another hour has gone.
    assert right["figures"]["probings"] == 2
    for each in (0.0, -1.0, float("nan")):
        with pytest.raises(fa.LogError, match="probe_each is .*valid: above 0"):
            axis.predict_growth(check, duties=duties, probe_each_s=each)
    with pytest.raises(fa.LogError, match="at_m 1.6: the table"):
        axis.predict_growth(check, duties=duties, at_m=[1.6])
    with pytest.raises(fa.LogError, match="duty 6"):
        axis.predict_growth(check, duties=duties[:5])


def test_growth_is_taken_off_a_reference(root: Path) -> None:
    axis = fa.Axis.load(root / "data/axes/screw-heat.toml")
    t = np.arange(0, 1200, 0.1)
    position = 0.7 - 0.25 * np.cos(2 * np.pi * t / 8)
    along = axis.predict_growth({"t_s": t, "position_ref_m": position})
    assert along["growth_m"].shape == t.shape
    assert along["growth_m"][0] == 0 and 20e-6 < along["growth_m"].max() < 200e-6
    # Without jumps: it changes with the position, by less than a screw that is 20 K warmer does, and hardly with time.
    steps = np.abs(np.diff(along["growth_m"]))
    assert (steps < 20 * 11.5e-6 * np.abs(np.diff(position)) + 0.1e-6).all()
