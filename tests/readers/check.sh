#!/bin/sh
# Written exclusions, by readers that share nothing with the tool: tests/readers/check.sh [PCR]
set -eu
cd "$(dirname "$0")/../.."
target=${CARGO_TARGET_DIR:-target}
tool=${1:-$target/release/pcr}
python=$target/readers
[ -x "$python/bin/python" ] || { python3 -m venv "$python" && "$python/bin/pip" install -q --disable-pip-version-check PyYAML==6.0.3; }
"$python/bin/python" tests/readers/check.py "$tool" "$target/readers-files"
