"""A stepped shaft with a mass at its end and a spring between, by OpenSees: frequencies in Hz, by elements a span.

    opensees.py

Needs openseespy (requirements-opensees.txt) and, on Debian, the packages libblas3 and liblapack3. The values of
`crates/beam-fem/tests/against_opensees.rs` are the limit that it prints.
"""

import math

import openseespy.opensees as ops

E, NU, RHO = 206e9, 0.3, 7850.0
G = E / (2 * (1 + NU))
# Length, outer and inner diameter, m.
SPANS = [(0.4, 0.05, 0.0), (0.5, 0.04, 0.02), (0.3, 0.03, 0.0)]
MASS, SPRING = 3.0, 2e6  # kg at the end, N/m at the end of the first span


def section(outer, inner):
    """Area, second moment, and area in shear with Cowper's coefficient of a tube."""
    area = math.pi / 4 * (outer**2 - inner**2)
    moment = math.pi / 64 * (outer**4 - inner**4)
    m = inner / outer
    tube = (1 + m * m) ** 2
    return area, moment, area * 6 * (1 + NU) * tube / ((7 + 6 * NU) * tube + (20 + 12 * NU) * m * m)


def frequencies(elements, count):
    ops.wipe()
    ops.model("basic", "-ndm", 2, "-ndf", 3)
    ops.geomTransf("Linear", 1)
    ops.node(1, 0.0, 0.0)
    ops.fix(1, 1, 1, 1)
    x, node = 0.0, 1
    for length, outer, inner in SPANS:
        area, moment, in_shear = section(outer, inner)
        for _ in range(elements):
            x, node = x + length / elements, node + 1
            ops.node(node, x, 0.0)
            ops.fix(node, 1, 0, 0)
            ops.element(
                "ElasticTimoshenkoBeam", node, node - 1, node, E, G, area, moment, in_shear, 1,
                "-mass", RHO * area, "-cMass",
            )  # fmt: skip
    ops.mass(node, 0.0, MASS, 0.0)
    ops.node(node + 1, SPANS[0][0], 0.0)
    ops.fix(node + 1, 1, 1, 1)
    ops.uniaxialMaterial("Elastic", 1, SPRING)
    ops.element("zeroLength", node + 1, node + 1, elements + 1, "-mat", 1, "-dir", 2)
    return [math.sqrt(value) / (2 * math.pi) for value in ops.eigen(count)]


found = {elements: frequencies(elements, 4) for elements in (10, 20, 40, 80)}
for elements, values in found.items():
    print(elements, *(f"{f:.9f}" for f in values))
# Its error falls with the square of an element's length.
print("limit", *(f"{fine + (fine - coarse) / 3:.9f}" for coarse, fine in zip(found[40], found[80])))
