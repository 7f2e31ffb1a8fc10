#!/usr/bin/env bash
# Every strategy in C, compiled with warnings as errors by gcc and clang and for a Cortex-M4F, run
# over recorded cycles and compared with Rust.
set -euo pipefail
source .ci/release.d/lib.bash
here=$PWD/.ci/release.d/cortex-m4
out=$PWD/target/controller-export

rm -rf "$out"
cargo run --quiet --locked -p controller-export --example export_c -- "$out" 20000 >/dev/null

warnings=(-std=c99 -O2 -Wall -Wextra -Wpedantic -Wfloat-equal -Werror)
# name, what is compiled where; then the program's own line
said() { printf '%-34s%-12s%s\n' "$1" "$2" "$3"; }

echo "cycles, equal to the bit, worst deviation, other status, bytes of state, ns (Cortex-M4F: instructions) a step"
for compiler in gcc clang; do
  have "$compiler" "$compiler" || { skipped "$compiler is not there"; continue; }
  for folder in "$out"/*/; do
    case=$(basename "$folder")
    "$compiler" "${warnings[@]}" "$folder/${case%-*}.c" "$folder/check.c" -o "$folder/check" -lm
    "$compiler" "${warnings[@]}" "$folder/${case%-*}.c" "$folder/stack.c" -o "$folder/stack" -lm
    said "$case" "$compiler" "$(cd "$folder" && ./check), stack painted and most instructions: $(cd "$folder" && ./stack)"
  done
done

if have arm-none-eabi-gcc gcc-arm-none-eabi libnewlib-arm-none-eabi && have qemu-system-arm qemu-system-arm; then
  arm=(-mcpu=cortex-m4 -mthumb -mfpu=fpv4-sp-d16 -mfloat-abi=hard --specs=rdimon.specs -nostartfiles
    -T "$here/link.ld" -DNOW=instructions -DNOW_PER_SECOND=1e9 "$here/start.c")
  qemu=(timeout 300 qemu-system-arm -M mps2-an386 -nographic -monitor none -serial none
    -icount shift=0 -semihosting -kernel check-m4)
  for folder in "$out"/*/; do
    case=$(basename "$folder")
    arm-none-eabi-gcc "${warnings[@]}" "${arm[@]}" "$folder/${case%-*}.c" "$folder/check.c" -o "$folder/check-m4" -lm
    checked=$(cd "$folder" && "${qemu[@]}")
    arm-none-eabi-gcc "${warnings[@]}" "${arm[@]}" "$folder/${case%-*}.c" "$folder/stack.c" -o "$folder/check-m4" -lm
    said "$case" cortex-m4f "$checked, stack painted and most instructions: $(cd "$folder" && "${qemu[@]}")"
  done
else
  skipped "arm-none-eabi-gcc or qemu-system-arm is not there: nothing was tried on a Cortex-M4F"
fi
