"""Arrays in every form: taken, or refused in words."""

import feed_axis as fa
import numpy as np
import pytest

X = np.linspace(-1, 1, 60)
Y = np.tanh(2 * X)


def trained(x: object, y: object, hidden: object = 3) -> fa.Network:
    return fa.Network.train(x, y, hidden=hidden, epochs=30, threads=1)  # type: ignore[arg-type]


def test_one_variable_is_a_column() -> None:
    whole = trained(X[:, None], Y[:, None], [3])
    for x, y in [
        (X, Y),
        (X.tolist(), Y.tolist()),
        (X[:, None], Y),
        (X, Y[:, None]),
        (np.repeat(X, 2)[::2], Y[::-1][::-1]),
        (np.asfortranarray(X[:, None]), np.array(Y, dtype=object)),
    ]:
        for hidden in (3, [3], np.array([3])):
            net = trained(x, y, hidden)
            assert net.shape == (1, [3], 1)
            assert np.array_equal(net.predict(X), whole.predict(X[:, None]))


def test_other_kinds_of_numbers_are_taken() -> None:
    x = np.arange(40)
    for kind in (np.int32, np.uint8, np.float32, np.float64, ">f8"):
        net = trained(x.astype(kind), (x % 5).astype(kind))
        assert np.array_equal(net.predict(x), trained(x, x % 5).predict(x))
    assert fa.LuGre.liu2025().steady_state([1, 2]).shape == (2,)


def test_rows_are_what_a_network_takes() -> None:
    x = np.c_[X, X**2, X[::-1]]
    net = trained(x, Y)
    whole = net.predict(x)
    assert whole.shape == (60, 1)
    assert np.array_equal(net.predict(x[7]), whole[7:8])
    assert np.array_equal(net.predict(list(x[7])), whole[7:8])
    assert np.array_equal(net.predict(x[::-3]), whole[::-3])
    assert np.array_equal(net.predict(np.asfortranarray(x)), whole)
    one = trained(X, Y)
    assert np.array_equal(one.predict(0.5), one.predict([[0.5]]))
    for wrong, shape in [(0.5, "()"), (x[:, :2], "(60, 2)"), (x[0, :2], "(2,)"), (x[None], "(1, 60, 3)")]:
        with pytest.raises(fa.NetworkError) as refused:
            net.predict(wrong)
        assert f"x has the shape {shape}; valid: rows of 3" in str(refused.value)


def test_what_is_no_table_is_refused_in_words() -> None:
    with pytest.raises(fa.NetworkError, match=r"x has the shape \(\); valid: a row a sample"):
        trained(1.0, Y)
    with pytest.raises(fa.NetworkError, match=r"y has the shape \(1, 60, 1\)"):
        trained(X, Y[None, :, None])
    nothings: list[object] = [["a"] * 60, "abc", None, {}, X + 1j, [[1.0], [1.0, 2.0]], [None, "a"]]
    for nothing in nothings:
        with pytest.raises(TypeError, match="^y .*; valid: real numbers"):
            trained(X, nothing)
    with pytest.raises(fa.NetworkError):
        trained(X, Y[:-1])
    for bad in ([2.5], 0, [-1]):
        with pytest.raises(ValueError, match="neurons; valid: whole numbers"):
            trained(X, Y, bad)


def test_speeds_are_a_line_or_one() -> None:
    law = fa.LuGre.liu2025()
    speeds = np.linspace(0.1, 5, 30)
    steady = law.steady_state(speeds)
    assert np.array_equal(law.steady_state(speeds[4]), steady[4:5])
    assert np.array_equal(law.steady_state(speeds[::-2]), steady[::-2])
    assert np.array_equal(law.simulate(3.0, 1e-3), law.simulate([3], 1e-3))
    with pytest.raises(fa.ParameterError, match=r"speed_rad_s has the shape \(30, 1\); valid: an"):
        law.steady_state(speeds[:, None])
    with pytest.raises(fa.ParameterError, match=r"speed_rad_s has the shape \(30, 1\); valid: an"):
        law.simulate(speeds[:, None], 1e-3)
    with pytest.raises(TypeError, match="speed_rad_s holds"):
        law.steady_state(["fast"])  # type: ignore[list-item,arg-type,unused-ignore]


def test_bounds_are_pairs() -> None:
    pairs = [(0.0, 1.5), (-1.0, 1.0)]
    points = fa.latin_hypercube(9, pairs, seed=3)
    for given in (np.array(pairs), [list(pair) for pair in pairs], np.asfortranarray(pairs)):
        assert np.array_equal(points, fa.latin_hypercube(9, given, seed=3))
    assert fa.latin_hypercube(9, (0, 2)).shape == (9, 1)
    with pytest.raises(fa.ParameterError, match=r"bounds has the shape \(3,\); valid: rows of 2"):
        fa.latin_hypercube(9, [0.0, 1.0, 2.0])


def test_a_reference_is_three_numbers() -> None:
    for given in ((1.0, 2.0, 3.0), [1, 2, 3], np.array([1, 2, 3], dtype=np.float32)):
        sample = fa.Sample(reference=given, next_reference=given)
        assert sample.reference == sample.next_reference == (1.0, 2.0, 3.0)
    with pytest.raises(ValueError, match=r"a reference has the shape \(2,\); valid: three numbers"):
        fa.Sample(reference=(1.0, 2.0))


def test_columns_of_a_log_are_lines(axis: fa.Axis, run: fa.Run) -> None:
    columns = {name: run[name] for name in run}
    square = columns | {"position_m": run["position_m"][:, None]}
    with pytest.raises(fa.LogError, match="position_m has the shape .*; valid: an array of one dimension"):
        fa.discover(axis, fit=[square], check=[run])
    words = columns | {"position_m": ["here"] * run.cycles}
    with pytest.raises(TypeError, match="position_m holds <U4; valid: real numbers"):
        fa.discover(axis, fit=[words], check=[run])
    for one in (run, columns, "fit.csv"):
        with pytest.raises(TypeError, match="is one log; valid: a list of logs"):
            fa.discover(axis, fit=one, check=[run])  # type: ignore[arg-type]
