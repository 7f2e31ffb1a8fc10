"""Parts for themselves against closed forms: friction, hypercubes, beams, networks."""

from pathlib import Path
from typing import Any

import feed_axis as fa
import numpy as np
import pytest


def test_friction_settles_at_its_steady_state() -> None:
    law = fa.LuGre.liu2025()
    friction = law.simulate(np.full(20_000, 10.0), 1e-4)
    assert abs(friction[-1] - law.steady_state([10.0])[0]) < 1e-12
    # Far above the Stribeck speed: Coulomb and viscous friction alone.
    fast = 40 * law.stribeck_speed_rad_s
    expected = law.coulomb_n_m + law.viscous_n_m_s_rad * fast
    assert abs(law.steady_state([fast])[0] - expected) < 1e-12
    with pytest.raises(fa.ParameterError, match="dt_s"):
        law.simulate([1.0], 0.0)


def test_general_friction_is_the_curve_of_its_keys() -> None:
    plain = fa.LuGre.liu2025()
    names = ("coulomb_n_m", "stiction_n_m", "stribeck_speed_rad_s", "stiffness_n_m_rad", "damping_n_m_s_rad", "viscous_n_m_s_rad")
    shared = {name: getattr(plain, name) for name in names}
    speeds = np.linspace(-20.0, 20.0, 81)
    assert np.allclose(fa.GeneralLuGre(**shared).steady_state(speeds), plain.steady_state(speeds), rtol=1e-12, atol=0)
    own = {
        "coulomb_backward_n_m": 1.3 * plain.coulomb_n_m,
        "stiction_backward_n_m": 1.2 * plain.stiction_n_m,
        "stribeck_exponent": 0.7,
        "viscous_quadratic_n_m_s2_rad2": 2e-4,
        "viscous_cubic_n_m_s3_rad3": 3e-5,
    }
    if own["stiction_backward_n_m"] < own["coulomb_backward_n_m"]:
        own["stiction_backward_n_m"] = 1.1 * own["coulomb_backward_n_m"]
    law = fa.GeneralLuGre(**shared, **own)
    for name, value in (shared | own).items():
        assert getattr(law, name) == value
    for v in (-20.0, -0.4, 0.4, 20.0):
        side = "_backward" if v < 0 else ""
        coulomb, stiction = (getattr(law, f"{level}{side}_n_m") for level in ("coulomb", "stiction"))
        fall = np.exp(-((abs(v) / law.stribeck_speed_rad_s) ** 0.7))
        viscous = v * (law.viscous_n_m_s_rad + 2e-4 * abs(v) + 3e-5 * v**2)
        assert law.steady_state(v)[0] == pytest.approx((coulomb + (stiction - coulomb) * fall) * np.sign(v) + viscous, rel=1e-12)
        assert law.simulate(np.full(40_000, v), 1e-4)[-1] == pytest.approx(law.steady_state(v)[0], rel=1e-9)
    with pytest.raises(fa.ParameterError, match=r"`backward.stiction` is 0.1, but must be at least"):
        fa.GeneralLuGre(**shared, stiction_backward_n_m=0.1)
    with pytest.raises(fa.ParameterError, match="stribeck_exponent"):
        fa.GeneralLuGre(**shared, stribeck_exponent=0.0)


def test_keys_of_friction_by_direction_count_in_an_axis(root: Path) -> None:
    values = fa.Axis.load(root / "data/axes/linear-stage.toml").to_dict()
    more = {"coulomb_backward_n": 6.0, "stiction_backward_n": 7.0}  # 4 and 5 N forward
    changed = values | {"friction": values["friction"] | more}

    def force(of: dict[str, Any], distance: float) -> float:
        """At constant speed, of the motor."""
        axis = fa.Axis.from_dict(of)
        run = axis.simulate(fa.Move(distance_m=distance, speed_m_s=0.05, acceleration_m_s2=1.0, jerk_m_s3=50.0))
        middle = len(run["t_s"]) // 2
        return float(run["force_ref_n"][middle - 100 : middle].mean())

    assert force(changed, 0.02) == pytest.approx(force(values, 0.02), abs=1e-3)
    assert force(changed, -0.02) - force(values, -0.02) == pytest.approx(-2.0, abs=0.02)


def test_a_hypercube_has_one_point_in_each_stratum() -> None:
    bounds = [(0.0, 1.5), (-1.0, 1.0)]
    points = fa.latin_hypercube(50, bounds, seed=3)
    assert points.shape == (50, 2)
    for column, (low, high) in zip(points.T, bounds, strict=True):
        strata = np.floor((column - low) / (high - low) * 50).astype(int)
        assert sorted(strata) == list(range(50))
    assert np.array_equal(points, fa.latin_hypercube(50, bounds, seed=3))
    with pytest.raises(fa.ParameterError):
        fa.latin_hypercube(5, [(1.0, 0.0)])


def test_sequences_are_even_and_go_on() -> None:
    bounds = [(0.0, 1.0), (-2.0, 2.0)]
    # Each 2^k points of Sobol's sequence are a Latin hypercube, scrambled or not.
    for scrambling in ("owen", "linear-matrix", None):
        points = fa.sobol(256, bounds, scrambling=scrambling, seed=5)
        for column, (low, high) in zip(points.T, bounds, strict=True):
            strata = np.floor((column - low) / (high - low) * 256).astype(int)
            assert sorted(strata) == list(range(256))
        more = fa.sobol(64, bounds, scrambling=scrambling, seed=5, start=192)
        assert np.array_equal(more, points[192:])
    # Halton's: digits of i in bases 2 and 3, turned over; 5 is 101 and 12.
    plain = fa.halton(6, [(0.0, 1.0), (0.0, 1.0)], scrambled=False)
    assert plain[5].tolist() == [5 / 8, 7 / 9]
    scrambled = fa.halton(2**4 * 3**3, bounds, seed=2)
    cells = np.floor(scrambled[:, 0] * 16) * 27 + np.floor((scrambled[:, 1] + 2) / 4 * 27)
    assert len(set(cells)) == 2**4 * 3**3
    assert np.array_equal(fa.halton(100, bounds, seed=2, start=332), scrambled[332:])
    # The mean of x y over the unit square is 1/4; random points are off by some 0.007.
    unit = [(0.0, 1.0), (0.0, 1.0)]
    for points in (fa.sobol(1024, unit), fa.halton(1000, unit)):
        assert abs(points.prod(axis=1).mean() - 0.25) < 2e-3
    with pytest.raises(fa.ParameterError, match='scrambling is "own"; valid: "owen"'):
        fa.sobol(8, bounds, scrambling="own")  # type: ignore[arg-type]
    with pytest.raises(fa.ParameterError):
        fa.halton(0, bounds)


def test_a_slender_pinned_beam_bends_as_euler_says() -> None:
    length, diameter = 3.0, 0.02
    beam = fa.Beam(length_m=length, diameter_m=diameter, elements=30)
    first = beam.frequencies_hz(2, supports="pinned")
    euler = np.pi / 2 / length**2 * np.sqrt(206e9 / 7850) * diameter / 4
    assert np.allclose(first, euler, rtol=1e-3)
    assert np.all(beam.frequencies_hz(6) == 0.0)  # rigid motions


def test_the_screw_of_the_specification_twists_as_ten_elements_do() -> None:
    # Solid steel, 40 mm, 1.5 m, E = 206 GPa, ν = 0.3, 7850 kg/m³, N = 10. Linear elements
    # with consistent mass twist at ω² = 6 (c/h)² (1 − cos φ) / (2 + cos φ), φ = nπ/N.
    screw = fa.Beam(length_m=1.5, diameter_m=0.04, elements=10)
    speed = np.sqrt(206e9 / (2 * 1.3) / 7850)
    phase = np.pi * np.arange(1, 4) / 10
    ratio = (1 - np.cos(phase)) / (2 + np.cos(phase))
    twist = speed / 0.15 * np.sqrt(6 * ratio) / (2 * np.pi)
    found = screw.frequencies_hz(40)
    for frequency in twist:
        assert np.abs(found / frequency - 1).min() < 1e-9


def test_a_network_learns_a_curve() -> None:
    x = np.linspace(-1, 1, 200)[:, None]
    y = x + np.tanh(3 * x)
    net = fa.Network.train(x, y, hidden=[3, 2], epochs=100)
    assert np.abs(net.predict(x) - y).max() < 1e-2
    again = fa.Network.train(x, y, hidden=[3, 2], epochs=100, threads=1)
    assert np.array_equal(net.predict(x), again.predict(x))
    assert net.shape == (1, [3, 2], 1)
    with pytest.raises(fa.NetworkError):
        net.predict(np.zeros((1, 2)))
    with pytest.raises(fa.NetworkError):
        fa.Network.train(x, y[:-1])
