#!/usr/bin/env bash
# Every strategy as a LinuxCNC component: compiled by halcompile without a warning, one of them run in HAL.
set -euo pipefail
source .ci/release.d/lib.bash
out=$PWD/target/controller-export/linuxcnc

if ! have halcompile linuxcnc-uspace-dev; then
  skipped "halcompile is not there: no LinuxCNC component was compiled"
  exit 0
fi
rm -rf "$out"
cargo run --quiet --locked -p controller-export --example export_linuxcnc -- "$out"
cd "$out"
for component in *.comp; do
  log=$(halcompile --compile "$component" 2>&1) || { printf '%s\n' "$log"; exit 1; }
  if grep -i warning <<<"$log"; then exit 1; fi
  echo "$component: compiled"
done

modules=/usr/lib/linuxcnc/modules
if [ "$(id -u)" != 0 ] || ! command -v halrun >/dev/null; then
  skipped "not root, or no halrun: no component was run in HAL"
  exit 0
fi
trap 'rm -f "$modules/network_lugre.so"' EXIT
cp network_lugre.so "$modules/"
cat > run.hal <<'END'
loadrt network_lugre names=comp.x
loadrt threads name1=servo period1=100000
addf comp.x.update-feedback servo
addf comp.x.update servo
setp comp.x.pos-cmd-in 400
setp comp.x.pos-fb-in 399.99
setp comp.x.enable-in TRUE
start
loadusr -w sleep 1
getp comp.x.fault
getp comp.x.status-out
getp comp.x.pos-cmd-out
getp comp.x.update.time
unloadrt all
END
# HAL does not run real-time code as root, and another user must reach its socket.
said=$(RTAPI_UID=65534 RTAPI_FIFO_PATH=/tmp/rtapi-fifo-$$ timeout 60 halrun -f run.hal 2>/dev/null | tail -4)
mapfile -t pins <<<"$said"
echo "in HAL: fault ${pins[0]}, status ${pins[1]}, command ${pins[2]}, ${pins[3]} ns a cycle"
[ "${pins[0]}" = FALSE ] && [ "${pins[1]}" = 1 ] && awk "BEGIN { exit !(${pins[2]} > 400.005 && ${pins[2]} < 400.015) }"
