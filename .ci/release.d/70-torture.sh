#!/usr/bin/env bash
# Runs that are doubled, starved and killed, at every stage and size; the tests take one of each.
set -euo pipefail
cargo run --quiet --locked -p xtask -- torture --inputs 0 --kills 30 --out target/torture
