#!/usr/bin/env bash
# The network as ONNX: checked by onnx, run by onnxruntime and compared with Rust.
set -euo pipefail
source .ci/release.d/lib.bash
out=$PWD/target/controller-export/onnx
venv=$PWD/target/venv-onnx

if ! have python3 python3 python3-venv; then
  skipped "python3 is not there: the ONNX file was not run"
  exit 0
fi
if ! "$venv/bin/python" -c 'import onnx, onnxruntime' 2>/dev/null; then
  { python3 -m venv "$venv" && "$venv/bin/pip" install --quiet onnx onnxruntime numpy; } >/dev/null 2>&1 || {
    skipped "onnx and onnxruntime could not be installed: the ONNX file was not run"
    exit 0
  }
fi
cargo run --quiet --locked -p controller-export --example export_onnx -- "$out"
"$venv/bin/python" .ci/release.d/onnx/check.py "$out"
