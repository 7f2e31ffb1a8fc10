"""Runs the notebooks of a folder: `python .ci/notebooks.py FOLDER [--keep OUT]`.

Fails where a cell raises, where one of them was committed with outputs, or where the folder has
none. With `--keep` the run notebooks are written there, with their outputs.
"""

import argparse
import time
from pathlib import Path

import nbformat
from nbclient import NotebookClient

MOST_SECONDS_PER_CELL = 300


def run(path: Path, keep: Path | None) -> None:
    """Runs one notebook in its folder."""
    notebook = nbformat.read(path, as_version=4)  # type: ignore[no-untyped-call]
    nbformat.validate(notebook)
    if any(cell.get("outputs") for cell in notebook.cells):
        raise SystemExit(f"{path}: has outputs; clear them before it is committed")
    started = time.monotonic()
    resources = {"metadata": {"path": str(path.parent)}}
    NotebookClient(notebook, timeout=MOST_SECONDS_PER_CELL, resources=resources).execute()
    if keep is not None:
        keep.mkdir(parents=True, exist_ok=True)
        nbformat.write(notebook, keep / path.name)  # type: ignore[no-untyped-call]
    print(f"{path.name}: {time.monotonic() - started:.0f} s", flush=True)


def main() -> None:
    """Runs all of them, in the order of their names."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--keep", type=Path, metavar="OUT")
    options = parser.parse_args()
    paths = sorted(options.folder.glob("*.ipynb"))
    if not paths:
        raise SystemExit(f"{options.folder}: there is no notebook")
    for path in paths:
        run(path, options.keep)


if __name__ == "__main__":
    main()
