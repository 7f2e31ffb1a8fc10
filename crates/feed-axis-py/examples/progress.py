"""A bar of tqdm for long work: `python examples/progress.py data/axes/liu2025.toml`.

`progress=` takes a function of what is done, how much of it, and of how much: `None` where that
is not known beforehand, as in a search.
"""

import sys
from typing import NoReturn

import feed_axis as fa
from tqdm import tqdm


class Bar:
    """A bar for each kind of work that is told."""

    def __init__(self) -> None:
        self.bar: tqdm[NoReturn] | None = None
        self.what = ""

    def __call__(self, what: str, done: int, total: int | None) -> None:
        # Stages that cannot be counted share one bar, which names them.
        if self.bar is None or (total is not None and what != self.what):
            self.close()
            self.bar = tqdm(total=total)
        self.what = what
        self.bar.set_description(what, refresh=False)
        self.bar.n = done
        self.bar.refresh()

    def close(self) -> None:
        """Ends the bar on its line."""
        if self.bar is not None:
            self.bar.close()
            self.bar = None


def main(path: str) -> None:
    """Samples and a small training, with bars."""
    axis = fa.Axis.load(path)
    bar = Bar()
    samples = axis.sample(2000, near_zero=True, progress=bar)
    network = axis.train(samples, hidden=[14, 8, 4], epochs=30, progress=bar)
    bar.close()
    most, mean = network.test(axis.sample(500, seed=2))
    print(f"one cycle ahead: {most:.2e} µ{axis.unit} at most, {mean:.2e} µ{axis.unit} on average")


if __name__ == "__main__":
    main(sys.argv[1])
