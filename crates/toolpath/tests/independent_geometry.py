"""Length and least radius of the butterfly by scipy: basis functions of its BSpline, quad, a bounded search.
Prints the constants of tests/geometry.rs."""

import re
from pathlib import Path

import numpy as np
from scipy.integrate import quad
from scipy.interpolate import BSpline
from scipy.optimize import minimize_scalar

text = (Path(__file__).parent.parent / "src/named.rs").read_text()
table = text[text.index("const BUTTERFLY: ") :]
rows = [[float(x) for x in row.split(",")] for row in re.findall(r"^    \[([-0-9., ]+)\],", table, re.M)]
knots = re.findall(r"[0-9.]+", table[table.index("KNOTS: [f64; 49] = [") + 20 :])
knots = [0.0] * 3 + [float(k) for k in knots] + [1.0] * 3
rows = np.array(rows)
w = rows[:, 2]
A = BSpline(knots, rows[:, :2] * w[:, None] * 1e-3, 3)
W = BSpline(knots, w, 3)


def derivatives(u):
    a, b = [A.derivative(k)(u) if k else A(u) for k in range(3)], [W.derivative(k)(u) if k else W(u) for k in range(3)]
    c = a[0] / b[0]
    d = (a[1] - b[1] * c) / b[0]
    return c, d, (a[2] - 2 * b[1] * d - b[2] * c) / b[0]


def speed(u):
    return np.hypot(*derivatives(u)[1])


def radius(u):
    _, d, e = derivatives(u)
    return np.hypot(*d) ** 3 / abs(d[0] * e[1] - d[1] * e[0])


edges = sorted(set(knots))
length = sum(
    quad(speed, lo, hi, epsabs=1e-16, epsrel=1e-14, limit=500)[0]
    for a, b in zip(edges, edges[1:])
    for lo, hi in zip(np.linspace(a, b, 17), np.linspace(a, b, 17)[1:])
)
us = np.linspace(0, 1, 200001)
i = int(np.argmin([radius(u) for u in us]))
best = minimize_scalar(radius, bounds=(us[i - 1], us[i + 1]), method="bounded", options={"xatol": 1e-13})
print(f"const BUTTERFLY_LENGTH: f64 = {length!r};\nconst BUTTERFLY_RADIUS: f64 = {float(best.fun)!r};")
