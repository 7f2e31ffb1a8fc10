"""Long work: other threads, progress, Ctrl-C."""

import signal
import subprocess
import sys
import threading
from pathlib import Path

import feed_axis as fa
import pytest


def test_other_threads_go_on_meanwhile(axis: fa.Axis) -> None:
    counted, done = 0, threading.Event()

    def count() -> None:
        nonlocal counted
        while not done.is_set():
            counted += 1
            done.wait(0.001)

    other = threading.Thread(target=count)
    other.start()
    before = counted
    axis.simulate(axis.trajectories[0], noise=1.0)
    after = counted
    done.set()
    other.join()
    # With the lock held it would be 0 or 1, however long it takes.
    assert after - before > 1


def test_progress_comes_to_its_end_and_may_raise(axis: fa.Axis) -> None:
    told: list[tuple[str, int, int | None]] = []
    axis.sample(1000, progress=lambda *news: told.append(news))
    assert told[-1] == ("sample", 1000, 1000)
    counts = [done for _, done, _ in told]
    assert counts == sorted(counts)

    def refuse(what: str, done: int, total: int | None) -> None:
        raise LookupError(what)

    with pytest.raises(LookupError, match="sample"):
        axis.sample(1000, progress=refuse)


# Each of many seconds. Python sets no handler where its parent ignores SIGINT, as shells have it
# for what runs in the background.
BEGIN = """
import signal, sys
import feed_axis as fa

signal.signal(signal.SIGINT, signal.default_int_handler)
axis = fa.Axis.load(sys.argv[1])

def begun(what, done, total):
    print("begun", flush=True)
"""
DISCOVER = """
text = "start_mm = 600.0"
for by in (100, -100):
    text += f'''
[[steps]]
dwell = {{ duration_s = 0.3 }}
[[steps]]
move_by = {{ by_mm = {by}, velocity_mm_s = 200, acceleration_mm_s2 = 1000, jerk_mm_s3 = 20000 }}'''
logs = [axis.simulate(fa.Program.from_toml(text), noise=1.0, seed=seed) for seed in (1, 2)]
fa.discover(axis, fit=[logs[0]], check=[logs[1]], progress=begun)
"""
TRAIN = """
samples = axis.sample(4000, near_zero=True)
axis.train(samples, epochs=100_000, progress=begun)
"""
SIMULATE = """
axis.simulate(fa.Program.from_toml(
    "start_mm = 600.0\\n[[steps]]\\ndwell = { duration_s = 1000.0 }"), progress=begun)
"""


@pytest.mark.parametrize("work", [DISCOVER, TRAIN, SIMULATE], ids=["discover", "train", "simulate"])
def test_ctrl_c_ends_it_before_its_end(work: str, root: Path) -> None:
    axis = root / "data/axes/liu2025.toml"
    command = [sys.executable, "-c", BEGIN + work + "\nprint('came to its end')", str(axis)]
    with subprocess.Popen(
        command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    ) as process:
        assert process.stdout is not None and process.stderr is not None
        try:
            assert process.stdout.readline() == "begun\n", process.stderr.read()
            process.send_signal(signal.SIGINT)
            # Far less than the work itself takes; how long it is depends on the machine.
            process.wait(timeout=60)
            said, rest = process.stderr.read(), process.stdout.read()
        finally:
            process.kill()
    assert "KeyboardInterrupt" in said and "came to its end" not in rest
    assert process.returncode == -signal.SIGINT
