#!/usr/bin/env bash
# Crates beside independent programs: each docs/peers/*/run installs its program in an environment of its own, runs the
# crate's example, and ends with 1 if a figure differs by more than its page says.
set -euo pipefail
source .ci/release.d/lib.bash

if ! have python3 python3 python3-venv; then
  skipped "python3 is not there: no crate was compared with another program"
  exit 0
fi
for run in docs/peers/*/run; do
  printf '%s\n' "$run"
  environment=target/peers-$(basename "$(dirname "$run")")-venv
  if ! { [ -x "$environment/bin/python" ] || python3 -m venv "$environment"; } ||
    ! "$environment/bin/pip" install --quiet --disable-pip-version-check -r "$(dirname "$run")/requirements.txt" >/dev/null 2>&1; then
    skipped "$(dirname "$run")/requirements.txt could not be installed: $run was left out"
    continue
  fi
  bash "$run"
done
