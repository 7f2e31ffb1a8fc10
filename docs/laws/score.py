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


def main(folder):
    counts, shares = Counter(), []
    for case in sorted(p.parent for p in Path(folder).glob("*/truth.json")):
        truth = json.loads((case / "truth.json").read_text())
        verdict, names = of_case(case, RIGHT[truth["kind"]])
        if names == [f"over {OVER.get(truth['kind'])}"]:
            verdict += ", the right variable"
        counts[truth["kind"], verdict] += 1
        weighed = WEIGHED.search(re.sub(r"\x1b\[[0-9;]*m", "", (case / "search.txt").read_text()))
        share = float(weighed[1]) / float(weighed[2]) if weighed else None
        if share is not None and 0 < share < 1.5:
            shares.append((share, verdict, truth["kind"]))
        shown = "" if share is None else f", {share:.2f} of the best law"
        print(f"{case.name} {truth['axis']} {truth['onset']} {truth['kind']}: {verdict} {' '.join(names)}{shown}")
    print()
    for kind in RIGHT:
        row = {verdict: n for (k, verdict), n in sorted(counts.items()) if k == kind}
        print(f"{kind:10} {sum(row.values()):3}  {row}")
    total = sum(counts.values())
    print(f"wrong names: {sum(n for (_, v), n in counts.items() if v == 'wrong name')} of {total}")


if __name__ == "__main__":
    main(sys.argv[1])
