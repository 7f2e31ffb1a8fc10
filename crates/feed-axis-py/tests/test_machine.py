"""Machines of several axes on one path."""

import copy
import pickle
from pathlib import Path

import feed_axis as fa
import numpy as np
import pytest


@pytest.fixture(scope="module")
def stage(root: Path) -> fa.Axis:
    """A stage that is simulated fast."""
    return fa.Axis.load(root / "data/axes/linear-stage.toml")


@pytest.fixture(scope="module")
def machine(stage: fa.Axis) -> fa.Machine:
    """Two of them, with a squareness error."""
    coupling = [{"of": "x", "by": "y", "squareness_um_per_m": 200, "crosstalk_um_per_m_per_s2": 3}]
    return fa.Machine([stage, stage], name="two stages", coupling=coupling)


@pytest.fixture(scope="module")
def circle(machine: fa.Machine) -> fa.Contour:
    """A small circle under a plan."""
    return machine.contour(fa.Toolpath.circle(0.01), compensation="plan")


def test_a_file_makes_a_machine(root: Path, stage: fa.Axis) -> None:
    machine = fa.Machine(root / "data/machines/liu2025-xy.toml")
    assert machine == fa.Machine.load(str(root / "data/machines/liu2025-xy.toml"))
    assert machine.name == "liu2025-xy" and [a.name for a in machine.axes] == ["liu2025-machine", "liu2025-y"]
    three = fa.Machine(root / "data/machines/gantry-xyz.toml")
    assert len(three.axes) == 3 and len(three.drives) == 4
    beam = {"axis": "y", "second": stage, "stiffness_n_per_m": 1e6}
    assert len(fa.Machine({"y": stage, "x": stage}, gantry=[beam]).drives) == 3
    for one in (machine, three):
        assert pickle.loads(pickle.dumps(one)) == copy.deepcopy(one) == one
        assert hash(copy.copy(one)) == hash(one)
    assert machine != three


def test_what_is_no_machine_is_refused(root: Path, axis: fa.Axis, stage: fa.Axis, tmp_path: Path) -> None:
    with pytest.raises(FileNotFoundError, match="none.toml"):
        fa.Machine("none.toml")
    file = tmp_path / "machine.toml"
    file.write_text("schema = 1\nname = 'm'\n")
    with pytest.raises(fa.MachineError, match=r"machine.toml(.|\n)*axes"):
        fa.Machine(file)
    with pytest.raises(TypeError, match="axes holds 1; valid: the path of a machine file"):
        fa.Machine([stage])
    with pytest.raises(TypeError, match="has the key 'u'|has the key \"u\""):
        fa.Machine({"x": stage, "u": stage})
    with pytest.raises(TypeError, match="coupling is a dict; valid: a list of dicts"):
        fa.Machine([stage, stage], coupling={"of": "x"})  # type: ignore[arg-type]
    with pytest.raises(fa.MachineError, match="stiff"):
        fa.Machine([stage, stage], coupling=[{"of": "x", "by": "y", "stiffness": 1}])
    with pytest.raises(fa.MachineError, match="turns; valid: an axis that moves along a line"):
        fa.Machine([stage, fa.new("rotary-table")])
    with pytest.raises(TypeError, match="gantry has no Axis as its second"):
        fa.Machine([stage, stage], gantry=[{"axis": "x", "stiffness_n_per_m": 1e6}])
    machine = fa.Machine([stage, stage])
    with pytest.raises(fa.MachineError, match="3 coordinates.*2 axes"):
        machine.contour(fa.Toolpath.circle(0.01, tilt_rad=0.5))
    with pytest.raises(fa.StrategyError, match="the trained network"):
        machine.contour(fa.Toolpath.circle(0.01), compensation="network")
    with pytest.raises(fa.StrategyError, match='no strategy "wish"; valid: none, network'):
        machine.contour(fa.Toolpath.circle(0.01), compensation="wish")
    with pytest.raises(fa.StrategyError, match="1 compensations for 2 drives"):
        machine.contour(fa.Toolpath.circle(0.01), compensation=[fa.Compensator(stage, "plan")])
    with pytest.raises(fa.MotionError, match="feed|velocity"):
        machine.contour(fa.Toolpath.circle(0.01), feed=-1)
    with pytest.raises(fa.SimulationError, match="axis 2"):
        machine.contour(fa.Toolpath.circle(0.06))
    with pytest.raises(ValueError, match="laps is 0; valid: a whole number from 1 to 100"):
        machine.contour(fa.Toolpath.circle(0.01), laps=0)
    with pytest.raises(TypeError, match="correct is a str; valid: True"):
        machine.contour(fa.Toolpath.circle(0.01), correct="yes")  # type: ignore[arg-type]


def test_a_circle_has_the_figures_of_its_arrays(circle: fa.Contour, tmp_path: Path) -> None:
    assert list(circle) == ["clockwise", "counterclockwise"] and len(circle) == 2 and "clockwise" in circle
    found = circle.figures
    assert found is not None and circle.radius_m == 0.01
    for direction in circle:
        lap = circle[direction]
        radial = np.hypot(lap["x_m"], lap["y_m"]) - 0.01
        assert np.allclose(radial, lap["deviation_m"], rtol=0, atol=1e-15)
        assert found[direction]["f_max_m"] == pytest.approx(radial.max(), abs=1e-12)
        assert found[direction]["f_min_m"] == pytest.approx(radial.min(), abs=1e-12)
        assert np.allclose(np.abs(radial), lap["error_m"], rtol=0, atol=1e-9)
    # 200 µm/m and 3 µm/(m/s²) on a circle of 10 mm at 0.05 m/s: ½ φ R − ½ k v²/R = 0.625 µm at 45°.
    assert abs(1e6 * circle.max_error - 0.625) < 0.03
    # Of an ellipse of ± 0.625 µm the minimum zone is twice as wide.
    assert abs(1e6 * found["g_bidirectional_m"] - 1.25) < 0.06
    frame = circle.to_pandas()
    assert len(frame) == sum(len(circle[d]["s_m"]) for d in circle)
    assert frame["error_m"].max() == pytest.approx(circle.max_error, rel=1e-12)
    assert circle.to_polars().columns == list(frame.columns)
    page = circle.to_html(tmp_path / "circle.html")
    assert (tmp_path / "circle.html").read_text() == page and "Radial deviation over angle" in page
    assert "<table>" in circle._repr_html_() and "two stages" in repr(circle)
    assert len(circle.reversals) == 8 and circle.corners == []
    assert len(circle.plot().lines) == 2
    with pytest.raises(KeyError, match="there are: clockwise, counterclockwise"):
        circle["left"]
    again = pickle.loads(pickle.dumps(circle))
    assert again == circle and again.figures == found and again.to_html() == page


def test_squareness_is_found_and_taken_away(machine: fa.Machine, circle: fa.Contour) -> None:
    done: list[tuple[str, int, int | None]] = []
    found = machine.identify(
        [0.02, 0.05], radius=0.01, compensation="plan", progress=lambda *at: done.append(at)
    )
    assert abs(1e6 * found.squareness[0] - 200) < 5 and found.squareness[1] < 5e-6
    assert abs(1e6 * found.crosstalk[0] - 3) < 1
    assert done and done[-1] == ("laps", 4, 4)
    corrected = machine.contour(fa.Toolpath.circle(0.01), compensation="plan", correct=found)
    known = machine.contour(fa.Toolpath.circle(0.01), compensation="plan", correct=True)
    assert corrected.max_error < 0.15 * circle.max_error and known.max_error < 0.15 * circle.max_error
    with pytest.raises(fa.SearchError, match="5 of 6 unknowns"):
        machine.identify(0.05, radius=0.01, compensation="plan")
    assert pickle.loads(pickle.dumps(found)) == found


def test_circles_of_a_ball_bar_are_fitted() -> None:
    # A radius by angle, as a ball bar shows it: squareness of 30 µm/m, cross-talk of 12 µm/(m/s²), a centre that is off.
    angle = np.linspace(0, 2 * np.pi, 720, endpoint=False)
    circles = []
    for feed in (0.05, 0.15):
        acceleration = feed**2 / 0.05
        radial = (0.5 * 30e-6 * 0.05 - 0.5 * 12e-6 * acceleration) * np.sin(2 * angle) + 2e-6 * np.cos(angle)
        points = (0.05 + radial)[:, None] * np.column_stack([np.cos(angle), np.sin(angle)])
        circles.append((feed, "clockwise", points))
    found = fa.fit_circles(circles, radius=0.05)  # type: ignore[arg-type]
    assert abs(found.squareness[0] - 30e-6) < 1e-9 and abs(found.crosstalk[0] - 12e-6) < 1e-9
    assert abs(found.centre[0][0] - 2e-6) < 1e-9 and found.lag is None and found.residual < 1e-9
    with pytest.raises(fa.SearchError, match='circle 1 is "left"; valid: "clockwise"'):
        fa.fit_circles([(0.05, "left", points)], radius=0.05)  # type: ignore[list-item]
    with pytest.raises(fa.SearchError, match="3 column"):
        fa.fit_circles([(0.05, "clockwise", np.zeros((9, 3)))], radius=0.05)
    with pytest.raises(fa.SearchError, match="3 radii for 1 circles"):
        fa.fit_circles([(0.05, "clockwise", points)], radius=[0.05, 0.04, 0.03])


def test_paths_are_taken_as_points_text_and_curves(stage: fa.Axis, tmp_path: Path) -> None:
    machine = fa.Machine([stage, stage])
    corners = np.array([[0, 0], [0.01, 0], [0.01, 0.005]])
    by_points = machine.contour(corners, compensation="plan", laps=2)
    assert by_points.figures is None and by_points.radius_m is None and len(by_points.laps) == 2
    assert [round(1e3 * c["s_m"], 6) for c in by_points.corners] == [10.0]
    text = "G21 G90\nF3000\nG1 X10\nG1 Y5\n"
    by_text = machine.contour(text, compensation="plan", laps=2)
    assert by_text.max_error == pytest.approx(by_points.max_error, rel=1e-6)
    assert len(by_text.plot().lines) == 1
    blended = fa.Toolpath.points(corners, blend_m=1e-3)
    assert machine.contour(blended, compensation="plan").corners == []
    assert blended.length_m < 0.015 and fa.Toolpath.gcode("G64 P1\n" + text).length_m == pytest.approx(blended.length_m)
    assert machine.contour(fa.Toolpath.gcode(text, blend_m=1e-4, blend_shape="arc")).corners == []
    with pytest.raises(fa.MotionError, match='blend_shape is "clothoid"; valid: quintic, arc, parabola'):
        fa.Toolpath.points(corners, blend_m=1e-3, blend_shape="clothoid")  # type: ignore[arg-type]
    file = tmp_path / "part.ngc"
    file.write_text(text)
    assert abs(fa.Toolpath.load(file).length_m - 0.015) < 1e-12
    # A quarter of a circle of 5 mm as a rational curve.
    weights, knots = [1, 0.5**0.5, 1], [0, 0, 0, 1, 1, 1]
    quarter = fa.Toolpath.nurbs([[0.005, 0], [0.005, 0.005], [0, 0.005]], knots, degree=2, weights=weights)
    assert abs(quarter.length_m - 0.005 * np.pi / 2) < 1e-9
    at = quarter.positions(50)
    assert at.shape == (50, 2) and np.allclose(np.hypot(*at.T), 0.005, rtol=0, atol=1e-12)
    one = machine.contour(quarter, feed=0.01, feeds=[0.005, 0.02])
    assert [row["feed_m_s"] for row in one.feeds] == [0.005, 0.02]
    assert one.feeds[0]["last_max_error_m"] < one.feeds[1]["last_max_error_m"]
    paths = [quarter, blended, fa.Toolpath.points(corners), fa.Toolpath.gcode(text), fa.Toolpath.circle(0.02, tilt_rad=0.1)]
    for path in [*paths, fa.Toolpath.butterfly()]:
        assert pickle.loads(pickle.dumps(path)) == path and path.positions(3).shape[0] == 3
    with pytest.raises(fa.MotionError, match="line 2: Q7"):
        machine.contour("G21\nQ7")
    with pytest.raises(fa.MotionError, match="part.ngc: line 1"):
        file.write_text("what")
        fa.Toolpath.load(file)
    with pytest.raises(fa.MotionError, match="1 coordinate"):
        machine.contour([1.0, 2.0])  # type: ignore[list-item]
    with pytest.raises(fa.MotionError, match="radius"):
        fa.Toolpath.circle(-1)
    with pytest.raises(TypeError, match="a dict is no path; valid: a Toolpath"):
        machine.contour({})  # type: ignore[arg-type]


def test_each_drive_may_have_its_own_compensation(stage: fa.Axis) -> None:
    machine, path = fa.Machine([stage, stage]), fa.Toolpath.circle(0.01)
    plan = fa.Compensator(stage, "plan")
    both = machine.contour(path, compensation=[plan, plan])
    assert both == machine.contour(path, compensation="plan")
    # A model whose load is 20 % too light leaves more.
    values = stage.to_dict()
    values["mechanism"]["slide_mass_kg"] *= 0.8
    wrong = fa.Compensator(fa.Axis.from_dict(values), "plan")
    assert machine.contour(path, compensation=[wrong, plan]).max_error > 3 * both.max_error
