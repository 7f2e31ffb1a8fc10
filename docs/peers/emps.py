"""The real stage of the EMPS benchmark, from nothing: acceleration, force and no axis file.

Data and published figures: A. Janot, M. Gautier, M. Brunot, "Data Set and Reference Models of
EMPS", Workshop on Nonlinear System Identification Benchmarks, Eindhoven, 2019
(nonlinearbenchmark.org). The data have no licence and are not part of this project.
"""

import json
import time

import numpy as np
from scipy import signal

import regress
import signals

GAIN = 35.15065188  # N/V, published
PERIOD, CUTOFF, EVERY = 1e-3, 100.0, 10
LEAD = 2.5e-3
PUBLISHED = {"a": 95.1089, "v": 203.5034, "s": 20.3935, "1": -3.1648}


def columns(file, derivative, stribeck):
    """Force, then acceleration, speed, its sign, a constant and candidates."""
    log = signals.read(file)
    x, v, a = signals.motion(log["q_meas_m"], PERIOD, CUTOFF, derivative)
    s = np.sign(v)
    all_of = {"force": GAIN * log["u_V"], "a": a, "v": v, "s": s, "1": np.ones_like(v), "|v|": np.abs(v), "v|v|": v * np.abs(v), "v^3": v**3, "x": x, "x^2": x**2}
    for speed in stribeck:
        all_of[f"stribeck {speed}"] = s * np.exp(-((v / speed) ** 2))
    for order in (1, 2):
        all_of[f"turn {order} sin"] = np.sin(order * 2.0 * np.pi / LEAD * x)
        all_of[f"turn {order} cos"] = np.cos(order * 2.0 * np.pi / LEAD * x)
    # Decimated as the authors do: Chebyshev, forward and back.
    thin = np.column_stack([signal.decimate(c, EVERY, zero_phase=True) for c in all_of.values()])
    return thin[10:-10], list(all_of)[1:]


def told(terms, check, names, took):
    """Parameters, terms and relative force error on the check log, in percent."""
    inside = [names.index(n) for n in terms.names]
    model = check[:, 1:][:, inside] @ np.array([terms.value[n] for n in terms.names])
    error = np.linalg.norm(check[:, 0] - model) / np.linalg.norm(check[:, 0])
    own = {n: terms.value.get(n) for n in PUBLISHED}
    return {"parameters": own, "terms": terms.names, "check_percent": 100.0 * error, "cpu_s": took}


def four_terms(fit, check, names, own):
    c, covariance, _ = regress.fitted(fit[:, 1:5], fit[:, 0])
    return regress.Terms(names[:4], c, np.sqrt(np.diag(covariance)))


def ours(folder, searches, check, names):
    """Parameters of `discover` on `data/axes/emps-balance.toml`, by the same balance."""
    file = searches / "emps" / "discovery.json"
    if not file.exists():
        return None
    found = json.loads(file.read_text())
    effects = {e["name"]: {p["name"]: p["value"] for p in e["parameters"]} for e in found["effects"]}
    mass = 100.0 * (1.0 + next((k["share"] for k in found["recalibrated"] if k["name"] == "mass"), 0.0))
    value = {"a": mass, "v": 0.0, "s": 0.0, "1": 0.0, "|v|": 0.0}
    extra = []
    for name, p in effects.items():
        if name == "viscous-friction":
            value["v"] += p["coefficient"]
        elif name == "coulomb-friction":
            value["s"] += p["force"]
        elif name == "constant-load":
            value["1"] += p["force"]
        elif name == "asymmetric-friction":
            value["s"] += 0.5 * (p["forward"] + p["backward"])
            value["1"] += 0.5 * (p["forward"] - p["backward"])
        elif name == "asymmetric-viscous-friction":
            value["v"] += 0.5 * (p["forward"] + p["backward"])
            value["|v|"] += 0.5 * (p["forward"] - p["backward"])
        elif name == "stribeck-friction":
            extra.append((p["velocity"], p["force"]))
        else:
            return {"terms": list(effects), "parameters": value, "check_percent": None, "cpu_s": None}
    wide, more = columns(folder / "emps_pulses.csv", "central", [v for v, _ in extra])
    value |= {f"stribeck {v}": f for v, f in extra}
    terms = regress.Terms(list(value), list(value.values()), [0.0] * len(value))
    kept = json.loads((searches / "emps" / "search.json").read_text())
    return {**told(terms, wide, more, kept["cpu_s"]), "terms": list(effects)}


def compared(folder, searches):
    """Each peer, ours, and the published model."""
    result, own = {}, len(PUBLISHED)
    grid = (0.002, 0.005, 0.01, 0.02)
    ways = {
        "least squares, published structure": ("central", four_terms),
        "IDIM-LS, stepwise": ("central", regress.idim),
        "E-SINDy": ("smooth", regress.sindy),
        "SINDy-PI": ("smooth", regress.sindy_pi),
    }
    for name, (derivative, regression) in ways.items():
        clock = time.process_time()
        fit, names = columns(folder / "emps.csv", derivative, grid)
        check, _ = columns(folder / "emps_pulses.csv", derivative, grid)
        terms = regression(fit, check, names, own)
        result[name] = told(terms, check, names, time.process_time() - clock)
    result["discover"] = ours(folder, searches, check, names)
    return result
