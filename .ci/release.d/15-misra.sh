#!/usr/bin/env bash
# The exported C against MISRA C:2012 by cppcheck: counts deviations by rule, and fails at a rule that
# docs/controller-export.md gives no reason for.
set -euo pipefail
source .ci/release.d/lib.bash
page=docs/controller-export.md
out=$PWD/target/controller-export

have cppcheck cppcheck || { skipped "cppcheck is not there: nothing was checked against MISRA C:2012"; exit 0; }
[ -d "$out/plan-double" ] || cargo run --quiet --locked -p controller-export --example export_c -- "$out" 2000 >/dev/null

# Rows "| 12.1 | reason |" of the page.
reasons=$(sed -n 's/^| \([0-9]*\.[0-9]*\) | .*/\1/p' "$page")
found=$(for folder in "$out"/*-double/ "$out"/*-float/; do
  case=$(basename "$folder")
  cppcheck --quiet --addon=misra --enable=style --std=c99 "$folder/${case%-*}.c" 2>&1 | grep -o 'misra-c2012-[0-9.]*' || true
done | sort -t- -k3 -V | uniq -c)
[ -n "$found" ] || { echo "cppcheck found nothing at all: did its add-on run?"; exit 1; }
printf 'deviations from MISRA C:2012, all strategies in both precisions\n%s\n' "$found"
unexplained=0
while read -r _ rule; do
  grep -qxF "${rule#misra-c2012-}" <<<"$reasons" || { echo "no reason for ${rule#misra-c2012-} in $page"; unexplained=1; }
done <<<"$found"
exit $unexplained
