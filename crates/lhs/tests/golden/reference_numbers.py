"""The numbers that tests/criteria.rs and tests/marginals.rs compare with.

    python3 crates/lhs/tests/golden/reference_numbers.py   (needs mpmath; 1.3.0 was used)

CD^2 of SciPy's documented example in exact fractions, by Hickernell's formula as
printed; quantiles of the standard normal from the inverse error function in 40
digits. Both are printed as the nearest double.
"""

from fractions import Fraction

import mpmath

HALF = Fraction(1, 2)


def discrepancy(points):
    n, m = len(points), len(points[0])
    z = [[abs(x - HALF) for x in point] for point in points]

    def product(factors):
        result = Fraction(1)
        for factor in factors:
            result *= factor
        return result

    single = sum(product(1 + a / 2 - a * a / 2 for a in row) for row in z)
    pairs = sum(
        product(1 + z[i][j] / 2 + z[k][j] / 2 - abs(points[i][j] - points[k][j]) / 2 for j in range(m))
        for i in range(n)
        for k in range(n)
    )
    return Fraction(13, 12) ** m - 2 * single / n + pairs / n**2


space = [(1, 3), (2, 6), (3, 2), (4, 5), (5, 1), (6, 4)]
exact = discrepancy([[(Fraction(v) - HALF) / 6 for v in point] for point in space])
print("scipy_example", float(exact))

mpmath.mp.dps = 40
for p in ("0.75", "0.975", "0.99", "1e-10"):
    # The double that the literal stands for, not the decimal.
    q = mpmath.mpf(float(p))
    print("quantile", p, float(mpmath.sqrt(2) * mpmath.erfinv(2 * q - 1)))
