"""What the search said of each case, beside the truth: score.py FOLDER"""

import json
import re
import sys
from collections import Counter
from pathlib import Path

from cases import OVER, RIGHT

WEIGHED = re.compile(r"law over one variable in their place.*of_effects=(\S+) of_law=(\S+)")


def of_case(case, right):
    said = json.loads((case / "found" / "discovery.json").read_text())
    named = [({e["name"], *e["indistinguishable_from"]}, e["name"]) for e in said["effects"]]
    wrong = [name for alike, name in named if not alike & set(right)]
    if wrong:
        return "wrong name", wrong
    if named:
        return "named", [name for _, name in named]
    over = (said["unknown"] or {}).get("depends_on") if said["verdict"] == "unknown" else None
    return said["verdict"], [f"over {over}"] if over else []


# Of a hidden kind, the effect and its size that is the same number, and what makes that of the hidden one.
SIZES = {
    "load": ("constant-load", "force", lambda load: load),
    "spring": ("spring-force", "stiffness", lambda rate: rate),
}


def size_of_case(case, kind, hidden):
    """Whether the 95 % interval of a size holds the truth; none where it was not named, or is another number."""
    if kind not in SIZES:
        return None
    effect, size, truth = SIZES[kind]
    said = json.loads((case / "found" / "discovery.json").read_text())
    for named in said["effects"]:
        if named["name"] == effect:
            at = next(p for p in named["parameters"] if p["name"] == size)
            return at["ci95"][0] <= truth(hidden[kind]) <= at["ci95"][1]
    return None


def confidence(case):
    said = json.loads((case / "found" / "discovery.json").read_text())
    return said["assessment"]["confidence"]["level"]


def main(folder):
    counts, shares, levels, sizes = Counter(), [], Counter(), Counter()
    for case in sorted(p.parent for p in Path(folder).glob("*/truth.json")):
        truth = json.loads((case / "truth.json").read_text())
        verdict, names = of_case(case, RIGHT[truth["kind"]])
        if names == [f"over {OVER.get(truth['kind'])}"]:
            verdict += ", the right variable"
        counts[truth["kind"], verdict] += 1
        level = confidence(case)
        levels[level, "wrong" if verdict == "wrong name" else "right"] += verdict in ("named", "wrong name")
        holds = size_of_case(case, truth["kind"], truth["hidden"])
        sizes[holds] += holds is not None
        weighed = WEIGHED.search(re.sub(r"\x1b\[[0-9;]*m", "", (case / "search.txt").read_text()))
        share = float(weighed[1]) / float(weighed[2]) if weighed else None
        if share is not None and 0 < share < 1.5:
            shares.append((share, verdict, truth["kind"]))
        shown = "" if share is None else f", {share:.2f} of the best law"
        print(f"{case.name} {truth['axis']} {truth['onset']} {truth['kind']}: {verdict} {' '.join(names)}{shown}, confidence {level}")
    print()
    for kind in RIGHT:
        row = {verdict: n for (k, verdict), n in sorted(counts.items()) if k == kind}
        print(f"{kind:10} {sum(row.values()):3}  {row}")
    total = sum(counts.values())
    for level in ("high", "medium", "low"):
        right, wrong = levels[level, "right"], levels[level, "wrong"]
        print(f"names given with {level} confidence: {right} of {right + wrong} machines right")
    print(f"intervals of loads and springs that hold the truth: {sizes[True]} of {sizes[True] + sizes[False]}")
    print(f"wrong names: {sum(n for (_, v), n in counts.items() if v == 'wrong name')} of {total}")


if __name__ == "__main__":
    main(sys.argv[1])
