#!/usr/bin/env bash
# Searches on hidden machines that take a quarter of a minute or more each, which .ci/run leaves out: the tests that are
# ignored as "slow".
set -euo pipefail
export CARGO_INCREMENTAL=0 CARGO_PROFILE_DEV_DEBUG=false PROPTEST_RNG_SEED=1
# Neither is a slow test: one writes a fixture, the other shows a fault that is known.
cargo test --workspace --features feed-axis/unified --locked --quiet -- --ignored \
  --skip make_the_parquet_fixture --skip without_a_way_back
