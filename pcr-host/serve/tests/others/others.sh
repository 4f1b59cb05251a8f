#!/usr/bin/env bash
# others.sh PCR: `PCR serve` between vehicles and a fleet manager that others wrote: vda-5050-lib of npm, in the version that is named here.
set -euo pipefail
tool=$(realpath "$1")
script=$(realpath "$(dirname "$0")")/vda-5050-lib.js
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
npm install --no-audit --no-fund --silent vda-5050-lib@1.4.0
node "$script" "$tool"
