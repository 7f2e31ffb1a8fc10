"""The built module: numbers known elsewhere, errors, memory, threads, frames."""

import csv
import threading
from pathlib import Path

import feed_axis as fa
import numpy as np
import pytest

ROOT = Path(__file__).parents[3]
AXIS = ROOT / "data/axes/liu2025.toml"


@pytest.fixture(scope="module")
def axis() -> fa.Axis:
    return fa.Axis.load(AXIS)


@pytest.fixture(scope="module")
def run(axis: fa.Axis) -> fa.Run:
    return axis.simulate(axis.trajectories[0])


def test_trajectory_1_has_the_independent_program_s_errors(run: fa.Run) -> None:
    # Converged, by a program that shares no code: 54.453 and 5.3491 µm.
    assert abs(run.max_error - 54.453e-6) < 0.02e-6
    assert abs(run.mean_error - 5.3491e-6) < 0.005e-6


def test_trajectory_1_is_the_golden_one_every_millisecond(run: fa.Run) -> None:
    golden = ROOT / "crates/axis-sim/tests/golden/trajectory1_published.csv"
    if not golden.exists():
        golden = ROOT.parent / "shared/golden/trajectory1_published.csv"
    if not golden.exists():
        pytest.skip(f"no golden trajectory at {golden}")
    with golden.open() as file:
        rows = list(csv.DictReader(file))
    position = np.array([float(row["position_m"]) for row in rows])
    error = np.abs(run["position_m"][::10][: len(position)] - position)
    assert error.max() < 0.05e-6


def test_a_channel_is_the_same_memory_each_time_and_rust_s(run: fa.Run) -> None:
    first, second = run["position_m"], run["position_m"]
    assert first is second
    # Not NumPy's own memory: the array stands on what Rust allocated.
    assert not first.flags.owndata and first.base is not None
    assert len(first) == run.cycles


def test_units_are_the_last_part_of_names(run: fa.Run) -> None:
    assert run.units["position_m"] == "m" and run.units["motor_speed_rad_s"] == "rad/s"
    with pytest.raises(KeyError, match="position_m"):
        run["position"]


def test_frames_hold_the_channels(run: fa.Run) -> None:
    pandas = pytest.importorskip("pandas")
    polars = pytest.importorskip("polars")
    assert isinstance(run.to_pandas(), pandas.DataFrame)
    assert isinstance(run.to_polars(), polars.DataFrame)
    assert np.array_equal(run.to_pandas()["position_m"].to_numpy(), run["position_m"])
    assert np.array_equal(run.to_polars()["iq_a"].to_numpy(), run["iq_a"])


def test_a_dict_gives_the_same_axis(axis: fa.Axis) -> None:
    values = axis.to_dict()
    assert fa.Axis.from_dict(values).fingerprint == axis.fingerprint
    values["drive"]["table_mass_kg"] = 600
    assert fa.Axis.from_dict(values).fingerprint != axis.fingerprint
    values["drive"]["table_mass_kg"] = object()
    with pytest.raises(TypeError, match="table_mass_kg"):
        fa.Axis.from_dict(values)


def test_errors_have_the_library_s_words(axis: fa.Axis, tmp_path: Path) -> None:
    text = AXIS.read_text()
    with pytest.raises(fa.AxisError, match="did you mean `lead_mm`"):
        fa.Axis.from_toml(text.replace("lead_mm", "laed_mm"))
    with pytest.raises(fa.FeedAxisError):
        fa.Axis.load(tmp_path / "none.toml")
    with pytest.raises(fa.MotionError, match="velocity is -1 m/s"):
        fa.Move(distance_m=1, speed_m_s=-1, acceleration_m_s2=1, jerk_m_s3=1)
    far = fa.Move(distance_m=5, speed_m_s=0.3, acceleration_m_s2=1, jerk_m_s3=10)
    with pytest.raises(fa.SimulationError, match="the load left its stroke"):
        axis.simulate(far)
    with pytest.raises(fa.StrategyError, match="valid: network"):
        fa.Compensator(axis, "perfect")
    with pytest.raises(fa.StrategyError, match="the trained network"):
        fa.Compensator(axis, "network")
    with pytest.raises(fa.LogError, match="unit"):
        fa.discover(axis, fit=[{"t_s": [0.0, 1.0], "speed": [0.0, 1.0]}], check=[])
    with pytest.raises(TypeError, match="is no log"):
        fa.discover(axis, fit=[3], check=[])


def test_other_threads_go_on_meanwhile(axis: fa.Axis) -> None:
    counted, done = 0, threading.Event()

    def count() -> None:
        nonlocal counted
        while not done.is_set():
            counted += 1
            done.wait(0.001)

    other = threading.Thread(target=count)
    other.start()
    before = counted
    axis.simulate(axis.trajectories[0], noise=1.0)
    after = counted
    done.set()
    other.join()
    # Of many hundred milliseconds; with the lock held it would be 0 or 1.
    assert after - before > 10


def test_progress_comes_to_its_end_and_may_raise(axis: fa.Axis) -> None:
    told: list[tuple[str, int, int | None]] = []
    axis.sample(1000, progress=lambda *news: told.append(news))
    assert told[-1] == ("sample", 1000, 1000)
    counts = [done for _, done, _ in told]
    assert counts == sorted(counts)

    def refuse(what: str, done: int, total: int | None) -> None:
        raise LookupError(what)

    with pytest.raises(LookupError, match="sample"):
        axis.sample(1000, progress=refuse)


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

    def broken(sample: fa.Sample) -> fa.Correction:
        raise ArithmeticError("of the caller")

    with pytest.raises(ArithmeticError, match="of the caller"):
        axis.simulate(move, compensation=broken)


def test_friction_settles_at_its_steady_state() -> None:
    law = fa.LuGre.liu2025()
    friction = law.simulate(np.full(20_000, 10.0), 1e-4)
    assert abs(friction[-1] - law.steady_state([10.0])[0]) < 1e-12
    # At rest at the first sample: bristles carry nothing yet, σ1 and σ2 do.
    with pytest.raises(fa.ParameterError, match="dt_s"):
        law.simulate([1.0], 0.0)


def test_an_s_curve_takes_the_time_of_its_closed_form() -> None:
    curve = fa.SCurve(0.6, 0.9, speed_m_s=0.1, acceleration_m_s2=0.225, jerk_m_s3=1.2)
    assert abs(curve.duration_s - (0.3 / 0.1 + 0.1 / 0.225 + 0.225 / 1.2)) < 1e-12
    samples = curve.sample(1e-3)
    assert abs(np.trapezoid(samples["speed_m_s"], samples["t_s"]) - 0.3) < 1e-4


def test_a_hypercube_has_one_point_in_each_stratum() -> None:
    points = fa.latin_hypercube(50, [(0.0, 1.5), (-1.0, 1.0)], seed=3)
    assert points.shape == (50, 2)
    for column, (low, high) in zip(points.T, [(0.0, 1.5), (-1.0, 1.0)], strict=True):
        strata = np.floor((column - low) / (high - low) * 50).astype(int)
        assert sorted(strata) == list(range(50))
    assert np.array_equal(points, fa.latin_hypercube(50, [(0.0, 1.5), (-1.0, 1.0)], seed=3))


def test_a_slender_pinned_beam_bends_as_euler_says() -> None:
    length, diameter = 3.0, 0.02
    beam = fa.Beam(length_m=length, diameter_m=diameter, elements=30)
    first = beam.frequencies_hz(2, supports="pinned")
    euler = np.pi / 2 / length**2 * np.sqrt(206e9 / 7850) * diameter / 4
    assert np.allclose(first, euler, rtol=1e-3)
    assert np.all(beam.frequencies_hz(6) == 0.0)  # rigid motions


def test_a_network_learns_a_curve() -> None:
    x = np.linspace(-1, 1, 200)[:, None]
    y = x + np.tanh(3 * x)
    net = fa.Network.train(x, y, hidden=[3, 2], epochs=100)
    assert np.abs(net.predict(x) - y).max() < 1e-2
    again = fa.Network.train(x, y, hidden=[3, 2], epochs=100, threads=1)
    assert np.array_equal(net.predict(x), again.predict(x))
    with pytest.raises(fa.NetworkError):
        net.predict(np.zeros((1, 2)))


def test_one_cycle_training_beats_its_start(axis: fa.Axis) -> None:
    samples = axis.sample(600, near_zero=True)
    assert samples.inputs.shape == (600, 4) and len(samples) == 600
    net = axis.train(samples, hidden=[6, 3], epochs=20)
    assert net.losses[-1] < net.losses[0]
    assert net.test(axis.sample(200, seed=2))[1] < 1e-3  # µm


def there_and_back(distance_mm: float, speed_mm_s: float) -> fa.Program:
    limits = f"velocity_mm_s = {speed_mm_s}, acceleration_mm_s2 = 1000.0, jerk_mm_s3 = 20000.0"
    steps = [
        "dwell = { duration_s = 0.3 }",
        f"move_by = {{ by_mm = {distance_mm}, {limits} }}",
        "dwell = { duration_s = 0.3 }",
        f"move_by = {{ by_mm = {-distance_mm}, {limits} }}",
        "dwell = { duration_s = 0.3 }",
    ]
    text = "start_mm = 600.0\n" + "".join(f"[[steps]]\n{step}\n" for step in steps)
    return fa.Program.from_toml(text)


def logs(axis: fa.Axis) -> list[fa.Run]:
    motions = [there_and_back(100.0, 200.0), there_and_back(-150.0, 100.0)]
    return [axis.simulate(m, noise=1.0, seed=seed) for seed, m in enumerate(motions)]


def test_hidden_viscous_friction_is_found_in_frames(axis: fa.Axis) -> None:
    values = axis.to_dict()
    values["effects"] = [{"name": "viscous-friction", "coefficient": 1000.0}]
    fit, check = logs(fa.Axis.from_dict(values))
    stages: list[str] = []
    found = fa.discover(
        axis,
        fit=[fit.to_pandas()],
        check=[check.to_polars()],
        progress=lambda what, done, total: stages.append(what),
    )
    assert found.verdict == "explained" and found.names == ["viscous-friction"]
    assert found.interval is not None and found.size is not None
    assert found.interval[0] < 1000.0 < found.interval[1]
    assert "screening all effects" in stages
    # The model with what was found follows the machine.
    again = found.axis.simulate(axis.trajectories[0])
    there = fa.Axis.from_dict(values).simulate(axis.trajectories[0])
    assert abs(again.max_error - there.max_error) < 0.2e-6
