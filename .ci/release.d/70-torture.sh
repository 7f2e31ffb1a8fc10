#!/usr/bin/env bash
# Damaged and made-up inputs, and runs that are doubled, starved and killed, at every stage and size; the tests take a
# few. Each time from another seed, which is told: TORTURE_SEED=N repeats it.
set -euo pipefail
seed=${TORTURE_SEED:-$(od -An -N4 -tu4 /dev/urandom | tr -d ' ')}
echo "torture from seed $seed"
cargo run --quiet --locked -p xtask -- torture --seed "$seed" --minutes 4 --kills 30 --out target/torture
