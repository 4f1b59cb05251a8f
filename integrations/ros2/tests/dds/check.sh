#!/usr/bin/env bash
# check.sh BINARY: the node with CycloneDDS on the other side, from a Python package. Makes an environment for it beside the binary.
set -euo pipefail
binary=$(realpath "$1")
python=$(dirname "$(dirname "$binary")")/dds
if [ ! -e "$python/complete" ]; then
  rm -rf "$python"
  python3 -m venv "$python"
  "$python/bin/pip" install -q --disable-pip-version-check cyclonedds==11.0.1 rosbags==0.11.9
  touch "$python/complete"
fi
"$python/bin/python" "$(dirname "$0")/check.py" "$binary"
