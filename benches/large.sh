#!/bin/bash
# benches/large.sh PCR [AGENTS...]: what the commands take for fleets of pairs that cross, 8 m apart: processor time an agent and memory, as
# a table. The time is that of all cores, reading and printing included, and hardly depends on what else the machine does; it is the mean of
# some runs where it is short. `map` draws one agent with those that it meets.
set -euo pipefail
tool=${1:?the tool}
shift
[ $# -gt 0 ] || set -- 10000 100000 1000000
folder=$(mktemp -d)
trap 'rm -r "$folder"' EXIT
commands=("check --format csv" "regions --format csv" "plan -q" "certify -q" "map --agent 1 -q -o $folder/maps")
head="| agents |" line="|---:|"
for command in "${commands[@]}"; do
    head+=" \`${command%% *}\` | memory |" line+="---:|---:|"
done
echo "$head"
echo "$line"
for agents in "$@"; do
    awk -v agents="$agents" 'BEGIN {
        pairs = agents / 2; side = int(sqrt(pairs)) + 1
        printf "{\"agents\":["
        for (k = 0; k < pairs; k++) {
            x = k % side * 8; y = int(k / side) * 8
            line = "\"radius\":0.3,\"v_max\":1,\"a_max\":1,\"path\":[{\"kind\":\"line\",\"length\":4}],\"start\":{\"x\":%d,\"y\":%d,\"heading\":%s}}"
            printf "%s{\"id\":%d," line ",{\"id\":%d," line, k ? "," : "", 2 * k + 1, x - 2, y, "0", 2 * k + 2, x, y - 2, "1.5707963"
        }
        printf "]}"
    }' > "$folder/fleet.json"
    row="| $agents |" runs=$((agents < 100000 ? 20 : agents < 1000000 ? 3 : 1))
    for command in "${commands[@]}"; do
        read -ra words <<< "$command"
        rm -f "$folder/time"
        for ((run = 0; run < runs; run++)); do
            # They collide: exit status 1 is an answer.
            /usr/bin/time -a -o "$folder/time" -f '%U %S %M' "$tool" "${words[0]}" "$folder/fleet.json" "${words[@]:1}" > /dev/null || [ $? = 1 ]
        done
        row+=$(grep -v status "$folder/time" | awk -v agents="$agents" '{ time += $1 + $2; most = $3 } END { printf " %.1f µs | %d MB |", time / NR / agents * 1e6, most / 1000 }')
    done
    echo "$row"
done
