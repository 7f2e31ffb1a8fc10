#!/usr/bin/env bash
# The crates as another project gets them: made into packages and built from these, each feature
# alone, with the oldest Rust that they promise, and their interface beside the last release's.
set -euo pipefail
source .ci/release.d/lib.bash
export CARGO_INCREMENTAL=0
export PATH="$PWD/target/tools/bin:$PATH"

# cargo_tool NAME VERSION: whether the subcommand is there, or can be built.
cargo_tool() {
  command -v "$1" >/dev/null && return 0
  cargo install "$1" --version "$2" --locked --root target/tools --target-dir target/tools-build --quiet
}

crates=() names=()
for folder in crates/*/; do
  names+=("$(basename "$folder")")
  crates+=(-p "${names[-1]}")
done
last=$(git describe --tags --abbrev=0 --match 'v*' 2>/dev/null || true)

echo "-- names that are free"
# Before the first release any crate of a name is another's, and cargo would take it for ours.
# Asked from a folder outside the workspace, where a name means the registry's crate.
on_registry() { (cd / && cargo info --quiet --registry crates-io "$1") >/dev/null 2>&1; }
if [ -n "$last" ]; then
  echo "$last is released: the names are taken, by this project"
elif on_registry serde; then
  for name in "${names[@]}"; do
    ! on_registry "$name" || { echo "error: crates.io has another crate named $name: rename ours" >&2; exit 1; }
  done
  echo "crates.io has none of ${#names[@]} names"
else
  skipped "crates.io was not reached: names were not looked up"
fi

echo "-- packages, in the order of publishing"
cargo run --quiet --locked -p xtask -- publish --dry-run

echo "-- each feature alone"
# One package at a time, its tests' dependencies not built: nothing else turns a feature on.
if cargo_tool cargo-hack 0.6.46; then
  cargo hack clippy --quiet --locked --each-feature "${crates[@]}" -- -D warnings
else
  skipped "cargo-hack could not be built: features were not checked alone"
fi

echo "-- the oldest Rust"
oldest=$(sed -n 's/^rust-version = "\(.*\)"/\1/p' Cargo.toml)
if command -v rustup >/dev/null &&
  { rustup toolchain list | grep -q "^$oldest" || rustup toolchain install "$oldest" --profile minimal; } >/dev/null 2>&1; then
  # A folder of its own: what another compiler made is of no use.
  CARGO_TARGET_DIR=target/oldest-rust cargo "+$oldest" check --quiet --locked --all-features "${crates[@]}"
  printf 'Rust %s builds all crates\n' "$oldest"
else
  skipped "Rust $oldest could not be installed: it was not tried"
fi

echo "-- the interface beside the last release's"
if [ -z "$last" ]; then
  skipped "no release is tagged (v…): there is no interface to compare with"
elif cargo_tool cargo-semver-checks 0.51.0; then
  cargo semver-checks check-release "${crates[@]}" --baseline-rev "$last" --all-features
else
  skipped "cargo-semver-checks could not be built: the interface was not compared with $last"
fi
