"""The positions that tests/scurve.rs compares trajectory 1 with.

    python3 crates/trajectories/tests/golden/trajectory_1.py

Trajectory 1 of Table 12 (Liu, Guo, Liu, Niu 2025): 300 mm from 600 mm at 100 mm/s,
225 mm/s^2, 1200 mm/s^3. Seven segments of constant jerk, each carried on from the
end of the last in exact fractions; printed to 12 decimals. No package needed;
checked with Python 3.11.
"""

from fractions import Fraction as F

V, A, J, START, DISTANCE = F(1, 10), F(225, 1000), F(12, 10), F(6, 10), F(3, 10)

tau = A / J
alpha = V / A - tau
cruise = DISTANCE / V - (2 * tau + alpha)
SEGMENTS = [(tau, J), (alpha, 0), (tau, -J), (cruise, 0), (tau, -J), (alpha, 0), (tau, J)]


def position(t):
    s, v, a = START, F(0), F(0)
    for length, jerk in SEGMENTS:
        h = min(t, length)
        s, v, a = s + h * (v + h * (a / 2 + h * jerk / 6)), v + h * (a + h * jerk / 2), a + h * jerk
        t -= h
    return s, v, a


duration = sum(length for length, _ in SEGMENTS)
assert position(duration) == (START + DISTANCE, 0, 0)
print("duration", duration, float(duration))
for milliseconds in (50, 187, 188, 400, 631, 632, 1800, 3000, 3190, 3444, 3600, 3631):
    s, _, _ = position(F(milliseconds, 1000))
    units = round(s * 10**12)
    print(f"{milliseconds / 1000:.3f} 0.{units:012d}")
