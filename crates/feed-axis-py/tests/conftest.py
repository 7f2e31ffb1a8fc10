"""What several tests share."""

import re
from pathlib import Path

import feed_axis as fa
import pytest

ROOT = Path(__file__).parents[3]


def pytest_runtest_logreport(report: pytest.TestReport) -> None:
    """Puts a test that is left out on the list of `.ci/skipped`, with what it lacks."""
    if not report.skipped:
        return
    why = report.longrepr[2] if isinstance(report.longrepr, tuple) else str(report.longrepr)
    why = why.removeprefix("Skipped: ")
    module = re.match(r"could not import '(\w+)'", why)
    shared = re.match(r"shared (\S+)$", why)
    kind, what = "other", why
    if module:
        kind, what = "python", module[1]
    elif shared:
        kind, what = "shared", shared[1]
    with (ROOT / "target/skipped-tests").open("a") as skipped:
        skipped.write(f"{kind}\t{what}\tfeed_axis: {report.nodeid}\n")


@pytest.fixture(scope="session")
def root() -> Path:
    """Folder of the project."""
    return ROOT


@pytest.fixture(scope="session")
def axis() -> fa.Axis:
    """The paper's axis."""
    return fa.Axis.load(ROOT / "data/axes/liu2025.toml")


@pytest.fixture(scope="session")
def run(axis: fa.Axis) -> fa.Run:
    """Its first move."""
    return axis.simulate(axis.trajectories[0])
