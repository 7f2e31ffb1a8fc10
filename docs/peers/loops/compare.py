"""Loops of example axes, by python-control: python compare.py

python-control has the sampled drive alone, as `Axis.state_space` gives it; controllers, differences
and filters are built here from the numbers of the axis files. Compared are the margins of
`Axis.analyse`, the stability of loops with other gains, and the response that `Axis.frf` estimates from
a simulated log with noise. Exit code 1 if a figure differs by more than its limit, about three times
what was measured.
"""

import math
import sys
from pathlib import Path

import control as ct
import feed_axis as fa
import numpy as np

ROOT = Path(__file__).resolve().parents[3]
RPM = 2 * math.pi / 60
POINTS = 4000
LIMITS = {"sensitivity": 0.0005, "gain": 0.006, "phase": 0.002, "delay": 4e-5, "radius": 1e-10, "frf": 0.05}


# What the speed controller sees, what the position controller sees, and k_p, k_i, P from the file's [control]; P is speed per
# position as these two see them.
CASES = {
    "liu2025": (
        "motor_speed",
        "position",
        lambda c: (
            c["speed_proportional_a_per_rpm"] / RPM,
            c["speed_integral_a_per_rpm_s"] / RPM,
            c["position_gain_rpm_per_mm"] * RPM * 1e3,
        ),
    ),
    "linear-motor": (
        "difference of position",
        "position",
        lambda c: (
            c["speed_proportional_a_s_per_m"],
            c["speed_proportional_a_s_per_m"] / (1e-3 * c["speed_integral_time_ms"]),
            c["kv_m_per_min_per_mm"] / 0.06,
        ),
    ),
    "rotary-table": (
        "difference of position",
        "position",
        lambda c: (
            c["speed_proportional_a_s_per_rad"],
            c["speed_proportional_a_s_per_rad"] / (1e-3 * c["speed_integral_time_ms"]),
            c["kv_per_s"],
        ),
    ),
    "belt": (
        "difference of motor_angle",
        "motor_angle",
        lambda c: (
            c["speed_proportional_a_s_per_rad"],
            c["speed_proportional_a_s_per_rad"] / (1e-3 * c["speed_integral_time_ms"]),
            c["kv_per_s"],
        ),
    ),
}


def closed(axis, stuck, speed_by, position_by, gains):
    """The loop cut at the command and the speed loop in it, and the greatest pole of the closed loop."""
    s = axis.state_space(stuck=stuck)
    dt, n, (kp, ki, p) = s["dt_s"], len(s["A"]), gains
    rows = dict(zip(s["outputs"], s["C"], strict=True))
    a, b, position = s["A"], s["B"][:, :1], rows[position_by]
    if speed_by.startswith("difference of "):
        # One state more: what it is the difference of, a cycle ago.
        of = rows[speed_by.removeprefix("difference of ")]
        a = np.block([[a, np.zeros((n, 1))], [of, np.zeros((1, 1))]])
        b = np.vstack([b, [[0.0]]])
        speed, position = np.append(of, -1.0) / dt, np.append(position, 0.0)
    else:
        speed = rows[speed_by]
    controller = ct.ss([[1.0]], [[1.0]], [[ki * dt]], [[kp + ki * dt]], dt)

    def loop(row):
        return ct.series(ct.ss(a, b, [row], [[0.0]], dt), controller)

    whole = loop(speed + p * position)
    return whole, loop(speed), radius(whole)


def radius(whole):
    """Greatest modulus of the poles of a loop that is closed."""
    return float(np.abs(ct.feedback(whole, 1).poles()).max())


def closed_pid(axis, stuck, values):
    """The same of a PID controller of the position, whose derivative is a difference behind its low pass; no speed loop."""
    s = axis.state_space(stuck=stuck)
    dt, k = s["dt_s"], values["control"]
    pole = math.exp(-2 * math.pi * k["derivative_lowpass_hz"] * dt)
    derivative = k["derivative_n_s_per_m"] * (1 - pole) / dt * ct.tf([1, -1], [1, -pole], dt)
    integral = k["integral_n_per_m_s"] * dt * ct.tf([1, 0], [1, -1], dt)
    plant = ct.ss(s["A"], s["B"][:, :1], [dict(zip(s["outputs"], s["C"], strict=True))["position"]], [[0.0]], dt)
    whole = ct.series(plant, ct.ss(k["proportional_n_per_m"] + integral + derivative))
    return whole, None, radius(whole)


def loops(axis, name, stuck):
    """The same with the gains of the axis."""
    values = axis.to_dict()
    if values["control"].get("kind") == "pid":
        return closed_pid(axis, stuck, values)
    speed, position, of = CASES[name]
    return closed(axis, stuck, speed, position, of(values["control"]))


def cuts(whole, speed):
    """Frequencies, and the loops cut at the command and at the position on them."""
    omega = np.geomspace(1.0, math.pi / whole.dt * (1 - 1e-9), POINTS)
    total = ct.frequency_response(whole, omega).frdata[0, 0]
    if speed is None:
        return omega, {"command": total, "position": total}
    inner = ct.frequency_response(speed, omega).frdata[0, 0]
    return omega, {"command": total, "position": (total - inner) / (1 + inner)}


def margins(omega, loop):
    """Maximum sensitivity, also with a cycle of delay, gains at which it is unstable, phase and delay."""
    found = ct.stability_margins(ct.frd(loop, omega, smooth=True), returnall=True)
    gains, phases, _, _, at, _ = found
    # Wrapped: a phase that is ahead of −180° by a turn is one behind it.
    late = [math.radians(phase % 360) / w for phase, w in zip(phases, at, strict=True)]
    return {
        "sensitivity": float((1 / np.abs(1 + loop)).max()),
        "gain_up": min((g for g in gains if g > 1), default=None),
        "gain_down": max((g for g in gains if 0 < g < 1), default=None),
        "phase": min((abs((phase + 180) % 360 - 180) for phase in phases), default=None),
        "delay": min(late, default=None),
    }


def compare_margins(worst):
    """Of each axis, sliding and stuck, at both cuts."""
    print("axis, state, cut: maximum sensitivity, gain up, gain down, phase, delay: ours, python-control")
    for name in (*CASES, "linear-stage"):
        axis = fa.Axis.load(ROOT / f"data/axes/{name}.toml")
        corners = axis.analyse(positions=[axis.stroke[2]], masses=1.0)["corners"]
        for corner in corners:
            stuck = corner["at"]["stuck"]
            whole, inner, greatest = loops(axis, name, stuck)
            omega, both = cuts(whole, inner)
            state = "stuck" if stuck else "sliding"
            worst["radius"] = max(worst["radius"], abs(greatest - corner["radius"]))
            for cut, loop in both.items():
                other, own = margins(omega, loop), corner[cut]
                ours = {
                    "sensitivity": own["sensitivity"],
                    "gain_up": own["gain_up"],
                    "gain_down": own["gain_down"],
                    "phase": own["phase_deg"],
                    "delay": own["delay_s"],
                }
                cells = []
                for key, value in ours.items():
                    cells.append(f"{show(value)} {show(other[key])}")
                    if value is not None and other[key] is not None:
                        kind = key.split("_")[0]
                        relative = kind in ("gain", "delay")
                        error = abs(value - other[key]) / (abs(value) if relative else 1)
                        worst[kind] = max(worst[kind], error)
                    elif (value is None) != (other[key] is None):
                        print(f"  {name} {state} {cut} {key}: one has none")
                print(f"{name}, {state}, {cut}: " + ", ".join(cells), flush=True)


def show(value):
    return "none" if value is None else f"{value:.5g}"


def compare_stability(count):
    """Verdicts on gains that are random multiples of the file's."""
    draw = np.random.default_rng(51)
    same = unstable = total = 0
    for name in (*CASES, "linear-stage"):
        text = fa.Axis.load(ROOT / f"data/axes/{name}.toml").to_dict()
        keys = [k for k in text["control"] if k.startswith(("kv", "position_gain", "speed_proportional", "proportional", "derivative_n"))]
        for _ in range(count):
            values = {part: dict(v) if isinstance(v, dict) else v for part, v in text.items()}
            for key in keys:
                values["control"][key] *= float(10 ** draw.uniform(-0.3, 1.5))
            values.pop("experiment", None)
            axis = fa.Axis.from_dict(values)
            corner = axis.analyse(positions=[axis.stroke[2]], masses=1.0)["corners"][0]
            *_, greatest = loops(axis, name, False)
            same += (greatest < 1) == corner["stable"]
            unstable += not corner["stable"]
            total += 1
    print(f"stability: {same} of {total} verdicts the same, {unstable} of them unstable")
    return same == total


def compare_response(worst):
    """The paper's axis, 2 A of random signs while it slides at 20 mm/s, noise of good sensors."""
    axis = fa.Axis.load(ROOT / "data/axes/liu2025.toml")
    move = fa.SCurve(0.6, 0.702, speed_m_s=0.02, acceleration_m_s2=0.225, jerk_m_s3=1.2)
    cycles = round(5.0 / axis.period_s)
    signs = np.repeat(np.random.default_rng(1).choice([-2.0, 2.0], cycles // 2 + 1), 2)[:cycles]
    signs[: round(0.4 / axis.period_s)] = 0.0
    (found,) = axis.frf(axis.simulate(move, noise=1.0, excitation=signs))
    s = axis.state_space(position=found["position"])
    plant = ct.ss(s["A"], s["B"][:, :1], s["C"][2:], np.zeros((1, 1)), s["dt_s"])
    lines = [line for line in found["motor_speed"] if line["coherence"] >= 0.9]
    f = np.array([line["frequency_hz"] for line in lines])
    ours = np.array([line["value"] for line in lines]) @ [1, 1j]
    theirs = ct.frequency_response(plant, 2 * math.pi * f).frdata[0, 0]
    error = np.abs(ours / theirs - 1)
    for low, high in ((2, 10), (10, 40), (40, 160), (160, 500)):
        inside = (f >= low) & (f < high)
        print(f"response, {low} to {high} Hz: {inside.sum()} lines, median error {100 * np.median(error[inside]):.2f} %")
    worst["frf"] = float(np.median(error[(f >= 2) & (f < 500)]))


def main():
    worst = dict.fromkeys(LIMITS, 0.0)
    compare_margins(worst)
    same = compare_stability(15)
    compare_response(worst)
    print("greatest difference: " + ", ".join(f"{key} {value:.2g}" for key, value in worst.items()))
    if not same or any(value > LIMITS[key] for key, value in worst.items()):
        sys.exit("more than the limits")


main()
