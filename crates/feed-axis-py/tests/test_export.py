"""Compensators for controllers: files that compilers and other programs take."""

import shutil
import subprocess
from pathlib import Path

import feed_axis as fa
import pytest

# Twice the C code of a plan in one program, each under its own name.
MAIN = """
#include <stdio.h>
#include "x_plan.h"
#include "y_plan.h"
int main(void) { printf("%zu %zu", sizeof(x_plan), sizeof(y_plan)); return 0; }
"""


def test_two_plans_stand_in_one_program(axis: fa.Axis, tmp_path: Path) -> None:
    plan = fa.Compensator(axis, "plan")
    files = []
    for name in ("x_plan", "y_plan"):
        written = plan.export(tmp_path, name=name, precision="f32")
        assert written == [str(tmp_path / f"{name}.h"), str(tmp_path / f"{name}.c")]
        files.append(written[1])
    assert 'strategy plan, of the axis "liu2025"' in Path(files[0]).read_text()
    compiler = shutil.which("cc") or shutil.which("gcc")
    if compiler is None:
        pytest.skip("cc")
    main = tmp_path / "main.c"
    main.write_text(MAIN)
    program = tmp_path / "main"
    strict = ["-std=c99", "-Wall", "-Wextra", "-Werror", "-pedantic"]
    command = [compiler, *strict, str(main), *files, "-o", str(program), "-lm"]
    subprocess.run(command, check=True, cwd=tmp_path)
    first, second = subprocess.run([program], check=True, capture_output=True, text=True).stdout.split()
    assert first == second != "0"


def test_a_component_and_a_network_are_written(axis: fa.Axis, tmp_path: Path) -> None:
    component, example = fa.Compensator(axis, "plan").export(tmp_path, target="linuxcnc", name="x_plan")
    assert "component x_plan" in Path(component).read_text()
    assert "loadrt x_plan" in Path(example).read_text()
    samples = axis.sample(200)
    network = axis.train(samples, hidden=[3], epochs=3)
    (path,) = fa.Compensator(axis, "network", network=network).export(tmp_path, target="onnx", name="cycle")
    network.to_onnx(tmp_path / "own.onnx", inputs=["position", "velocity", "acceleration", "command"])
    own = (tmp_path / "own.onnx").read_bytes()
    assert b"position, velocity, acceleration, command" in own and b"y1" in own
    with pytest.raises(fa.NetworkError, match="described inputs"):
        network.to_onnx(tmp_path / "bad.onnx", inputs=["x"])
    assert path.endswith("cycle.onnx") and axis.fingerprint.encode() in Path(path).read_bytes()


def test_what_no_controller_runs_is_refused(axis: fa.Axis, tmp_path: Path) -> None:
    plan = fa.Compensator(axis, "plan")
    with pytest.raises(ValueError, match='target is "arduino"; valid: c, linuxcnc, onnx'):
        plan.export(tmp_path, target="arduino")  # type: ignore[arg-type]
    with pytest.raises(ValueError, match='precision is "f16"; valid: f32, f64'):
        plan.export(tmp_path, precision="f16")  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="fade_s is -1; valid: from 0 to"):
        plan.export(tmp_path, fade_s=-1.0)
    with pytest.raises(fa.StrategyError, match="valid"):
        plan.export(tmp_path, name="2 axes")
    with pytest.raises(fa.StrategyError, match="limit_surprise is missing: .*; valid: a number above 0"):
        fa.Compensator(axis, "feedback").export(tmp_path)
    with pytest.raises(fa.StrategyError, match="learns between moves"):
        fa.Compensator(axis, "adaptive").export(tmp_path)
    with pytest.raises(FileNotFoundError, match="nowhere"):
        plan.export(tmp_path / "nowhere")
    with pytest.raises(fa.StrategyError, match="network"):
        plan.export(tmp_path, target="onnx")
    assert not list(tmp_path.iterdir())
