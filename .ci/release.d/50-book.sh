#!/usr/bin/env bash
# The book is built without a warning, and every link of it leads somewhere. mdbook is installed below target/.
set -euo pipefail
exec "$(dirname "$0")/../book" --site
