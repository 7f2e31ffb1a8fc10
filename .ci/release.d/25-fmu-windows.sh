#!/usr/bin/env bash
# The library of units for Windows: built from here, put into units beside Linux's, and called by programs in C under wine.
set -euo pipefail
source .ci/release.d/lib.bash
export CARGO_INCREMENTAL=0

target=x86_64-pc-windows-gnu
rustup target list --installed 2>/dev/null | grep -qx $target || rustup target add $target >/dev/null 2>&1 ||
  { skipped "the Rust target $target is not installed and cannot be (rustup target add $target): no library for Windows was built"; exit 0; }
have x86_64-w64-mingw32-gcc gcc-mingw-w64-x86-64 ||
  { skipped "no linker for Windows (Debian: gcc-mingw-w64-x86-64): no library was built"; exit 0; }
have wine wine wine64 || true

cargo test --quiet --locked -p feed-axis -p feed-axis-fmu --no-run
cargo build --quiet --locked -p feed-axis-fmu --target $target
venv=target/fmpy-venv
[ -x "$venv/bin/python" ] || python3 -m venv "$venv"
"$venv/bin/python" -c 'import fmpy' 2>/dev/null || "$venv/bin/pip" install --quiet --disable-pip-version-check fmpy==0.3.32
"$venv/bin/python" -B .ci/fmu_windows.py target/debug/feed-axis target/debug/deps/libfeed_axis_fmu.so target/$target/debug/feed_axis_fmu.dll
