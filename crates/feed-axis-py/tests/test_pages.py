"""Pages of results, as files and in notebooks."""

from pathlib import Path

import feed_axis as fa
import pytest


def test_a_run_has_a_page(run: fa.Run, tmp_path: Path) -> None:
    page = run.to_html(tmp_path / "run.html")
    assert (tmp_path / "run.html").read_text() == page == run.to_html()
    assert page.startswith("<!DOCTYPE html>") and "Motion of liu2025" in page and "54.45" in page
    assert "src=\"http" not in page and "NaN" not in page
    assert "<table>" in run._repr_html_()
    with pytest.raises(FileNotFoundError, match="nowhere"):
        run.to_html(tmp_path / "nowhere/run.html")
