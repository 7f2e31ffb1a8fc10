"""The rotors of beam-fem's example `campbell` in ROSS, and the differences.

    compare.py OURS.csv

Frequencies and damping ratios are eigenvalues (SciPy) of the matrices that ROSS assembles, stretch and twist left
out; critical speeds and unbalance responses are those of ROSS's own `run_critical_speed` and
`run_unbalance_response`. Prints the greatest relative difference of each rotor and quantity, and writes
ROSS's values beside OURS.csv as OURS-ross.csv.
"""

import os
import sys
import warnings
from collections import defaultdict

warnings.filterwarnings("ignore")
# A package of ROSS's writes about a library of refrigerants, from C++.
kept = [os.dup(1), os.dup(2)]
for stream in (1, 2):
    os.dup2(os.open(os.devnull, os.O_WRONLY), stream)
try:
    import numpy as np
    import ross as rs
    import scipy.linalg
finally:
    for stream, old in zip((1, 2), kept):
        os.dup2(old, stream)

STEEL = rs.Material(name="steel", rho=7810, E=211e9, G_s=81.2e9)
STEPS = [
    (1.27, 0.51, 0.0), (5.08, 1.02, 0.0), (7.62, 0.76, 0.0), (8.89, 2.03, 0.0), (10.16, 2.03, 0.0),
    (10.67, 3.30, 0.0), (11.43, 3.30, 1.52), (12.70, 2.54, 1.78), (13.46, 2.54, 0.0), (16.51, 1.27, 0.0),
    (19.05, 1.27, 0.0), (22.86, 1.52, 0.0), (26.67, 1.52, 0.0), (28.70, 1.27, 0.0), (30.48, 1.27, 0.0),
    (31.50, 3.81, 0.0), (34.54, 2.03, 0.0), (35.81, 2.03, 1.52),
]  # fmt: skip


def disc(node, outer):
    return rs.DiskElement.from_geometry(n=node, material=STEEL, width=0.07, i_d=0.05, o_d=outer)


def two_discs(elements, axial=0.0, **bearing):
    shaft = [
        rs.ShaftElement(L=1.5 / elements, idl=0, odl=0.05, material=STEEL, axial_force=axial)
        for _ in range(elements)
    ]
    bearing = {"cxx": 0.0, **bearing}
    bearings = [rs.BearingElement(n=node, **bearing) for node in (0, elements)]
    return rs.Rotor(shaft, [disc(elements // 3, 0.28), disc(2 * elements // 3, 0.35)], bearings)


def overhung():
    shaft = [rs.ShaftElement(L=0.25, idl=0, odl=0.05, material=STEEL) for _ in range(6)]
    return rs.Rotor(shaft, [disc(6, 0.35)], [rs.BearingElement(n=n, kxx=1e7, cxx=0) for n in (0, 4)])


def tapered(elements):
    def diameter(i):
        return 0.025 + 0.015 * i / elements

    shaft = [
        rs.ShaftElement(L=1.5 / elements, idl=0, odl=diameter(i), idr=0, odr=diameter(i + 1), material=STEEL)
        for i in range(elements)
    ]
    bearings = [rs.BearingElement(n=n, kxx=1e7, cxx=1e3) for n in (0, elements)]
    return rs.Rotor(shaft, [disc(elements // 2, 0.28)], bearings)


def nelson_mcvaugh():
    steel = rs.Material(name="nelson", rho=7806, E=207.8e9, Poisson=0.3)
    shaft, start = [], 0.0
    for end, outer, inner in STEPS:
        shaft.append(rs.ShaftElement(L=0.01 * (end - start), idl=0.02 * inner, odl=0.02 * outer, material=steel))
        start = end
    wheel = rs.DiskElement(n=4, m=1.401, Id=0.00136, Ip=0.00203)
    return rs.Rotor(shaft, [wheel], [rs.BearingElement(n=n, kxx=4.378e7, cxx=0) for n in (10, 14)])


ROTORS = {
    "isotropic": lambda: two_discs(6, kxx=1e6),
    "anisotropic": lambda: two_discs(12, kxx=1e6, kyy=8e5),
    "cross_coupled": lambda: two_discs(12, kxx=1e6, kyy=1e6, kxy=5e5, kyx=0.0),
    "damped": lambda: two_discs(6, kxx=1e6, cxx=3e3),
    "overhung": overhung,
    "tension": lambda: two_discs(12, axial=1e5, kxx=1e6),
    "compression": lambda: two_discs(12, axial=-1e5, kxx=1e6),
    "tapered_12": lambda: tapered(12),
    "tapered_48": lambda: tapered(48),
    "nelson_mcvaugh": nelson_mcvaugh,
}


def eigenvalues(rotor, spin):
    """Oscillating lateral eigenvalues by damped frequency."""
    lateral = [i for i in range(rotor.ndof) if i % 6 in (0, 1, 3, 4)]
    pick = np.ix_(lateral, lateral)
    mass, stiffness = rotor.M()[pick], rotor.K(spin)[pick]
    damping = rotor.C(spin)[pick] + spin * rotor.G()[pick]
    n = len(lateral)
    lower = scipy.linalg.solve(mass, np.hstack([-stiffness, -damping]))
    state = np.vstack([np.hstack([np.zeros((n, n)), np.eye(n)]), lower])
    values = scipy.linalg.eigvals(state)
    values = values[values.imag > 1e-3]
    return values[np.argsort(values.imag)]


def critical_speeds(rotor):
    """ROSS's own; where its iteration does not converge, spins at which a pair of its matrices is singular."""
    try:
        result = rotor.run_critical_speed(num_modes=12, rtol=1e-10)
        return [w for w, way in zip(result.wn(), result.whirl_direction) if way != "None"]
    except RuntimeError:
        print("  run_critical_speed does not converge on the next rotor: K q = w^2 (M - iG) q instead")
    lateral = [i for i in range(rotor.ndof) if i % 6 in (0, 1, 3, 4)]
    pick = np.ix_(lateral, lateral)
    squares = scipy.linalg.eigvals(rotor.K(0)[pick], rotor.M()[pick] - 1j * rotor.G()[pick]).real
    return np.sqrt(np.sort(squares[squares > 0]))


def main():
    ours = defaultdict(list)
    for line in open(sys.argv[1], encoding="utf-8").read().split()[1:]:
        rotor, quantity, spin, index, value = line.split(",")
        ours[rotor, quantity].append((float(spin), int(index), float(value)))
    print(f"ROSS {rs.__version__}")
    lines = ["rotor,quantity,spin_rad_s,index,value"]
    print(f"{'rotor':16}{'quantity':12}{'values':>7}  greatest relative difference")
    for name, make in ROTORS.items():
        rotor = make()
        spectra = {spin: eigenvalues(rotor, spin) for spin, _, _ in ours[name, "frequency"]}
        theirs = {
            "frequency": lambda spin, index: spectra[spin][index].imag,
            "ratio": lambda spin, index: -spectra[spin][index].real / abs(spectra[spin][index]),
        }
        if ours[name, "critical"]:
            speeds = critical_speeds(rotor)
            theirs["critical"] = lambda _, index: speeds[index]
        spins = sorted({spin for spin, _, _ in ours[name, "unbalance"]})
        response = rotor.run_unbalance_response(
            node=2, unbalance_magnitude=1e-3, unbalance_phase=0.0, frequency=np.array(spins)
        ).forced_resp

        def major(spin, node):
            x, y = response[6 * node : 6 * node + 2, spins.index(spin)]
            return (abs(x + 1j * y) + abs(x - 1j * y)) / 2

        theirs["unbalance"] = major
        for quantity, value in theirs.items():
            rows = ours[name, quantity]
            pairs = [(a, value(spin, index)) for spin, index, a in rows]
            lines += [f"{name},{quantity},{row[0]},{row[1]},{b:.12g}" for row, (_, b) in zip(rows, pairs)]
            size = max(abs(b) for _, b in pairs) if quantity == "ratio" else None
            if size is not None and size < 1e-9:
                continue  # undamped
            worst = max(abs(a - b) / (size or abs(b)) for a, b in pairs)
            print(f"{name:16}{quantity:12}{len(pairs):7}  {worst:.1e}")
    with open(sys.argv[1].removesuffix(".csv") + "-ross.csv", "w", encoding="utf-8") as file:
        file.write("\n".join(lines) + "\n")


main()
