"""Columns that both peers are given, and the table from term to effect.

The table was written before any result was looked at.
"""

import numpy as np

# In the cases hidden orders of cogging are 1 to 24.
ORDERS = range(1, 25)
# Of a linear motor, in an electrical period.
POLE_ORDERS = range(1, 25)
CENTRES = 9
STRIBECK_SHARES = (0.01, 0.03, 0.1)

INERTIA = {"payload-mass", "motor-inertia"}
DRY = {"coulomb-friction", "asymmetric-friction"}
VISCOUS = {"viscous-friction", "asymmetric-viscous-friction"}
GAIN = {"torque-constant", "current-sensor-gain"}
STANDING = {"constant-load", "asymmetric-friction"}

# First word of a term -> effects of which it is a part. A name by a peer is such a set: it is
# right where what is hidden is in it, and false otherwise.
EFFECTS = {
    "a": INERTIA,
    "s": DRY,
    "v": VISCOUS,
    "gravity": {"gravity-imbalance"},
    "gain": GAIN,
    "1": STANDING,
    "|s|": {"asymmetric-friction"},
    "|v|": {"asymmetric-viscous-friction"},
    "s|F|": {"load-dependent-friction"},
    "x": {"spring-force"},
    "turn": {"gravity-imbalance"},
    # An offset of a phase current turns with the electrical angle.
    "pole": {"force-ripple", "current-sensor-offset"},
    "cogging": {"cogging-torque", "current-sensor-offset"},
    "ripple": {"torque-ripple"},
    "stribeck": {"stribeck-friction"},
    "bump": {"position-dependent-friction"},
}
# Terms that a library has and no effect is made of: a surviving one is a false name, but where
# a law of no library hides over that variable.
GENERIC = {"v|v|": "speed", "v^3": "speed", "x^2": "position", "x^3": "position", "xv": "speed, position", "a|a|": "acceleration"}
VARIABLES = {
    "a": "acceleration", "s": "speed", "v": "speed", "1": "", "|s|": "speed", "|v|": "speed", "s|F|": "force",
    "x": "position", "turn": "position", "pole": "position", "cogging": "angle", "ripple": "angle, current",
    "stribeck": "speed", "bump": "position", "gravity": "position", "gain": "current", **GENERIC,
}


def bristle(x, presliding):
    """Deflection -1 to 1 of a Dahl bristle: the sign of speed without its jump."""
    u, out = 0.0, np.empty_like(x)
    for k, step in enumerate(np.diff(x, prepend=x[0])):
        # Exact for a step in one direction.
        sign = 1.0 if step > 0.0 else -1.0
        u = sign + (u - sign) * np.exp(-abs(step) / presliding)
        out[k] = u
    return out


class Columns:
    """Residual force and library of a log.

    `rest`: what the drive gives beyond the machine as its file says, at the load.
    `told`: columns of the machine's own parameters, each with its value in the file.
    `more`: candidates.
    """

    def __init__(self, machine, x, v, a, effort, frame):
        """`frame` are start, middle, way and greatest speed of the log that is fitted to, so
        that both logs have the same columns."""
        start, middle, span, top = frame
        s = bristle(x, machine.presliding)
        force = machine.gain * effort
        self.told = {"a": (a, machine.inertia), "v": (v, machine.viscous), "s": (s, machine.coulomb)}
        if machine.gravity:
            self.told["gravity"] = (np.sin(x - machine.hanging), machine.gravity)
        fall = (machine.stiction - machine.coulomb) * np.exp(-((v / machine.stribeck_speed) ** 2)) * s
        self.rest = force - fall - sum(column * value for column, value in self.told.values())
        at = (x - middle) / span
        more = {"1": np.ones_like(x), "|s|": np.abs(s), "|v|": np.abs(v), "x": x - start}
        more |= {"v|v|": v * np.abs(v), "v^3": v**3, "x^2": at**2, "x^3": at**3, "xv": at * v, "a|a|": a * np.abs(a)}
        if machine.transmission:
            more["s|F|"] = s * np.abs(force - machine.motor_inertia * a)
        if machine.rotary:
            # The told gravity is the other quadrature.
            more["turn"] = np.cos(x - machine.hanging)
        if machine.pole_pitch:
            for k in POLE_ORDERS:
                pair(more, f"pole {k}", k * np.pi / machine.pole_pitch * x, 1.0)
        else:
            for k in ORDERS:
                pair(more, f"cogging {k}", k * machine.ratio * x, 1.0)
        if machine.pole_pairs:
            pair(more, "ripple", 6.0 * machine.pole_pairs * machine.ratio * x, force)
        for share in STRIBECK_SHARES:
            more[f"stribeck {share}"] = s * np.exp(-((v / (share * top)) ** 2))
        for k in range(CENTRES):
            off = at - (k / (CENTRES - 1) - 0.5)
            more[f"bump {k}"] = s * np.exp(-0.5 * (off * (CENTRES - 1)) ** 2)
        self.more = more

    def names(self):
        return list(self.told) + list(self.more)

    def matrix(self):
        """The residual, then every column."""
        told = [column for column, _ in self.told.values()]
        return np.column_stack([self.rest, *told, *self.more.values()])


def pair(to, name, angle, times):
    to[f"{name} sin"], to[f"{name} cos"] = times * np.sin(angle), times * np.cos(angle)
