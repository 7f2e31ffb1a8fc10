# For the steps of a release: `source .ci/release.d/lib.bash`.

# have PROGRAM PACKAGE...: whether the program is there, or can be installed from these Debian packages.
have() {
  local program=$1
  shift
  command -v "$program" >/dev/null && return 0
  if command -v apt-get >/dev/null && [ "$(id -u)" = 0 ]; then
    { apt-get install -y --no-install-recommends "$@" ||
      { apt-get update && apt-get install -y --no-install-recommends "$@"; }; } >/dev/null 2>&1 || true
  fi
  command -v "$program" >/dev/null
}

# skipped WHAT: says that it was.
skipped() {
  printf 'skipped: %s\n' "$*"
}
