"""From terms to names, and names beside the truth; the same rules for whoever searched."""

import numpy as np

from library import EFFECTS, GAIN, GENERIC, VARIABLES
from regress import groups

# Standard deviations by which an own parameter must leave what it is told to within.
BEYOND = 2.0
# 1 % point of chi-squared over its degrees of freedom, for 1 to 3 of them.
CHI2 = (6.63, 9.21, 11.34)


def sizes(terms):
    """Coefficient of each group: the amplitude of a pair."""
    together = groups(terms.names)
    one = lambda ks: [terms.value[terms.names[k]] for k in ks]
    # The sign of a single term is kept.
    value = {g: float(one(ks)[0] if len(ks) == 1 else np.hypot.reduce(one(ks))) for g, ks in together.items()}
    deviation = {g: float(max(terms.deviation[terms.names[k]] for k in ks)) for g, ks in together.items()}
    return value, deviation


def common_gain(terms, told):
    """The one share by which all own parameters are off, where the terms agree in one."""
    own = [t for t in told if t in terms.value]
    if terms.covariance is None or len(own) < 2 or len(own) != len(terms.covariance):
        return None
    base = np.array([told[t] for t in own])
    value = np.array([terms.value[t] for t in own])
    inverse = np.linalg.pinv(terms.covariance)
    share = (base @ inverse @ value) / (base @ inverse @ base)
    off = value - share * base
    agrees = off @ inverse @ off < CHI2[min(len(own) - 2, 2)]
    return share if agrees else None


def named(terms, told, tolerance, machine):
    """Names as a list of (term, effects), and coefficients: what terms that survive say.

    An own parameter within the tolerance that was told, give or take BEYOND standard
    deviations, is a recalibration and no name. The gain of the effort is itself known to that
    tolerance alone, and a parameter over it to about twice of it.
    """
    own_off = (1.0 + tolerance) / (1.0 - tolerance) - 1.0
    value, deviation = sizes(terms)
    found, gain = [], common_gain(terms, told)
    beyond = lambda t, base: abs(value[t]) > own_off * abs(base) + BEYOND * deviation[t]
    own = [t for t in told if t in value and beyond(t, told[t])]
    if gain is not None and abs(gain) > tolerance and len(own) > 1:
        found.append(("gain", GAIN))
        value["gain"], own = gain, []
    found += [(t, EFFECTS[t]) for t in own]
    for term in value:
        kind = term.split()[0]
        if term in told or term == "gain" or (kind == "stribeck" and not beyond(term, machine.stiction)):
            continue
        effects = EFFECTS.get(kind, frozenset())
        if kind in ("bump", "stribeck", "gravity", "turn") and any(e == effects for _, e in found):
            continue  # one name, however many of its terms
        found.append((term, effects))
    return [(term, set(effects)) for term, effects in found], value


def estimates(name, value, machine, terms_of):
    """Sizes of an effect from the coefficients of its terms, as `truth.json` has them."""
    v = lambda t: value.get(t, 0.0)
    most = lambda kind: max((c for t, c in value.items() if t.split()[0] == kind), key=abs, default=None)
    by = {
        "payload-mass": lambda: [v("a")],
        "motor-inertia": lambda: [v("a") / machine.ratio**2],
        "viscous-friction": lambda: [v("v")],
        "coulomb-friction": lambda: [v("s")],
        "asymmetric-friction": lambda: [v("s") + v("|s|") + v("1"), v("s") - v("|s|") - v("1")],
        "asymmetric-viscous-friction": lambda: [v("v") + v("|v|"), v("v") - v("|v|")],
        "torque-constant": lambda: [1.0 / (1.0 + v("gain")) - 1.0],
        "current-sensor-gain": lambda: [v("gain")],
        "constant-load": lambda: [v("1")],
        "load-dependent-friction": lambda: [v("s|F|")],
        "spring-force": lambda: [v("x")],
        "gravity-imbalance": lambda: [float(np.hypot(v("gravity"), v("turn")))],
        "force-ripple": lambda: [most("pole") or 0.0],
        "cogging-torque": lambda: [(most("cogging") or 0.0) / machine.ratio],
        "torque-ripple": lambda: [v("ripple")],
        "stribeck-friction": lambda: [most("stribeck") or 0.0],
        "position-dependent-friction": lambda: [most("bump") or 0.0],
    }
    return by[name]() if name in by else None


def size_error(estimated, truth):
    """|estimate - truth| / |truth| over the sizes of an effect."""
    sizes = [n["value"] for n in truth["numbers"] if n["size"]]
    if estimated is None or not sizes:
        return None
    return float(np.linalg.norm(np.subtract(estimated, sizes)) / np.linalg.norm(sizes))


def scored(names, truth):
    """Of names as (label, effects): whether what is hidden is named, and names that are false.

    Names of `neither` say the form of a law, and are neither right nor false. A term of no
    effect is false, but where a law of no library hides over its variable.
    """
    hidden = {h["name"] for h in truth["hidden"]}
    law = " ".join(h["depends_on"] for h in truth["hidden"] if h["law"])
    neither, false, right, variable = set(truth["neither"]), [], False, False
    for label, effects in names:
        over = [w for w in VARIABLES.get(label.split()[0], "").split(", ") if w]
        of_law = any(w in law for w in over)
        variable |= of_law
        if effects & hidden:
            right = True
        elif not (effects & neither or (not effects and of_law)):
            false.append(label)
    return {"right": right, "false": false, "variable": variable}
