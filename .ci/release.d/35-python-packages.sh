#!/usr/bin/env bash
# The Python module as users get it: a source distribution that builds in an empty environment, away from this folder, and
# wheels that are named by their platform.
set -euo pipefail
source .ci/release.d/lib.bash
export CARGO_INCREMENTAL=0 PIP_DISABLE_PIP_VERSION_CHECK=1

.ci/python --environment >/dev/null
venv=target/python/venv
# One folder for what both builds compile; what a user's first build takes is printed below.
export CARGO_TARGET_DIR=$PWD/target/python/release
rm -rf target/python/packages target/python/clean
mkdir -p target/python/packages

echo "-- a source distribution"
"$venv/bin/maturin" sdist --quiet --manifest-path crates/feed-axis-py/Cargo.toml --out target/python/packages 2>/dev/null
sdist=$(echo "$PWD"/target/python/packages/feed_axis-*.tar.gz)
# Nothing that only this folder has.
if tar tzf "$sdist" | grep -E '^feed_axis-[^/]*/(target|data|docs|xtask)/' | head -3 | grep .; then
  echo "error: the source distribution has files that do not belong in it" >&2
  exit 1
fi

echo "-- pip install of it, in an empty environment"
python3 -m venv target/python/clean
python=$PWD/target/python/clean/bin/python
begin=$(date +%s)
(cd / && "$python" -m pip install --quiet "$sdist")
printf 'built and installed in %s s on %s cores\n' $(($(date +%s) - begin)) "$(nproc)"
(cd / && "$python" - <<'PYTHON'
import feed_axis as fa

axis = fa.new("belt", "x-axis")
run = axis.simulate(axis.trajectories[0])
assert run.error.size > 100 and fa.examples(), run
print(f"{fa.__version__}: {run}")
PYTHON
)

echo "-- a wheel for this platform"
"$venv/bin/maturin" build --quiet --release --locked --manifest-path crates/feed-axis-py/Cargo.toml --interpreter "$python" --out target/python/packages
wheel=$(basename target/python/packages/feed_axis-*.whl)
case $wheel in
  feed_axis-*-cp310-abi3-*linux*_"$(uname -m)".whl | feed_axis-*-cp310-abi3-macosx_*.whl | feed_axis-*-cp310-abi3-win_*.whl) echo "$wheel" ;;
  *) echo "error: $wheel does not say which platform and Python it is for" >&2 && exit 1 ;;
esac
