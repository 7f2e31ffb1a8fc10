"""What a model lacks, from logs as frames, runs, files and arrays."""

import pickle
from collections.abc import Iterator
from pathlib import Path

import feed_axis as fa
import numpy as np
import pytest


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


@pytest.fixture(scope="module")
def machine(axis: fa.Axis) -> fa.Axis:
    """The axis with viscous friction that its model does not have."""
    values = axis.to_dict()
    values["effects"] = [{"name": "viscous-friction", "coefficient": 1000.0}]
    return fa.Axis.from_dict(values)


@pytest.fixture(scope="module")
def logs(machine: fa.Axis) -> Iterator[list[fa.Run]]:
    motions = [there_and_back(100.0, 200.0), there_and_back(-150.0, 100.0)]
    yield [machine.simulate(m, noise=1.0, seed=seed) for seed, m in enumerate(motions)]


def test_hidden_viscous_friction_is_found_in_frames(
    axis: fa.Axis, machine: fa.Axis, logs: list[fa.Run]
) -> None:
    pytest.importorskip("pandas")
    polars = pytest.importorskip("polars")
    stages: list[str] = []
    # The frame's columns have other names and units; one that is no number is none of a log's.
    frame = logs[0].to_pandas().rename(columns={"t_s": "time", "position_m": "x"})
    frame["x"] *= 1e3
    frame["comment"] = "none"
    found = fa.discover(
        axis,
        fit=[frame],
        check=[logs[1].to_polars().rename({"t_s": "time", "position_m": "x"}).with_columns(polars.col("x") * 1e3)],
        columns={"time": "t_s", "x": ("position_m", 1e-3)},
        progress=lambda what, done, total: stages.append(what),
    )
    assert found.verdict == "explained" and found.names == ["viscous-friction"]
    assert found.interval is not None and found.size is not None
    assert found.interval[0] < 1000.0 < found.interval[1]
    assert "screening all effects" in stages and stages[-1] == "verdict"
    assert "viscous-friction" in found._repr_html_() and found.sentence in found.words
    assert found.to_dict()["effects"][0]["name"] == "viscous-friction"
    table_of_effects = found.to_pandas()
    assert list(table_of_effects["effect"]) == ["viscous-friction"]
    first = table_of_effects.iloc[0]
    assert (first["value"], first["from"], first["to"]) == (found.size, *found.interval)
    again_found = pickle.loads(pickle.dumps(found))
    assert again_found == found and again_found.to_dict() == found.to_dict()
    page = found.to_html()
    assert "What the model of liu2025 lacks" in page and "The gap before and after" in page
    assert again_found.to_html() == page
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    bars = found.plot()
    assert [label.get_text() for label in bars.get_xticklabels()] == [name for name, *_ in found.gap]
    # The model with what was found follows the machine.
    again = found.axis.simulate(axis.trajectories[0])
    there = machine.simulate(axis.trajectories[0])
    assert abs(again.max_error - there.max_error) < 0.2e-6
    # With it in the model nothing is missing: on a run and a table in place of frames, of which
    # the table's time stamps are late by turns, and one sample is not there.
    table = {name: np.array(logs[0][name]) for name in logs[0]}
    period = table["t_s"][1] - table["t_s"][0]
    table["t_s"] += 0.2 * period * np.random.default_rng(1).random(table["t_s"].size)
    table["iq_a"][400] = np.nan
    nothing = fa.discover(found.axis, fit=[table], check=[logs[1]])
    assert nothing.verdict == "nothing-missing" and nothing.size is None
    notes = nothing.to_dict()["notes"]
    assert any("fit 1" in note and "stamps" in note for note in notes), notes


def test_a_log_says_what_is_wrong_with_it(
    axis: fa.Axis, logs: list[fa.Run], tmp_path: Path
) -> None:
    with pytest.raises(fa.LogError, match="unit"):
        fa.discover(axis, fit=[{"t_s": [0.0, 1.0], "speed": [0.0, 1.0]}], check=[logs[1]])
    with pytest.raises(TypeError, match="a int is no log"):
        fa.discover(axis, fit=[3], check=[logs[1]])  # type: ignore[list-item]
    with pytest.raises(FileNotFoundError, match="none.csv"):
        fa.discover(axis, fit=[tmp_path / "none.csv"], check=[logs[1]])
    columns = {name: logs[0][name] for name in logs[0]}
    columns["position_m"] = 1e3 * columns["position_m"]
    with pytest.raises(fa.LogError, match="fit 1"):
        fa.discover(axis, fit=[columns], check=[logs[1]])
    with pytest.raises(fa.LogError, match="check 1 holds the same samples as fit 1"):
        fa.discover(axis, fit=[logs[0]], check=[logs[0]])
    with pytest.raises(fa.SearchError, match="perpetual-motion"):
        fa.discover(axis, fit=[logs[0]], check=[logs[1]], reject=["perpetual-motion"])


def test_a_file_and_its_frame_are_one_log(
    axis: fa.Axis, logs: list[fa.Run], tmp_path: Path
) -> None:
    pandas = pytest.importorskip("pandas")
    path = tmp_path / "log.csv"
    logs[0].to_pandas().to_csv(path, index=False)
    frame = pandas.read_csv(path)
    assert np.array_equal(frame["position_m"].to_numpy(), logs[0]["position_m"])
    with pytest.raises(fa.LogError, match="holds the same samples as .*log.csv"):
        fa.discover(axis, fit=[path], check=[frame])
