"""PySINDy, IDIM-LS and this project's search on the same cases (docs/peers.md)."""

import argparse
import json
import time
from concurrent.futures import ProcessPoolExecutor
from functools import partial
from pathlib import Path

import numpy as np

import emps
import regress
import score
import signals
import table
from library import Columns
from machine import Machine

# Peer -> derivative and regression.
PEERS = {
    "IDIM-LS": ("central", regress.idim),
    "E-SINDy": ("smooth", regress.sindy),
    "SINDy-PI": ("smooth", regress.sindy_pi),
}

# Cut-off of what is differentiated over that of the balance, which all columns pass alike: a
# filter on one side alone would take from the acceleration.
WIDER = 3.0


def prepared(machine, log, period, derivative, frame):
    """The columns of a log, and the frame that they are made in."""
    position = signals.despiked(log[machine.position])
    effort = signals.despiked(log[machine.effort])
    x, v, a = signals.motion(position, period, WIDER * machine.cutoff, derivative)
    if frame is None:
        frame = (x[0], 0.5 * (x.min() + x.max()), np.ptp(x), np.abs(v).max())
    return Columns(machine, x, v, a, effort, frame), frame


def searched(folder, told, derivative, regression):
    """Names and coefficients by a peer, which sees neither truth nor case."""
    machine = Machine(folder / "axis.toml")
    frame, matrices = None, []
    for name in ("fit.csv", "check.csv"):
        columns, frame = prepared(machine, signals.read(folder / name), told["period_s"], derivative, frame)
        matrices.append(signals.thinned(columns.matrix(), told["period_s"], machine.cutoff))
    own = {name: value for name, (_, value) in columns.told.items()}
    terms = regression(*matrices, columns.names(), len(own))
    names, value = score.named(terms, own, told["tolerance"], machine)
    return names, value, machine


def by_peer(folder, told, truth, peer):
    derivative, regression = PEERS[peer]
    clock, cpu = time.monotonic(), time.process_time()
    names, value, machine = searched(folder, told, derivative, regression)
    took = {"wall_s": time.monotonic() - clock, "cpu_s": time.process_time() - cpu}
    found = score.scored(names, truth)
    errors = [score.size_error(score.estimates(h["name"], value, machine, names), h) for h in truth["hidden"]]
    return {"names": [label for label, _ in names], **found, "size_error": errors[0] if found["right"] else None, **took}


def by_ours(folder, searches, truth):
    """What `cargo xtask discover` kept of a case (docs/peers/ours.py); None where it did not run."""
    kept = searches / folder.name
    if not (kept / "search.json").exists():
        return None
    took = json.loads((kept / "search.json").read_text())
    if took["files"] != truth["files"] or took["exit"] != 0:
        return {"failed": took["exit"], **took} if took["files"] == truth["files"] else None
    told = json.loads((kept / "discovery.json").read_text())
    names = [(e["name"], {e["name"], *e["indistinguishable_from"]}) for e in told["effects"]]
    found = score.scored(names, truth)
    if told["unknown"] and truth["hidden"] and truth["hidden"][0]["law"]:
        law = truth["hidden"][0]["depends_on"]
        found["variable"] |= any(w.strip() in told["unknown"]["depends_on"] for w in law.split(","))
    error = None
    for hidden in truth["hidden"]:
        for effect in told["effects"]:
            if effect["name"] == hidden["name"]:
                values = {p["name"]: p["value"] for p in effect["parameters"]}
                error = score.size_error([values[n["name"]] for n in hidden["numbers"] if n["size"]], hidden)
    return {"names": [n for n, _ in names], "verdict": told["verdict"], **found, "size_error": error, **took}


def compared(cases, searches, name):
    """One case, by all."""
    folder = cases / name
    told, truth = (json.loads((folder / f).read_text()) for f in ("told.json", "truth.json"))
    row = {"case": name, "machine": told["machine"], "reach": truth["reach"], "hidden": [h["name"] for h in truth["hidden"]]}
    row["by"] = {peer: by_peer(folder, told, truth, peer) for peer in PEERS}
    row["by"]["discover"] = by_ours(folder, searches, truth)
    row["seen"] = all(h["seen"] for h in truth["hidden"])
    print(name, flush=True)
    return row


def main():
    options = argparse.ArgumentParser(description=__doc__)
    options.add_argument("--cases", type=Path, required=True, help="folder that `cargo xtask peers-cases` wrote")
    options.add_argument("--searches", type=Path, help="folder of docs/peers/ours.py [default: CASES/searches]")
    options.add_argument("--emps", type=Path, help="folder of emps.csv and emps_pulses.csv")
    options.add_argument("--first", type=int, help="only the first N cases")
    options.add_argument("--jobs", type=int, default=1, help="cases at a time, one thread each [default: 1]")
    options.add_argument("--out", type=Path, required=True)
    given = options.parse_args()
    index = json.loads((given.cases / "cases.json").read_text())
    searches = given.searches or given.cases / "searches"
    whole = [name for name in index["cases"][: given.first] if (given.cases / name / "truth.json").exists()]
    with ProcessPoolExecutor(given.jobs) as pool:
        results = list(pool.map(partial(compared, given.cases, searches), whole))
    real = emps.compared(given.emps, searches) if given.emps else None
    given.out.mkdir(parents=True, exist_ok=True)
    written = {"seed": index["seed"], "cases": results, "emps": real}
    for name, text in (("peers.json", json.dumps(written, indent=1)), ("peers.md", table.markdown(written))):
        aside = given.out / (name + ".part")
        aside.write_text(text)
        aside.rename(given.out / name)
    print(given.out / "peers.md")


if __name__ == "__main__":
    main()
