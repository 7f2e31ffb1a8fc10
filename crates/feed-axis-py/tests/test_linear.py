"""Linear models of an axis, beside what they are models of."""

import feed_axis as fa
import numpy as np
import pytest


def test_the_matrices_move_as_a_rigid_mass(axis: fa.Axis) -> None:
    """A constant force on a load that slides: Newton's law, as the mean over the vibrations that it starts."""
    mine = fa.new("linear-motor")
    values = mine.to_dict()
    values["friction"]["viscous_n_s_per_m"] = 0.0
    s = fa.Axis.from_dict(values).state_space()
    assert s["inputs"] == ["command", "force"] and s["input_units"][1] == "N"
    x, force, n = np.zeros(len(s["A"])), 10.0, 1000
    for _ in range(n):
        x = s["A"] @ x + s["B"] @ [0.0, force]
    position = (s["C"] @ x)[0]
    time = n * s["dt_s"]
    # The force is against the load; currents hold the slide a little (back-EMF), within a thousandth in 0.1 s? measured below.
    expected = -force * time**2 / 2 / values["mechanism"]["slide_mass_kg"]
    print(position / expected)
    assert abs(position / expected - 1) < 0.02


def test_the_matrices_resonate_where_the_axis_does(axis: fa.Axis) -> None:
    s = axis.state_space(position=0.6)
    poles = np.linalg.eigvals(s["A"])
    poles = poles[np.abs(poles) > 0.5]
    hertz = np.abs(np.log(poles)) / (2 * np.pi * s["dt_s"])
    for mode in axis.frequencies_hz(0.6)[:2]:
        assert np.min(np.abs(hertz / mode - 1)) < 0.03
    with pytest.raises(fa.LoopError, match="position 9.* is outside the axis' stroke; valid: from 0 to 1.5 m"):
        axis.state_space(position=9)


def test_responses_are_those_of_the_analysis(axis: fa.Axis) -> None:
    found = axis.analyse(positions=[0.6], masses=1.0)
    for stuck in (False, True):
        r = axis.frequency_response(position=0.6, stuck=stuck)
        (curve,) = [curve for curve in found["curves"] if curve["stuck"] == stuck]
        assert np.iscomplexobj(r["compliance"])
        assert np.array_equal(r["open_command"], np.array(curve["open_command"]) @ [1, 1j])
    with pytest.raises(fa.LoopError, match="outside"):
        axis.frequency_response(position=-1)
