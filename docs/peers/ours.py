"""Searches cases of `cargo xtask peers-cases` with `discover`, one after another, one thread.

A case that was searched is not searched again, so that this may be stopped and started. The
order takes plots (and so machines) and kinds of case by turns, so that what ran so far is a
fair part of the whole. Standard library alone.
"""

import argparse
import itertools
import json
import os
import resource
import subprocess
import time
from pathlib import Path


def in_turn(names):
    """One of each plot, another kind by turns; then the next of each."""
    plots = [list(group) for _, group in itertools.groupby(names, lambda n: n.split("-")[0])]
    most = max(map(len, plots), default=0)
    rounds = ((plot, (k + p) % most) for k in range(most) for p, plot in enumerate(plots))
    return [plot[k] for plot, k in rounds if k < len(plot)]


def searched(program, arguments, out):
    """Searches logs; processor time and wall time, s."""
    out.mkdir(parents=True, exist_ok=True)
    command = [program, "discover", *arguments, "--out", out, "--threads", "1"]
    before, clock = resource.getrusage(resource.RUSAGE_CHILDREN), time.monotonic()
    with open(out / "log.txt", "w") as log:
        done = subprocess.run(command, stdout=log, stderr=log, env={**os.environ, "RAYON_NUM_THREADS": "1"}, check=False)
    after, wall = resource.getrusage(resource.RUSAGE_CHILDREN), time.monotonic() - clock
    cpu = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    return {"exit": done.returncode, "wall_s": wall, "cpu_s": cpu}


def arguments(axis, fit, check, balance=False):
    return ["--axis", axis, "--fit", fit, "--check", check, *["--balance"] * balance]


def once(program, of, out, files):
    """Searches unless that was done with the same `files`; what it took is written last."""
    kept = out / "search.json"
    if kept.exists() and json.loads(kept.read_text())["files"] == files:
        return
    took = {"files": files, **searched(program.resolve(), of, out)}
    aside = out / "search.json.part"
    aside.write_text(json.dumps(took, indent=1))
    aside.rename(kept)
    print(out.name, took, flush=True)


def main():
    options = argparse.ArgumentParser(description=__doc__)
    options.add_argument("--program", type=Path, default="target/debug/xtask")
    options.add_argument("--cases", type=Path, required=True)
    options.add_argument("--emps", type=Path, help="folder of emps.csv and emps_pulses.csv")
    options.add_argument("--out", type=Path, help="[default: CASES/searches]")
    given = options.parse_args()
    names = json.loads((given.cases / "cases.json").read_text())["cases"]
    searches = given.out or given.cases / "searches"
    if given.emps:
        logs = [given.emps / "emps.csv", given.emps / "emps_pulses.csv"]
        once(given.program, arguments("data/axes/emps-balance.toml", *logs), searches / "emps", "emps")
    for name in in_turn(names):
        folder = given.cases / name
        told, truth = (json.loads((folder / f).read_text()) for f in ("told.json", "truth.json"))
        logs = [folder / "fit.csv", folder / "check.csv"]
        once(given.program, arguments(folder / "axis.toml", *logs, told["balance"]), searches / name, truth["files"])


if __name__ == "__main__":
    main()
