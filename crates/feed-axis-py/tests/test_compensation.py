"""Compensators on whole moves and cycle by cycle; the one-cycle network."""

from pathlib import Path

import feed_axis as fa
import numpy as np
import pytest


def test_a_plan_leaves_less_than_half(axis: fa.Axis, run: fa.Run) -> None:
    plan = fa.Compensator(axis, "plan")
    with_plan = axis.simulate(axis.trajectories[0], compensation=plan)
    assert with_plan.max_error < 0.5 * run.max_error


def test_a_function_compensates_cycle_by_cycle(axis: fa.Axis, run: fa.Run) -> None:
    move = axis.trajectories[0]
    plan = fa.Compensator(axis, "plan", motion=move)
    by_hand = axis.simulate(move, compensation=plan.update)
    whole = axis.simulate(move, compensation=plan)
    assert np.array_equal(by_hand["position_m"], whole["position_m"])
    none = axis.simulate(move, compensation=lambda sample: fa.Correction())
    assert np.array_equal(none["position_m"], run["position_m"])


def test_what_a_function_raises_or_gives_wrong_is_raised(axis: fa.Axis) -> None:
    move = axis.trajectories[0]

    def broken(sample: fa.Sample) -> fa.Correction:
        raise ArithmeticError("of the caller")

    with pytest.raises(ArithmeticError, match="of the caller"):
        axis.simulate(move, compensation=broken)
    with pytest.raises(TypeError, match="Correction"):
        axis.simulate(move, compensation=lambda sample: 1.0)  # type: ignore[arg-type,return-value]
    with pytest.raises(TypeError, match="compensation is a int"):
        axis.simulate(move, compensation=1)  # type: ignore[arg-type]


def test_strategies_say_what_they_lack(axis: fa.Axis) -> None:
    with pytest.raises(fa.StrategyError, match="valid: network"):
        fa.Compensator(axis, "perfect")
    with pytest.raises(fa.StrategyError, match="the trained network"):
        fa.Compensator(axis, "network")
    with pytest.raises(fa.StrategyError, match="no motion was begun"):
        fa.Compensator(axis, "plan").update(fa.Sample())
    assert "plan" in fa.STRATEGIES


def test_one_cycle_training_beats_its_start(axis: fa.Axis, tmp_path: Path) -> None:
    samples = axis.sample(600, near_zero=True)
    assert samples.inputs.shape == (600, 4) and len(samples) == 600
    net = axis.train(samples, hidden=[6, 3], epochs=20)
    assert net.losses[-1] < net.losses[0]
    unseen = axis.sample(200, seed=2)
    # The best plane through the same samples: what a network must beat.
    plane = np.linalg.lstsq(np.c_[samples.inputs, np.ones(600)], samples.increments_m)[0]
    left = np.abs(np.c_[unseen.inputs, np.ones(200)] @ plane - unseen.increments_m)
    assert net.test(unseen)[1] < 1e6 * left.mean()
    path = tmp_path / "network"
    path.write_bytes(net.to_bytes())
    read = fa.Network.load(path)
    assert np.array_equal(read.predict(unseen.inputs), net.predict(unseen.inputs))
