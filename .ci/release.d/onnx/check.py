"""The ONNX file is valid, and onnxruntime gives what Rust gives, to 1e-12 relative."""

import sys
from pathlib import Path

import numpy as np
import onnx
import onnxruntime

folder = Path(sys.argv[1])
file = folder / "network.onnx"
onnx.checker.check_model(str(file), full_check=True)

session = onnxruntime.InferenceSession(str(file), providers=["CPUExecutionProvider"])
x = np.fromfile(folder / "x.bin", dtype="<f8").reshape(-1, 4)
expected = np.fromfile(folder / "y.bin", dtype="<f8").reshape(-1, 1)
(y,) = session.run(None, {"x": x})
off = np.abs(y - expected)
print(f"onnx {onnx.__version__}, onnxruntime {onnxruntime.__version__}: {len(x)} samples,")
print(f"  worst deviation over the value {np.max(off / np.abs(expected)):.2g},")
print(f"  over the greatest value {np.max(off) / np.max(np.abs(expected)):.2g}")
for key, value in session.get_modelmeta().custom_metadata_map.items():
    print(f"  {key}: {value}")
sys.exit(0 if np.max(off) <= 1e-12 * np.max(np.abs(expected)) else 1)
