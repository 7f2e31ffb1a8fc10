"""Axes that this project's search has not seen: rigid or of two masses, with friction of other laws, simulated by
explicit steps of 25 µs and logged with coloured noise, quantisation and jitter. Shares no code with the crates."""

import math

import numpy as np

STEP = 2.5e-5  # s

# N, N·s/m, m, 1/s, N·s/m, s, Hz, N per unit of the log, N, kg, m, m/s; "fall": Stribeck friction, N, and its speed, m/s
LINEAR_MOTOR = {
    "axis": "linear-motor", "channel": "iq_a", "mass": 40.0, "coulomb": 25.0, "viscous": 50.0, "presliding": 10e-6,
    "kv": 83.0, "speed_gain": 180 * 93.0, "integral_time": 0.01, "rate": 10000, "per_unit": 93.0, "most": 1488.0,
    "acceleration_forward": 40.0, "resolution": 5e-8, "speed_noise": 2e-5, "onset": 1.5e-3, "middle": 0.3, "start": 0.1,
    "stiffness": None, "magnets": 0.012, "noise": 0.5,
    "moves": [[(0.4, 1.2, 10), (-0.2, 0.6, 6), (0.1, 0.1, 3), (-0.3, 0.2, 4)],
              [(0.3, 0.9, 8), (-0.25, 0.3, 5), (0.2, 0.5, 7), (-0.05, 0.05, 2), (-0.2, 0.4, 4)],
              [(0.35, 1.0, 9), (-0.1, 0.2, 5), (-0.2, 0.7, 7), (0.05, 0.08, 2)]],
}
RADIUS = 0.031831  # of the rack's pinion, m; the gear's ratio is 10
RACK = {
    "axis": "rack", "channel": "torque_ref_n_m", "mass": 300.0, "coulomb": 90.0, "viscous": 300.0, "presliding": 10e-6,
    "kv": 16.7, "speed_gain": (10 / RADIUS) ** 2, "integral_time": 0.025, "rate": 8000, "per_unit": 10 / RADIUS,
    "most": 12000.0, "acceleration_forward": 0.0, "resolution": 1e-7, "speed_noise": 1e-5, "onset": 1e-3, "middle": 1.0,
    "start": 0.6, "stiffness": 9.18e7, "motor_mass": (0.0035 + 6e-4) * (10 / RADIUS) ** 2, "damping": 9.18e7 * 20e-6,
    "lag": 1 / (2 * math.pi * 800), "delay": 125e-6, "magnets": 0.0314159 / 5, "noise": 1.8,
    "moves": [[(0.6, 1.0, 3), (-0.3, 0.4, 2), (0.1, 0.1, 1), (-0.3, 0.2, 1)],
              [(0.5, 0.8, 2.5), (-0.25, 0.3, 1.5), (0.2, 0.5, 2), (-0.05, 0.05, 1)],
              [(0.55, 0.9, 2.8), (-0.1, 0.2, 1.5), (-0.2, 0.6, 2)]],
}
TRAVEL = 0.01 / (2 * math.pi)  # of the screw, m a radian
SCREW = {
    "axis": "screw-datasheet", "channel": "iq_a", "mass": 515.0, "coulomb": 0.6757 / TRAVEL, "viscous": 1131.0, "presliding": 5e-6,
    "kv": 46.7, "speed_gain": 1.0625 / TRAVEL**2, "integral_time": 0.0952, "rate": 10000, "per_unit": 1.641 / TRAVEL,
    "most": 15 * 1.641 / TRAVEL, "acceleration_forward": 0.0, "resolution": 1e-8, "speed_noise": 4e-6, "onset": 2e-4, "middle": 0.75,
    "start": 0.6, "stiffness": 5e7, "motor_mass": 0.0069 / TRAVEL**2, "damping": 500.0, "lag": 1 / (2 * math.pi * 106), "magnets": 0.01,
    "noise": 0.1, "fall": (0.0896 / TRAVEL, 4.317e-3), "bit": 30 / 2**14,
    "moves": [[(0.25, 0.15, 1), (-0.15, 0.08, 0.8), (0.05, 0.02, 0.5), (-0.1, 0.05, 0.5)],
              [(0.2, 0.12, 0.9), (-0.15, 0.2, 1.2), (0.1, 0.06, 1), (-0.03, 0.01, 0.3)],
              [(0.3, 0.18, 1.1), (-0.1, 0.04, 0.6), (-0.1, 0.1, 0.8)]],
}
# rad and N·m at the arm; its encoder is on the motor, set with the arm hanging down.
JOINT = {
    "axis": "joint", "channel": "torque_ref_n_m", "mass": 2.0, "coulomb": 6.0, "viscous": 8.0, "presliding": 3e-4, "kv": 6.0,
    "speed_gain": 200.0, "integral_time": 0.05, "rate": 4000, "per_unit": 100.0, "most": 250.0, "acceleration_forward": 0.0,
    "resolution": 2 * math.pi / 16384 / 100, "speed_noise": 3e-5, "onset": 3e-3, "middle": 0.0, "start": -0.5236, "stiffness": 2.5e4,
    "motor_mass": 1.0, "damping": 5.0, "lag": 1 / (2 * math.pi * 500), "delay": 250e-6, "magnets": 2 * math.pi / 600, "noise": 0.004,
    "fall": (1.0, 0.0349), "gravity": 60.0, "error": 1.454e-4, "ratio": 100, "bit": 5 / 2**14,
    "moves": [[(1.2, 1.5, 5), (-0.7, 0.6, 3), (0.3, 0.15, 2), (-0.5, 0.3, 2)],
              [(0.9, 1.1, 4), (-0.6, 0.35, 3), (0.4, 0.7, 4), (-0.1, 0.06, 1)],
              [(1.0, 1.3, 4.5), (-0.3, 0.2, 2), (-0.5, 0.8, 3)]],
}
MACHINES = [LINEAR_MOTOR, RACK, SCREW, JOINT]


def reference(start, moves):
    """Trapezoids of (distance, speed, acceleration) with pauses, smoothed over 30 ms."""
    parts = [np.full(int(0.15 / STEP), start)]
    at = start
    for distance, speed, acceleration in moves:
        way = abs(distance)
        top = min(speed, math.sqrt(way * acceleration))
        rise, hold = top / acceleration, max(way / top - top / acceleration, 0.0)
        t = np.arange(int((2 * rise + hold) / STEP) + 1) * STEP
        a = np.where(t < rise, acceleration, np.where(t >= rise + hold, -acceleration, 0.0))
        x = np.cumsum(np.cumsum(a) * STEP) * STEP
        x = np.concatenate([x * (way / x[-1]), np.full(int(0.1 / STEP), way)])
        parts.append(at + math.copysign(1.0, distance) * x)
        at += distance
    all_ = np.concatenate(parts)
    width = int(0.03 / STEP)
    padded = np.concatenate([np.full(width, all_[0]), all_])
    return np.convolve(padded, np.ones(width) / width, "full")[width:width + len(all_)]


class Friction:
    """Sliding share in [-1, 1] of one of three onsets."""

    def __init__(self, kind, machine):
        self.kind, self.onset, self.presliding = kind, machine["onset"], machine["presliding"]
        self.z = 0.0
        reach = np.array([0.3, 0.6, 1, 1.6, 2.4, 3.4, 4.8, 7]) * self.presliding / 3
        self.elements, self.stiffness = [0.0] * len(reach), (1 / len(reach) / reach).tolist()

    def share(self, v):
        if self.kind == "arctan":
            return 2 / math.pi * math.atan(v / self.onset)
        if self.kind == "bristle":
            end = math.copysign(self.presliding, v)
            self.z = end + (self.z - end) * math.exp(-abs(v) * STEP / self.presliding)
            return self.z / self.presliding
        most, sum_ = 1 / len(self.elements), 0.0
        for i, k in enumerate(self.stiffness):  # Maxwell slip
            self.elements[i] = min(max(self.elements[i] + v * STEP * k, -most), most)
            sum_ += self.elements[i]
        return sum_


def load(hidden, m, x, v, t):
    """The hidden force on the load against positive motion, N."""
    u = x - m["middle"]
    force = hidden.get("load", 0.0) + hidden.get("spring", 0.0) * u
    for name, law in LAWS.items():
        if name in hidden:
            force += law(hidden[name], u, x, v, t)
    return force


LAWS = {
    "cyclic": lambda h, u, x, v, t: h[0] * math.sin(2 * math.pi * t * h[1] + 0.4),
    "x2": lambda h, u, x, v, t: h[0] * (u / h[1]) ** 2,
    "xv": lambda h, u, x, v, t: h[0] * u * v / h[1],
    "vt": lambda h, u, x, v, t: h[0] * math.tanh(v / h[1]),
    "v3": lambda h, u, x, v, t: h[0] * v * abs(v) / h[1] ** 2,
    "drift": lambda h, u, x, v, t: h * (1 - math.exp(-t / 2)),
    "lawx": lambda h, u, x, v, t: h[0] * math.tanh(u / h[1]),
}


def simulate(m, moves, hidden, onset, random):
    """Positions, m, and commanded forces, N, each step."""
    wanted = reference(m["start"], moves)
    speed = np.gradient(wanted, STEP)
    forward = m["acceleration_forward"] * np.gradient(speed, STEP)
    friction = Friction(onset, m)
    every = round(1 / (m["rate"] * STEP))
    x = motor = wanted[0]
    v = motor_v = 0.0
    gravity, error, at_motor = m.get("gravity", 0.0), m.get("error", 0.0), "ratio" in m
    fall, fall_speed = m.get("fall", (0.0, 1.0))
    integral = command = acting = hidden.get("load", 0.0) + gravity * math.cos(x)
    if gravity:
        motor += integral / m["stiffness"]
    waiting = [command] * round(m.get("delay", 0.0) / STEP)
    xs, us = np.empty(len(wanted)), np.empty(len(wanted))
    stribeck, bump = hidden.get("stribeck"), hidden.get("bump")
    for k, target in enumerate(wanted):
        t = k * STEP
        if k % every == 0:
            off = target - round((motor if at_motor else x) / m["resolution"]) * m["resolution"]
            shown = (motor_v if m["stiffness"] else v) - random.standard_normal() * m["speed_noise"]
            slow = m["kv"] * off + speed[k] - shown
            integral += m["speed_gain"] / m["integral_time"] * slow * every * STEP
            command = m["speed_gain"] * slow + integral + forward[k]
            command = max(-m["most"], min(m["most"], command))
        if m["stiffness"]:
            waiting.append(command)
            acting += (waiting.pop(0) - acting) * STEP / m["lag"]
        else:
            acting = command
        level = m["coulomb"] * (1 + math.copysign(hidden.get("asym", 0.0), v * hidden.get("asym", 0.0)))
        if bump:
            level += bump[0] * math.exp(-0.5 * ((x - bump[1]) / bump[2]) ** 2)
        force = (level + fall * math.exp(-(v / fall_speed) ** 2)) * friction.share(v) + m["viscous"] * v
        if stribeck:
            force += stribeck[0] * math.exp(-abs(v) / stribeck[1]) * math.tanh(v / m["onset"])
        force *= 1 - hidden.get("thermal", 0.0) * (1 - math.exp(-t / 3))
        force += load(hidden, m, x, v, t) + gravity * math.cos(x)
        # Cogging acts on the motor, at its own position.
        drawn = hidden["cogging"] if "cogging" in hidden else (0.0, 1.0, 0.0)
        cogging = drawn[0] * math.sin(2 * math.pi * (motor if m["stiffness"] else x) / drawn[1] + drawn[2])
        # A current is logged as it flows, anything else as it is commanded.
        xs[k], us[k] = motor if at_motor else x, acting if m["channel"] == "iq_a" else command
        if m["stiffness"]:
            twist, lever = motor - x, 1.0
            if error:
                # What moves the load by more pushes back by more: the gear takes no power.
                turn = 2 * m["ratio"] * motor
                twist += error * math.sin(turn)
                lever += error * 2 * m["ratio"] * math.cos(turn)
            spring = m["stiffness"] * twist + m["damping"] * (lever * motor_v - v)
            motor_v += (acting - lever * spring - cogging) / m["motor_mass"] * STEP
            motor += motor_v * STEP
            v += (spring - force) / m["mass"] * STEP
        else:
            v += (acting - force - cogging) / m["mass"] * STEP
        x += v * STEP
    return xs, us


def coloured(kind, n, random):
    white = random.standard_normal(n)
    if kind == "autoregressive":
        out = np.empty(n)
        out[0] = white[0]
        for i in range(1, n):
            out[i] = 0.9 * out[i - 1] + math.sqrt(1 - 0.81) * white[i]
        return out
    if kind == "pink":
        lines = np.arange(n // 2 + 1, dtype=float)
        lines[0] = 1
        out = np.fft.irfft(np.fft.rfft(white) / np.sqrt(lines), n)
        return out / out.std()
    return white


def logged(m, xs, us, noise, random):
    """Time, position and effort as a logger with faults shows them."""
    step = round(1 / (noise["rate"] * STEP))
    index = np.arange(0, len(xs) - 2 * step, step)
    even = index * STEP
    taken = even + noise.get("jitter", 0.0) / noise["rate"] * random.standard_normal(len(index))
    steps = np.arange(len(xs)) * STEP
    x = np.round(np.interp(taken, steps, xs) / m["resolution"]) * m["resolution"] * m.get("ratio", 1)
    effort = np.interp(taken, steps, us) / m["per_unit"]
    effort += noise["level"] * coloured(noise["colour"], len(effort), random)
    return even, x, np.round(effort / noise["bit"]) * noise["bit"]
