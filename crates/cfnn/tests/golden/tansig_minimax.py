"""The coefficients of src/tansig.rs.

    python3 crates/cfnn/tests/golden/tansig_minimax.py    (needs mpmath; 1.3.0 was used)

With s = f^2, 0 <= s <= 1/4, the minimax approximation P(s)/Q(s), in the relative
error, of tanh(f ln2 / 2) / f: Remez's exchange in 50 digits, P and Q of degree two
for f64 and of degree one for f32, scaled so that the leading coefficient of P is 1.
Prints the coefficients from the highest power down, rounded to the precision they
are used in, and the relative error that the unrounded ones reach; then the same
error for the coefficients that stand in src/tansig.rs, and how far they lie from
those found. Those of f64 lie some 1e-10 away, all in the one direction in which the
error hardly changes; what they lose, they lose by being rounded.
"""

import re
import struct
from pathlib import Path

from mpmath import cos, findroot, log, matrix, mp, mpf, pi, sqrt, tanh

mp.dps = 50
TOP = mpf(1) / 4


def wanted(s):
    half = log(2) / 2
    return half if s < mpf(10) ** -40 else tanh(sqrt(s) * half) / sqrt(s)


def value(coefficients, s):
    total = mpf(0)
    for c in coefficients:
        total = total * s + c
    return total


def remez(degree):
    count = 2 * degree + 2
    points = [TOP * (1 - cos(pi * i / (count - 1))) / 2 for i in range(count)]
    start = None
    for _ in range(30):
        # Unknown: P without its leading 1, all of Q, and the error E.
        def levelled(*u):
            p, q, e = [mpf(1), *u[:degree]], u[degree : 2 * degree + 1], u[-1]
            return [value(p, s) - wanted(s) * (1 + (-1) ** i * e) * value(q, s) for i, s in enumerate(points)]

        if start is None:
            # Linear for E = 0 at all points but the last.
            rows, right = matrix(count - 1), matrix(count - 1, 1)
            for i, s in enumerate(points[:-1]):
                for k in range(degree):
                    rows[i, k] = s ** (degree - 1 - k)
                for k in range(degree + 1):
                    rows[i, degree + k] = -wanted(s) * s ** (degree - k)
                right[i] = -(s**degree)
            start = [*mp.lu_solve(rows, right), mpf(0)]
        start = list(findroot(levelled, start, tol=mpf(10) ** -60, maxsteps=100))
        p, q = [mpf(1), *start[:degree]], start[degree : 2 * degree + 1]

        def error(s):
            return value(p, s) / (wanted(s) * value(q, s)) - 1

        moved = extremes(error, points)
        change = max(abs(a - b) for a, b in zip(points, moved))
        points = moved
        if change < mpf(10) ** -20:
            break
    return p, q, max(abs(error(s)) for s in points)


def extremes(error, points):
    """Where the error is largest between its neighbours; the ends stay."""
    moved = [points[0]]
    for left, at, right in zip(points, points[1:], points[2:]):
        low, high, sign = (left + at) / 2, (at + right) / 2, 1 if error(at) > 0 else -1
        ratio = (sqrt(5) - 1) / 2
        for _ in range(110):
            a, b = high - ratio * (high - low), low + ratio * (high - low)
            if sign * error(a) > sign * error(b):
                high = b
            else:
                low = a
        moved.append((low + high) / 2)
    return [*moved, points[-1]]


def single(x):
    return struct.unpack("<f", struct.pack("<f", float(x)))[0]


def in_use(name):
    """The coefficients in the source: P without its leading 1, then Q."""
    source = (Path(__file__).parents[2] / "src" / "tansig.rs").read_text().replace("_", "")
    body = re.search(rf"fn tansig{name}.*?\n}}", source, re.S).group()
    products = re.findall(r"\d+\.\d{4,}", body[body.index("let fp") :])
    return [mpf(c) for c in products]


for name, degree, rounded in (("f64", 2, float), ("f32", 1, single)):
    p, q, worst = remez(degree)
    print(name, "P", [rounded(c) for c in p], "Q", [rounded(c) for c in q])
    used = [mpf(rounded(c)) for c in in_use(name)]
    mine = [mpf(1), *used[:degree]], used[degree:]
    grid = [TOP * i / 2000 for i in range(2001)]
    reached = max(abs(value(mine[0], s) / (wanted(s) * value(mine[1], s)) - 1) for s in grid)
    apart = max(abs(a / b - 1) for a, b in zip([*mine[0], *mine[1]], [*p, *q]))
    print(name, "relative error found", mp.nstr(worst, 3), "in use", mp.nstr(reached, 3), "apart", mp.nstr(apart, 3))
