#!/usr/bin/env bash
# unpack.sh MACHINE FOLDER PACKAGE...           packages of Debian for another machine, such as aarch64, unpacked into FOLDER and not installed
# unpack.sh --needs MACHINE FOLDER PACKAGE...   with all that they need
set -euo pipefail
needs=no
if [ "${1:-}" = --needs ]; then needs=yes; shift; fi
[ $# -ge 3 ] || { sed -n '2,3s/^# //p' "$0" >&2; exit 2; }
machine=$1 folder=$2
shift 2
case $machine in
  x86_64) machine=amd64 ;;
  aarch64) machine=arm64 ;;
esac
command -v apt-get >/dev/null || { echo "unpack: no apt-get to fetch $*" >&2; exit 1; }
apt=$(mktemp -d)
trap 'rm -rf "$apt"' EXIT
mkdir -p "$apt"/{lists/partial,cache/archives/partial} "$folder"
touch "$apt/status"
# Lists of its own: this machine's packages and those that it has installed have no say.
printf '%s;\n' "APT::Architecture \"$machine\"" "APT::Architectures { \"$machine\"; }" "Dir::State \"$apt\"" \
  "Dir::State::status \"$apt/status\"" "Dir::Cache \"$apt/cache\"" 'APT::Sandbox::User "root"' >"$apt/conf"
export APT_CONFIG=$apt/conf
apt-get -qq update
if [ $needs = yes ]; then
  apt-get -qq install --download-only --no-install-recommends -y "$@" >/dev/null
else
  (cd "$apt/cache/archives" && apt-get -qq download "$@")
fi
for package in "$apt"/cache/archives/*.deb; do dpkg-deb -x "$package" "$folder"; done
# Newer packages have everything below usr, where the system has links to it.
[ -e "$folder/lib" ] || [ ! -d "$folder/usr/lib" ] || ln -s usr/lib "$folder/lib"
