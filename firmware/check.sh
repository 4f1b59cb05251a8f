#!/usr/bin/env bash
# Builds the firmware for every target and number format, runs it in QEMU, and compares what it prints and what it takes
# with the host and with the files in expected/. Any part that cannot run is a failure.
#   check.sh                     what continuous integration has time for: two of six targets and formats, of a third one the demo, one board
#   check.sh all                 everything
#   check.sh TARGET:FORMAT...    some
#   check.sh examples            those for all boards; continuous integration builds that for an STM32F4, which is in docs/guide/languages.md
#   check.sh climb SECONDS [TARGET:FORMAT...]  searches for worst cases for so long, half of it those of tables and half those of queries
#   UPDATE=1 check.sh ...        writes the files in expected/ instead of comparing with them; budgets hold all the same
# Installs what is missing as root on Debian, and says so; elsewhere it says what to install.
set -euo pipefail
cd "$(dirname "$0")"

matrix=(thumbv7em-none-eabihf:f32 thumbv6m-none-eabi:q16)
more=(riscv32imc-unknown-none-elf:q16 thumbv7m-none-eabi:q16 thumbv7em-none-eabihf:micro thumbv8m.main-none-eabihf:f32)
# Without "all" of these only the proof and the demo.
briefly=(riscv32imc-unknown-none-elf:q16)
# Further formats, for the proof that nothing panics.
proofs=(thumbv6m-none-eabi:q12 thumbv6m-none-eabi:q20)

out=${CARGO_TARGET_DIR:-$PWD/target}
host=$(rustc -vV | sed -n 's/^host: //p')
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT

step() { printf '\n-- %s\n' "$*"; }
fail() { echo "firmware: $*" >&2; exit 1; }

# need COMMAND PACKAGE
need() {
  command -v "$1" >/dev/null && return
  ../.ci/install.sh "$2" || fail "no $1"
  command -v "$1" >/dev/null || fail "no $1 in the package $2"
}

tools() {
  step "tools"
  need qemu-system-arm qemu-system-arm
  need qemu-system-riscv32 qemu-system-misc
  need arm-none-eabi-objdump binutils-arm-none-eabi
  need riscv64-unknown-elf-objdump binutils-riscv64-unknown-elf
  need readelf binutils
  need cc gcc
  need python3 python3
  tools/covered.py --test
  tools/covered.py board/src/bin/proof.rs ../pcr-core ../pcr-fixed
  if [ -z "${UPDATE:-}" ]; then tools/figures.py; fi
  cc -shared -fPIC -O2 -Wall -Wextra -o "$scratch/mcount.so" tools/mcount.c
  cargo build --locked --quiet --target "$host" -p pcr-link
  cargo test --locked --quiet --target "$host" -p pcr-supervisor --features micromath,fixed
  step "random fleets on a bad line: no two discs touch (docs/maintain/firmware.md has the long one)"
  link passing f32 300
  link passing q16 300
}

link() { "$out/$host/debug/pcr-link" "$@"; }

# build TARGET FORMAT BINARY...
build() {
  local target=$1 format=$2 bins=()
  shift 2
  for bin in "$@"; do bins+=(--bin "$bin"); done
  ./cross.sh "$target" build --locked --release --quiet --no-default-features --features "$format" "${bins[@]}"
}

# Outlines are in the proof that nothing panics, and in the program that is measured for them; all other figures are those of discs.
prove() { build "$1" "$2,outlines" proof; }

# The proof of the proof: what has a division by a number that is not known does not link.
control() {
  local target=$1 format=$2
  step "$target, $format: one that can panic is not linked"
  if build "$target" "$format,control" control 2>"$scratch/control"; then
    fail "a program that can panic was linked"
  fi
  grep -q "undefined symbol: ERROR: the program can panic" "$scratch/control" || fail "$(cat "$scratch/control")"
}

# What the demo prints, against the host.
table() {
  local target=$1 format=$2
  step "$target, $format: the same bits as on the host"
  link table "$format" >"$scratch/host"
  ./qemu-run.sh "$out/$target/release/demo" >"$scratch/target"
  diff "$scratch/host" "$scratch/target" || fail "the table differs from the host's"
  grep " pieces$" "$scratch/target"
  link certify <"$scratch/target" || fail "the table that was printed is not proved"
}

# Without optimization, as in a debug build: 12 agents are set up, and their table is computed, in 4 KiB of stack.
debug_stack() {
  local target=$1 format=$2 call
  step "$target, $format: stack of a debug build"
  ./cross.sh "$target" build --locked --quiet --no-default-features --features "$format,who-panics" --bin stacks --config 'profile.dev.opt-level=0'
  ./qemu-run.sh "$out/$target/debug/stacks" | head -3 | tee "$scratch/debug"
  for call in "the constructors" "the motions" Ecm::fill; do
    limit "$scratch/debug" "bytes of stack of $call" 4096
  done
}

# A control loop in an interrupt reads one table while the next one is computed.
handover() {
  local target=$1 format=$2
  step "$target, $format: tables are handed over to an interrupt"
  build "$target" "$format" handover
  ICOUNT=7 ./qemu-run.sh "$out/$target/release/handover"
}

# What it prints and sends, against the host.
behaviour() {
  local target=$1 format=$2 programs=$out/$1/release
  table "$target" "$format"
  SERIAL=stdio link serial "$format" ./qemu-run.sh "$programs/supervisor"
  SERIAL=stdio tools/client.py "$format" ./qemu-run.sh "$programs/supervisor"
  # The Cortex-M0 has no memory for orders of a fleet.
  case $target:$format in
    *:micro | thumbv6m*) ;;
    *) SERIAL=stdio link passing "$format" 5 ./qemu-run.sh "$programs/supervisor" ;;
  esac
  SERIAL=stdio ICOUNT=7 link robot "$format" ./qemu-run.sh "$programs/robot" 2>"$scratch/robot"
  if [ "$format" = f32 ]; then ./qemu-run.sh "$programs/roots"; fi
}

# The very images of the Cortex-M4F on a Cortex-M7: the same output, and the same instructions.
cortex_m7() {
  local programs=$out/thumbv7em-none-eabihf/release
  step "the images of the Cortex-M4F on a Cortex-M7"
  export QEMU_MACHINE=mps2-an500
  ./qemu-run.sh "$programs/demo" | diff "$scratch/host" - || fail "the table differs on a Cortex-M7"
  SERIAL=stdio link serial f32 ./qemu-run.sh "$programs/supervisor"
  ICOUNT=7 ./qemu-run.sh "$programs/measure" | sed 's/^\( *[0-9]*  \)/\1instructions: /' >"$scratch/m7"
  unset QEMU_MACHINE
  grep -Fxf "$scratch/figures" "$scratch/m7" | diff - "$scratch/m7" || fail "other instruction counts on a Cortex-M7"
}

# An STM32F405 has less memory, at other addresses, and another UART.
stm32f405() {
  local programs=$out/thumbv7em-none-eabihf/release
  step "STM32F405"
  build thumbv7em-none-eabihf f32,stm32f405 demo supervisor
  export QEMU_MACHINE=netduinoplus2
  ./qemu-run.sh "$programs/demo" | diff "$scratch/host" - || fail "the table differs on an STM32F405"
  SERIAL=stdio link serial f32 ./qemu-run.sh "$programs/supervisor"
  unset QEMU_MACHINE
}

# Fixed point with the overflow checks that the size figures are without.
overflow() {
  local target=$1 format=$2
  step "$target, $format: no overflow"
  ./cross.sh "$target" build --locked --release --quiet --features "$format,who-panics" --bin demo \
    --config 'profile.release.package.pcr-fixed.overflow-checks=true'
  ./qemu-run.sh "$out/$target/release/demo" | diff "$scratch/host" - || fail "an overflow, or another table"
}

# section ELF NAME...: bytes of sections.
section() {
  local elf=$1
  shift
  readelf -SW "$elf" | sed 's/^ *\[ *[0-9]*\] *//' |
    awk -v names=" $* " 'index(names, " " $1 " ") { print $5 }' | python3 -c 'import sys; print(sum(int(x, 16) for x in sys.stdin))'
}

symbol() { readelf -sW "$1" | awk -v name="$2" '$8 == name { print $2; exit }'; }

# Bytes of the stack that a run has used, start-up included.
measured_stack() {
  local elf=$1
  local lo hi
  lo=$(symbol "$elf" __sheap) hi=$(symbol "$elf" _stack_start)
  PLUGIN="$scratch/mcount.so,lo=0x$lo,hi=0x$hi" PLUGIN_LOG="$scratch/plugin" ./qemu-run.sh "$elf"
  sed -n 's/.*stack_used \([0-9]*\).*/\1/p;q' "$scratch/plugin"
}

# The table of 12 rectangles: the same bits as on the host, and what it takes.
rectangles() {
  local target=$1 format=$2 program=$out/$1/release/rectangles
  build "$target" "$format,outlines" rectangles
  ICOUNT=7 ./qemu-run.sh "$program" >"$scratch/rectangles"
  link rectangles "$format" >"$scratch/rectangles-host"
  grep -v "  table of" "$scratch/rectangles" | diff "$scratch/rectangles-host" - >&2 || fail "the table of rectangles differs from the host's"
  printf '%9d  bytes of code of the library with outlines\n' "$(tools/codesize.py "$program")"
  printf '%9d  bytes of stack of a row of rectangles, bound\n' "$(tools/fwcheck.py "$program" --root rectangles::insert 2>/dev/null)"
  sed -n 's/^\( *[0-9]*  \)table of/\1instructions: table of/p' "$scratch/rectangles"
}

# Where single calls are measured: their stacks, and what they take at worst.
measured() { [[ "$1:$2" = thumbv7em-none-eabihf:f32 || "$1:$2" = thumbv6m-none-eabi:q16 ]]; }

# The figures of a build, a line each: number, what.
figures() {
  local target=$1 format=$2 programs=$out/$1/release
  local code=".vector_table .text .rodata .text.dummy"
  printf '%9d  bytes of code and constants of the pipeline\n' \
    $(($(section "$programs/pipeline" $code .data) - $(section "$programs/nothing" $code .data)))
  printf '%9d  bytes of code of the library in it\n' "$(tools/codesize.py "$programs/pipeline")"
  printf '%9d  bytes of the table in RAM\n' "$(object "$programs/pipeline" TABLE)"
  printf '%9d  bytes of the motions in RAM\n' "$(($(object "$programs/pipeline" STORE) + $(object "$programs/pipeline" FLEET)))"
  printf '%9d  bytes of flash of the whole supervisor\n' "$(section "$programs/supervisor" $code .data)"
  case $target in
    thumb*) printf '%9d  bytes of stack of the pipeline, bound\n' "$(tools/fwcheck.py "$programs/pipeline" --root pipeline::job 2>/dev/null)" ;;
  esac
  printf '%9d  bytes of stack of the pipeline, measured\n' "$(measured_stack "$programs/pipeline")"
  printf '%9d  bytes of RAM of the supervisor, its stack not included\n' "$(section "$programs/supervisor" .data .bss .uninit)"
  case $target in
    thumb*) printf '%9d  bytes of stack of the supervisor, bound\n' "$(tools/fwcheck.py "$programs/supervisor" --root supervisor::__cortex_m_rt_main 2>/dev/null)" ;;
  esac
  printf '%9d  bytes of code of a robot that keeps orders, the library not included\n' \
    "$(tools/codesize.py "$programs/robot" 'supervisor/src/(robot|agent)\.rs')"
  printf '%9d  bytes of flash of a robot with its line\n' "$(section "$programs/robot" $code .data)"
  printf '%9d  bytes of RAM of a robot among 30, its stack not included\n' "$(section "$programs/robot" .data .bss .uninit)"
  case $target in
    thumb*)
      printf '%9d  bytes of stack of a robot, bound\n' "$(tools/fwcheck.py "$programs/robot" --root robot::__cortex_m_rt_main 2>/dev/null)"
      printf '%9d  bytes of stack of a hold, bound\n' "$(tools/fwcheck.py "$programs/robot" --root robot::hold 2>/dev/null)"
      ;;
  esac
  if measured "$target" "$format"; then
    build "$target" "$format" stacks queries
    ./qemu-run.sh "$programs/stacks"
  fi
  # What the robot has told, while it was run above.
  sed 's/^\( *[0-9]*  \)/\1instructions: /' "$scratch/robot"
  ICOUNT=7 ./qemu-run.sh "$programs/measure" | sed 's/^\( *[0-9]*  \)/\1instructions: /'
  ICOUNT=7 ./qemu-run.sh "$programs/worst"
  if measured "$target" "$format"; then ICOUNT=7 ./qemu-run.sh "$programs/queries"; fi
  if [ "$target:$format" = thumbv7em-none-eabihf:f32 ]; then rectangles "$target" "$format"; fi
}

# object ELF NAME: bytes of a static.
object() { readelf -sW "$1" | awk -v name="$2" '$4 == "OBJECT" && $8 ~ name "17h" { print $3; exit }'; }

# limit FILE WHAT MOST
limit() {
  local value
  value=$(sed -n "s/^ *\([0-9]*\)  $2\$/\1/p" "$1")
  [ -n "$value" ] || fail "no figure: $2"
  [ "$value" -le "$3" ] || fail "$2: $value, more than the budget of $3"
}

# Most instructions for each pair of segments, and for each unit of a query: docs/maintain/firmware.md, worst case.
worst_case() {
  case $1:$2 in
    thumb*:f32) echo 95000 1250 ;;
    thumb*:micro) echo 120000 ;;
    thumbv7m*:q16) echo 210000 ;;
    thumbv6m*:q16) echo 650000 16000 ;;
    riscv32imc*:q16) echo 280000 ;;
    *) fail "no worst case for $1, $2" ;;
  esac
}

# within_worst_case FILE TARGET FORMAT
within_worst_case() {
  local file=$1 pair unit paths call
  read -r pair unit <<<"$(worst_case "$2" "$3")"
  # With many pieces of one pair, too: their number must not count more than once.
  local many=(10 24)
  case $2 in thumbv6m*) many=(5 10) ;; esac
  for paths in "two paths of "{1,2,4,8}", the longest found" "two paths of ${many[0]} that meet everywhere" \
    "two paths of ${many[1]} that meet everywhere" "table of all agents"; do
    limit "$file" "instructions a pair of segments: $paths" "$pair"
  done
  if ! measured "$2" "$3"; then return; fi
  for call in Encounter::contacts first_conflict RegionRef::forbidden_delays earliest_start earliest_departure \
    PrecedenceTable::{hold,check,admit}; do
    limit "$file" "instructions a unit of $call, the longest found" "$unit"
  done
  limit "$file" "instructions a unit of two that keep their distance" "$unit"
}

# climb SECONDS TARGET FORMAT
climb() {
  local target=$2 format=$3 program
  step "$target, $format: worst cases, for $1 s"
  PCR_WORST_ROUNDS=4000000000 build "$target" "$format" worst queries
  for program in worst queries; do
    # It has no end.
    QEMU_TIMEOUT=$(($1 / 2)) ICOUNT=7 ./qemu-run.sh "$out/$target/release/$program" >"$scratch/rounds" || [ $? -eq 124 ] || fail "$program"
    awk '{ report = report $0 "\n" } /has no room for$/ { last = report; report = ""; rounds++ }
      END { print "# " rounds " rounds"; printf "%s", last }' "$scratch/rounds"
  done | tee "$scratch/climb"
  within_worst_case "$scratch/climb" "$target" "$format"
}

budgets() {
  local file=$1 target=$2 format=$3 programs=$out/$2/release stack=2048
  limit "$file" "bytes of the table in RAM" 6144
  # What is empty is all zeros, and takes no flash for its initial value.
  local program
  for program in pipeline supervisor robot; do
    [ "$(section "$programs/$program" .data)" -eq 0 ] || fail "statics of the $program have initial values in flash"
  done
  limit "$file" "bytes of stack of the pipeline, measured" "$stack"
  case $target in
    thumb*)
      limit "$file" "bytes of stack of the pipeline, bound" "$stack"
      tools/fwcheck.py "$programs/pipeline" --root pipeline::job --max-stack "$stack" --no-alloc --no-panic >/dev/null 2>"$scratch/fwcheck" ||
        fail "$(cat "$scratch/fwcheck")"
      ;;
  esac
  # The stack of the supervisor has all RAM that is not static, and nothing tells where it is too little.
  case $target in
    thumb*)
      local room=$((0x$(symbol "$programs/supervisor" _stack_start) - 0x$(symbol "$programs/supervisor" __sheap)))
      tools/fwcheck.py "$programs/supervisor" --root supervisor::__cortex_m_rt_main --max-stack "$room" --no-alloc --no-panic \
        >/dev/null 2>"$scratch/fwcheck" || fail "$(cat "$scratch/fwcheck")"
      ;;
  esac
  case $target in
    thumb*)
      local room=$((0x$(symbol "$programs/robot" _stack_start) - 0x$(symbol "$programs/robot" __sheap)))
      tools/fwcheck.py "$programs/robot" --root robot::__cortex_m_rt_main --max-stack "$room" --no-alloc --no-panic \
        >/dev/null 2>"$scratch/fwcheck" || fail "$(cat "$scratch/fwcheck")"
      limit "$file" "bytes of stack of a hold, bound" "$stack"
      limit "$file" "bytes of code of a robot that keeps orders, the library not included" 8192
      ;;
  esac
  within_worst_case "$file" "$target" "$format"
  # Single calls, where they are measured: tables and movement authority, and searches, which need more.
  local call
  if measured "$target" "$format"; then
    for call in "the constructors" "the motions" Ecm::fill "RegionRef::time and length" RegionRef::slice_at Encounter::closest \
      PrecedenceTable::hold; do
      limit "$file" "bytes of stack of $call" "$stack"
    done
    for call in first_conflict first_overlap safe_intervals safe_lengths RegionRef::forbidden_delays earliest_start least_duration \
      PrecedenceTable::check PrecedenceTable::as_planned PrecedenceTable::replace; do
      limit "$file" "bytes of stack of $call" 3072
    done
    limit "$file" "bytes of stack of PrecedenceTable::admit" 3328
    limit "$file" "bytes of stack of earliest_departure" 4480
  fi
  case $target in
    thumb*) limit "$file" "bytes of code of the library in it" "$thumb_budget" ;;
    riscv32imc*) limit "$file" "bytes of code of the library in it" "$riscv_budget" ;;
  esac
  case $target:$format in
    thumbv7em*:f32 | thumbv8m*:f32) limit "$file" "instructions: table of all agents" 600000 ;;
    thumb*:q*)
      tools/fwcheck.py "$programs/pipeline" --no-float || fail "floating point in a fixed-point program"
      ;;
    riscv32imc*:q*)
      # It has no instructions for floating point, only functions.
      if readelf -sW "$programs/pipeline" | grep -E ' __(add|sub|mul|div|eq|lt|gt|ge|le|ne|fix|float|extend|trunc)[a-z]*[sd]f'; then
        fail "floating point in a fixed-point program"
      fi
      ;;
  esac
}
# docs/maintain/firmware.md says what is bought with it, and what stands in the way of 16 KiB, which was the aim.
thumb_budget=22528
# 32-bit instructions where Thumb has 16-bit ones.
riscv_budget=26624

# One line of both compilers: figures depend on it.
compiler() {
  if [ -n "$(ls "$(rustc --print target-libdir --target "$1" 2>/dev/null)"/libcore-*.rlib 2>/dev/null)" ] && [ "${CROSS_FORCE:-}" != debian ]; then
    rustc -V
  else
    /usr/bin/rustc -V
  fi
}

compare() {
  local target=$1 format=$2
  local expected=expected/$target-$format.txt
  step "$target, $format: what it takes"
  { echo "# $(compiler "$target")"; figures "$target" "$format"; } >"$scratch/figures"
  cat "$scratch/figures"
  budgets "$scratch/figures" "$target" "$format"
  if [ -n "${UPDATE:-}" ]; then
    cp "$scratch/figures" "$expected"
    tools/figures.py --write
  else
    tools/compare.py "$expected" "$scratch/figures" || fail "look at the change; if it is meant, run UPDATE=1 firmware/check.sh $target:$format"
  fi
}

one() {
  local target=$1 format=$2 bins=(demo supervisor robot pipeline nothing measure worst)
  if [ "$format" = f32 ]; then bins+=(roots); fi
  step "$target, $format: build; no public function can panic, or its proof would not link"
  prove "$target" "$format"
  build "$target" "$format" "${bins[@]}"
  behaviour "$target" "$format"
  compare "$target" "$format"
  case $target:$format in
    thumbv6m-none-eabi:q16) overflow "$target" "$format" ;;
    thumbv7em-none-eabihf:f32)
      debug_stack "$target" "$format"
      handover "$target" "$format"
      cortex_m7
      stm32f405
      control "$target" "$format"
      ;;
  esac
}

# Examples for boards, or for these of them: that they compile and link, and fit into the memory of their board. Nothing here can run them.
examples() {
  local target board
  while read -r target board; do
    [ $# -eq 0 ] || [[ " $* " == *" $board "* ]] || continue
    step "example for a board: $board"
    [ "$(wc -l <examples/"$board"/src/main.rs)" -lt 120 ] || fail "the example for $board is no longer short"
    (cd examples && ../cross.sh "$target" build --locked --release --quiet -p "example-$board" </dev/null)
    # The first line of its log, and not errors only.
    readelf -sW "$out/$target/release/example-$board" | grep -q "defmt_info" || fail "$board logs nothing"
  done <<'BOARDS'
thumbv7em-none-eabihf stm32f4
thumbv7em-none-eabihf nrf52840
thumbv6m-none-eabi rp2040
riscv32imc-unknown-none-elf esp32c3
BOARDS
}

if [ "$*" = examples ]; then
  examples
  exit
fi
if [ "${1:-}" = climb ]; then
  seconds=${2:?how many seconds}
  shift 2
  for pair in "${@:-${matrix[@]}}"; do climb "$seconds" "${pair%%:*}" "${pair##*:}"; done
  exit
fi
tools
if [ "$*" = all ]; then
  matrix+=("${more[@]}")
  briefly=()
  shift
fi
if [ $# -gt 0 ]; then
  for pair in "$@"; do one "${pair%%:*}" "${pair##*:}"; done
else
  for pair in "${matrix[@]}"; do one "${pair%%:*}" "${pair##*:}"; done
  for pair in "${briefly[@]}"; do
    step "${pair%%:*}, ${pair##*:}: build; no public function can panic, or its proof would not link"
    prove "${pair%%:*}" "${pair##*:}"
    build "${pair%%:*}" "${pair##*:}" demo
    table "${pair%%:*}" "${pair##*:}"
  done
  for pair in "${proofs[@]}"; do
    step "${pair%%:*}, ${pair##*:}: no public function can panic, or its proof would not link"
    prove "${pair%%:*}" "${pair##*:}"
  done
  step "what the examples for boards share, in fixed point"
  (cd examples && ../cross.sh thumbv7em-none-eabihf check --locked --release --quiet -p example-fleet --features q16)
  # It builds the one for an STM32F4.
  step "what docs/guide/languages.md says to paste"
  ../.ci/readme.py "On your board"
fi
step "firmware: all passed"
