#!/usr/bin/env bash
# install.sh PACKAGE...: installs packages of Debian, as root, and says so. Another process that holds the locks is waited for.
set -euo pipefail
if [ "$(id -u)" != 0 ] || ! command -v apt-get >/dev/null; then
  echo "missing, please install: $*" >&2
  exit 1
fi
echo "installing $*" >&2
log=$(mktemp)
trap 'rm -f "$log"' EXIT
# The lock of the lists has no timeout of its own.
for attempt in {1..120}; do
  if apt-get -qq update >"$log" 2>&1 &&
    apt-get -qq -o DPkg::Lock::Timeout=600 install -y --no-install-recommends "$@" >"$log" 2>&1; then exit 0; fi
  grep -q "Could not get lock" "$log" || break
  sleep 5
done
tail -5 "$log" >&2
exit 1
