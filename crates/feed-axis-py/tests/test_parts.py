"""Parts for themselves against closed forms: friction, hypercubes, beams, networks."""

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
