#!/usr/bin/env bash
# Pages in a headless Chromium; skipped with a message where there is none.
set -euo pipefail
exec "$(dirname "$0")/../browser"
