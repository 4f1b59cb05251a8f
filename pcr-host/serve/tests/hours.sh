#!/usr/bin/env bash
# hours.sh PCR FOLDER [SECONDS] [LAYOUT...]: vehicles at work for an hour of theirs on each layout of tests/data, on as many of its safe ends as
# there are but one, 100 at most: with the supervisor over mosquitto, ten of their seconds (PACE) in one of ours; with it in steps of time; and in the same
# steps with locks on whole routes and on edges. The same vehicles, missions drawn from the same numbers, and the same delays: hold-ups of
# up to 2 s about every 20 s, up to 5 % slower, 1 % of the messages lost, 1 % twice, 1 % up to 3 s late, no connection for 1 % of the time.
# (NO_BROKER=1, METHODS="supervisor ...": some of the columns.)
# Then no more missions, and all have to come to their ends. Prints the table of docs/maintain/serve.md; where vehicles were is in FOLDER.
set -euo pipefail
cd "$(dirname "$0")/../../.."
pcr=$1 out=$2 time=${3:-3600}
shift $(($# < 3 ? $# : 3))
data=tests/data/real
layouts=("$@")
if [ $# = 0 ]; then
  layouts=($data/nav2/{aws,sample,warehouse}_graph.geojson $data/rmf/{battle_royale,hotel,office,triple_H}.building.yaml
    $data/opentcs/Demo-01.xml $data/opendrive/Town0{1,2}.planview.xodr $data/ccbs/sparse_map.xml --streets=6)
fi
mkdir -p "$out"
# An hour has 2.4 times in which a vehicle is not connected for 15 s, as a mean.
trouble=(--weather 0.01 --time "$time" --finish)
children=()
trap 'kill "${children[@]}" 2>/dev/null || true' EXIT

# What a run has printed, and its record: missions; and what went wrong, if anything.
found() {
  local text=$1 record=$2 missions twice left verdict wrong=""
  missions=$(sed -n 's/.*: \([0-9]*\) missions done.*/\1/p' "$text")
  twice=$(sed -n 's/two vehicles with the right of way at one place: \([0-9]*\) of.*/\1/p' "$text")
  left=$(sed -n 's/^\([0-9]*\) have not come to their ends.*/\1/p' "$text")
  verdict=$("$pcr" fleet --certify "$record" | sed 's/.*"verdict":"\([a-z]*\)".*/\1/') || true
  [ "$verdict" = proved ] || wrong+=" **$verdict**"
  [ "$twice" = 0 ] || wrong+=" **$twice rights twice**"
  [ "$left" = 0 ] || wrong+=" **$left stuck**"
  echo "$missions$wrong"
  rm -f "$record"
}

# The same over a broker.
broker() {
  local layout=$1 vehicles=$2 name=$3 port=$((20000 + RANDOM % 20000)) pace=${PACE:-10}
  local mosquitto=mosquitto own=()
  command -v mosquitto >/dev/null || mosquitto=/usr/sbin/mosquitto
  printf 'listener %s 127.0.0.1\nallow_anonymous true\nset_tcp_nodelay true\n' $port >"$out/mosquitto.conf"
  $mosquitto -c "$out/mosquitto.conf" >/dev/null 2>&1 & own+=($!)
  children+=("${own[@]}")
  # What the supervisor is told of them; no broker is needed for that.
  "$pcr" fleet "$layout" --vehicles "$vehicles" --profiles "$out/vehicles.json" --alone supervisor --time 0.1 >/dev/null
  rm -rf "$out/journal"
  "$pcr" serve --journal "$out/journal" --stay --broker localhost:$port --fleet "$out/vehicles.json" --log error </dev/null 2>"$out/$name.log" & own+=($!)
  children+=("${own[@]}")
  "$pcr" fleet "$layout" --vehicles "$vehicles" --manager --pace $pace --drops $((24 * pace / 10)) --broker localhost:$port "${trouble[@]}" \
    --record "$out/record" >"$out/text" || [ $? = 1 ]
  kill "${own[@]}"
  wait "${own[@]}" 2>/dev/null || true
  found "$out/text" "$out/record"
}

echo "| layout | places | vehicles | over mosquitto | supervisor | route locks | edge locks |"
echo "|---|---|---|---|---|---|---|"
for layout in "${layouts[@]}"; do
  places=$({ "$pcr" fleet "$layout" --vehicles 100000 --alone supervisor --time 1 2>&1 || true; } | sed -n "s/.*there are \([0-9]*\)/\1/p")
  vehicles=$((places - 1 < 100 ? places - 1 : 100))
  name=$(basename -- "$layout" | sed 's/[._].*//; s/--//; s/=/-/')
  row="| $name | $places | $vehicles | $([ -n "${NO_BROKER:-}" ] && echo - || broker "$layout" "$vehicles" "$name") |"
  for method in ${METHODS-supervisor route-locks edge-locks}; do
    "$pcr" fleet "$layout" --vehicles "$vehicles" --alone $method --drops 2.4 "${trouble[@]}" --record "$out/record" >"$out/text" || [ $? = 1 ]
    row+=" $(found "$out/text" "$out/record") |"
  done
  echo "$row"
done
