"""Figures of the designs that `uniformity` printed, by SciPy: python compare.py OURS.csv

Every design must be Latin, the correlated one have its target, the orthogonal array one point in each
cell of every two variables. Plain sequences must be those of SciPy, and the mean centred discrepancy of scrambled
ones that of SciPy's within four of its standard errors. Exit code 1 if a figure differs by more than the rounding of its terms.
"""

import csv
import itertools
import sys

import numpy as np
import scipy
from scipy.stats import qmc, spearmanr

# Largest term of the sums that cancel, to the power of the number of variables.
TERM = {"CD": 1.5, "WD": 1.5, "MD": 1.875, "L2-star": 1.0, "mindist": 1.0, "mst": 1.0, "spearman": 1.0}

points, ours, sequences, scrambled = {}, {}, {}, {}
with open(sys.argv[1], newline="") as file:
    for name, quantity, *values in itertools.islice(csv.reader(file), 1, None):
        values = [float(v) for v in values]
        if quantity == "point":
            points.setdefault(name, []).append(values)
        elif quantity == "sequence":
            sequences.setdefault(name, []).append(values)
        elif quantity == "scrambled":
            scrambled[name] = np.array(values)
        else:
            ours.setdefault(name, {})[quantity] = np.array(values)

failed = False
print(f"SciPy {scipy.__version__}; greatest difference")
print(f"{'design':<17} {'n':>4} {'m':>3} " + " ".join(f"{q:>9}" for q in TERM))
for name, rows in points.items():
    x = np.array(rows)
    n, m = x.shape
    cells = np.floor(x * n).astype(int)
    if not all(sorted(column) == list(range(n)) for column in cells.T):
        print(f"{name}: not Latin")
        failed = True
    theirs = {q: qmc.discrepancy(x, method=q) for q in ("CD", "WD", "MD", "L2-star")}
    theirs["mindist"] = qmc.geometric_discrepancy(x, method="mindist")
    theirs["mst"] = qmc.geometric_discrepancy(x, method="mst")
    theirs["spearman"] = np.asarray(spearmanr(x).statistic).ravel()
    line = f"{name:<17} {n:>4} {m:>3}"
    for quantity, term in TERM.items():
        mine, other, scale = ours[name][quantity], theirs[quantity], term**m
        if quantity == "L2-star":
            # Squares are what cancels.
            mine, other = mine**2, other**2
        off = np.max(np.abs(mine - other))
        line += f" {off:9.1e}"
        # n^2 additions one after another, as SciPy sums.
        failed |= bool(off > scale * n**2 * 2.0**-53)
    print(line)

target = np.array([[1, 0.8, -0.3], [0.8, 1, 0], [-0.3, 0, 1]])
off = np.max(np.abs(spearmanr(np.array(points["correlated"])).statistic - target))
print(f"correlated: greatest difference of a rank correlation from its target {off:.1e}")
x = np.array(points["orthogonal array"])
pairs = itertools.combinations(range(x.shape[1]), 2)
strength = all(len({tuple(c) for c in np.floor(x[:, p] * 11).astype(int)}) == 121 for p in map(list, pairs))
print(f"orthogonal array: strength 2 {'holds' if strength else 'FAILS'}")
slices = np.array(points["sliced"]).reshape(4, 30, 5)
latin = all(sorted(np.floor(c * 30).astype(int)) == list(range(30)) for s in slices for c in s.T)
print(f"sliced: each slice Latin {'holds' if latin else 'FAILS'}")

for name, engine in (("sobol", qmc.Sobol), ("halton", qmc.Halton)):
    x = np.array(sequences[name])
    off = np.max(np.abs(x - engine(x.shape[1], scramble=False).random(len(x))))
    print(f"{name}, {x.shape[0]} x {x.shape[1]}: greatest difference {off:.1e}")
    # SciPy sums Halton's digits, at most nine of these points, each sum with its rounding.
    failed |= bool(off > (0.0 if name == "sobol" else 10 * 2.0**-53))
for name, mine in scrambled.items():
    engine = qmc.Halton if name == "halton" else qmc.Sobol
    other = np.array([qmc.discrepancy(engine(6, rng=seed).random(256)) for seed in range(len(mine))])
    error = np.hypot(mine.std(), other.std()) / np.sqrt(len(mine))
    print(f"{name}, 256 x 6: mean CD {mine.mean():.4e}, SciPy {other.mean():.4e}, standard error of the difference {error:.1e}")
    failed |= bool(abs(mine.mean() - other.mean()) > 4 * error)
sys.exit(1 if failed or not strength or not latin else 0)
