"""tests/golden/scipy_sequences.csv: plain sequences of SciPy 1.17.1.

    python3 crates/lhs/tests/golden/scipy_sequences.py >crates/lhs/tests/golden/scipy_sequences.csv

Sequence, point, variable (both from 0), value.
"""

from scipy.stats import qmc

DIMS = 1024
print("sequence,point,variable,value")
ENGINES = {"sobol": qmc.Sobol, "halton": qmc.Halton}
POINTS = {
    1: (0, 1, 2, 9, 1023),
    2: (0, 1, 2, 9),
    3: (0, 1, 2, 9),
    6: range(8),
    29: range(10),
    8191: (0, 1, 2, 63, 100, 511, 1023),
    1_000_001: (0, 1, 2, 3, 63, 64, 100, 255, 511, 767, 1022, 1023),
}
for name, engine_of in ENGINES.items():
    for point, variables in POINTS.items():
        engine = engine_of(DIMS, scramble=False)
        engine.fast_forward(point)
        row = engine.random(1)[0]
        for variable in variables:
            print(f"{name},{point},{variable},{float(row[variable])!r}")
