"""Values: equal, hashed, copied, pickled, and sent to other processes."""

import copy
import multiprocessing
import pickle
from concurrent.futures import ProcessPoolExecutor

import feed_axis as fa
import numpy as np
import pytest

LIMITS = {"speed_m_s": 0.1, "acceleration_m_s2": 1.0, "jerk_m_s3": 10.0}
TURNS = {"speed_rad_s": 0.1, "acceleration_rad_s2": 1.0, "jerk_rad_s3": 10.0}
STILL = "start_mm = 600.1\n[[steps]]\ndwell = { duration_s = 0.02 }\n"


@pytest.fixture(scope="module")
def values(axis: fa.Axis) -> list[object]:
    """One of each kind, of which none is equal to another."""
    network = fa.Network.train([-1, 0, 1, 2], [-1, 0, 1, 1], hidden=2, epochs=5)
    transfer = axis.identify_transfer(seed=1)
    law = fa.LuGre.liu2025()
    program = fa.Program.from_toml(STILL)
    run = axis.simulate(program, noise=1.0)
    return [
        axis,
        fa.Move(distance_m=0.1, **LIMITS),
        fa.Move.turn(distance_rad=0.1, **TURNS),
        fa.SCurve(0.1, 0.3, **LIMITS),
        fa.SCurve.turn(0.1, 0.3, **TURNS),
        program,
        run,
        network,
        law,
        fa.GeneralLuGre(
            coulomb_n_m=1.0,
            stiction_n_m=1.5,
            stribeck_speed_rad_s=0.3,
            stiffness_n_m_rad=2e3,
            damping_n_m_s_rad=1.0,
            viscous_n_m_s_rad=0.02,
            coulomb_backward_n_m=1.2,
            viscous_cubic_n_m_s3_rad3=1e-4,
        ),
        transfer,
        axis.sample(20),
        fa.Beam(length_m=1.5, diameter_m=0.04),
        fa.Correction(0.1, 0.2),
        fa.Sample(reference=(1, 2, 3), iq_a=0.1),
        fa.Compensator(axis, "plan"),
        fa.Compensator(axis, "lugre", friction=law),
        fa.Compensator(axis, "transfer_function", transfer=transfer),
    ]


def test_copies_and_pickles_are_equal_and_others_are_not(values: list[object]) -> None:
    for value in values:
        again = [copy.copy(value), copy.deepcopy(value)]
        again += [pickle.loads(pickle.dumps(value, protocol)) for protocol in range(6)]
        for one in again:
            assert type(one) is type(value)
            assert one == value and not one != value, value
            assert repr(one) == repr(value)
        assert value != 3 and value != "axis" and not value == None  # noqa: E711
    for i, one in enumerate(values):
        for k, other in enumerate(values):
            assert (one == other) == (i == k), (one, other)


def test_what_cannot_change_is_hashed_as_it_compares(values: list[object], axis: fa.Axis) -> None:
    changing = (fa.Run, fa.Sample, fa.Samples, fa.Compensator)
    for value in values:
        if isinstance(value, changing):
            with pytest.raises(TypeError, match="unhashable"):
                hash(value)
        else:
            assert hash(pickle.loads(pickle.dumps(value))) == hash(value)
    assert len(set(axis.trajectories) | set(axis.trajectories)) == len(axis.trajectories)
    # A file that differs in its comments, units and order is the same axis.
    text = axis.to_toml()
    assert "lead_mm = 10" in text
    other = fa.Axis.from_toml("# another file\n" + text.replace("lead_mm = 10", "lead_m = 0.010"))
    assert other == axis and hash(other) == hash(axis) and other.to_toml() != text


def test_a_run_from_a_pickle_is_the_same_to_the_bit(axis: fa.Axis) -> None:
    program = fa.Program.from_toml(STILL)
    run = axis.simulate(program, noise=1.0)
    again = pickle.loads(pickle.dumps(run))
    assert again.keys() == run.keys() and again.units == run.units
    for name in run:
        assert np.array_equal(again[name], run[name])
    assert (again.max_error, again.mean_error, again.cycles) == (run.max_error, run.mean_error, run.cycles)
    with pytest.raises(ValueError, match="read-only"):
        again["position_m"][0] = 0.0
    assert axis.simulate(program, noise=1.0) == run != axis.simulate(program, noise=1.0, seed=2)
    # The copy of a program has its numbers to the last bit: so have its runs.
    assert axis.simulate(pickle.loads(pickle.dumps(program)), noise=1.0) == run


def test_a_copy_of_a_compensator_has_not_begun(axis: fa.Axis) -> None:
    begun = fa.Compensator(axis, "plan", motion=axis.trajectories[0])
    begun.update(fa.Sample())
    with pytest.raises(fa.StrategyError, match="no motion was begun"):
        copy.copy(begun).update(fa.Sample())


def error_with(axis: fa.Axis, move: fa.Move, compensation: fa.Compensator | None) -> fa.Run:
    """The work of one process."""
    return axis.simulate(move, compensation=compensation)


def test_a_sweep_in_other_processes_gives_what_one_gives(axis: fa.Axis) -> None:
    values = axis.to_dict()
    axes, moves = [], []
    for kv in (20.0, 30.0):
        values["control"]["velocity_feedforward"] = kv / 30.0
        axes.append(fa.Axis.from_dict(values))
        moves.append(fa.Move(distance_m=0.01, **LIMITS))
    plans = [None, fa.Compensator(axes[1], "plan")]
    # Started anew, as on Windows and macOS: everything goes there and comes back by pickle.
    spawn = multiprocessing.get_context("spawn")
    with ProcessPoolExecutor(2, mp_context=spawn) as pool:
        runs = list(pool.map(error_with, axes, moves, plans))
    assert runs == [error_with(*work) for work in zip(axes, moves, plans, strict=True)]
    assert runs[0] != runs[1] and runs[1].max_error < runs[0].max_error
