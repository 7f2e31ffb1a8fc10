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


def beside(points):
    """WD^2, MD^2 (Zhou, Fang and Ning) and the L2-star discrepancy, as printed."""
    n, m = len(points), len(points[0])

    def over(factor, *rows):
        result = Fraction(1)
        for values in zip(*rows):
            result *= factor(*values)
        return result

    def pairs(factor):
        return sum(over(factor, a, b) for a in points for b in points) / n**2

    def single(factor):
        return sum(over(factor, a) for a in points) / n

    def off(x):
        return abs(x - HALF)

    wd = pairs(lambda x, y: Fraction(3, 2) - abs(x - y) * (1 - abs(x - y))) - Fraction(4, 3) ** m
    md = (
        Fraction(19, 12) ** m
        - 2 * single(lambda x: Fraction(5, 3) - off(x) / 4 - off(x) ** 2 / 4)
        + pairs(
            lambda x, y: Fraction(15, 8) - off(x) / 4 - off(y) / 4 - 3 * abs(x - y) / 4 + (x - y) ** 2 / 2
        )
    )
    star = Fraction(1, 3**m) - 2 * single(lambda x: (1 - x * x) / 2) + pairs(lambda x, y: 1 - max(x, y))
    return float(wd), float(md), float(mpmath.sqrt(mpmath.mpf(star.numerator) / star.denominator))


space = [(1, 3), (2, 6), (3, 2), (4, 5), (5, 1), (6, 4)]
exact = discrepancy([[(Fraction(v) - HALF) / 6 for v in point] for point in space])
print("scipy_example", float(exact))

mpmath.mp.dps = 40
documented = [[(Fraction(v) - HALF) / 6 for v in point] for point in space]
lattice = [[(Fraction((i * a + 3) % 20) + HALF) / 20 for a in (1, 3, 7, 9)] for i in range(20)]
for name, points in (("documented", documented), ("lattice", lattice)):
    print(name, float(discrepancy(points)), *beside(points))
for p in ("0.75", "0.975", "0.99", "1e-10"):
    # The double that the literal stands for, not the decimal.
    q = mpmath.mpf(float(p))
    print("quantile", p, float(mpmath.sqrt(2) * mpmath.erfinv(2 * q - 1)))
