"""What several tests share."""

from pathlib import Path

import feed_axis as fa
import pytest

ROOT = Path(__file__).parents[3]


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
