#!/usr/bin/env bash
# Fuzzes what reads other people's files, with clang's libFuzzer under the address and the
# undefined-behaviour sanitizer (docs/reliability.md), and prints a table of what was run.
#
#     scripts/fuzz.sh                                 # every fuzzer for a minute
#     scripts/fuzz.sh pose_graph words --seconds 600
#     scripts/fuzz.sh --runs 1000000
#
# What the fuzzers have found to be worth keeping stays in build/fuzz/corpus, and is where the next
# call goes on; an input that is a finding lies in build/fuzz/findings. A fuzzer ends with its first
# finding, and this script then with status 1.
set -euo pipefail
cd "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/.."

fail() {
  printf 'fuzz: error: %s\n' "$1" >&2
  exit 1
}

limit=-max_total_time=60
asked=()
while [[ $# -gt 0 ]]; do
  case "$1" in
    --seconds) limit=-max_total_time=${2:?how many seconds?} && shift ;;
    --runs) limit=-runs=${2:?how many runs?} && shift ;;
    -*) fail "unknown flag '$1'; there are --seconds and --runs" ;;
    *) asked+=("$1") ;;
  esac
  shift
done
[[ $limit =~ =[1-9][0-9]*$ ]] || fail "'${limit#*=}' is no number of seconds or runs"

build=build/fuzz
compiler=${CXX:-clang++}
[[ $compiler == *clang* ]] || compiler=clang++
mkdir -p $build
# With assertions. -O2 takes no longer to build than -O1, and less for each execution.
cmake -G Ninja -S . -B $build -DCMAKE_CXX_COMPILER="$compiler" -DCMAKE_BUILD_TYPE=RelWithDebInfo \
  -DCMAKE_CXX_FLAGS_RELWITHDEBINFO='-O2 -gline-tables-only' \
  -DCMAKE_UNITY_BUILD=ON -DCMAKE_UNITY_BUILD_BATCH_SIZE=12 \
  -DFATHOM_FUZZ=ON -DFATHOM_TESTS=OFF -DFATHOM_BENCHMARKS=OFF > $build/configure.log 2>&1 ||
  { cat $build/configure.log >&2 && fail "CMake could not configure $build (above)"; }

mapfile -t known < $build/fuzz_targets.txt
targets=("${asked[@]}")
if [[ ${#targets[@]} -eq 0 ]]; then targets=("${known[@]}"); fi
for target in "${targets[@]}"; do
  [[ " ${known[*]} " == *" $target "* ]] || fail "no fuzzer '$target'; there are: ${known[*]}"
done
cmake --build $build --target "${targets[@]/#/fuzz_}"

# One line of what libFuzzer says at its end.
stat_of() {
  sed -n "s/^stat::$1: *//p" "$2" | tail -1
}

# Where memory was allocated is not told, which costs less; a finding that is run alone tells it.
export ASAN_OPTIONS=malloc_context_size=0:quarantine_size_mb=4
status=0
printf '%-20s %12s %10s %12s %9s\n' target executions seconds 'a second' findings
for target in "${targets[@]}"; do
  corpus=$build/corpus/$target
  findings=$build/findings/$target
  log=$build/$target.log
  mkdir -p "$corpus" "$findings"
  inputs=("$corpus" tests/fuzz/seeds/"$target")
  if [[ -d tests/fuzz/findings/$target ]]; then inputs+=(tests/fuzz/findings/"$target"); fi
  options=("$limit" -max_len=4096 -timeout=20 -rss_limit_mb=4096 -detect_leaks=0)
  # Inputs that take long are changed less often, which makes several times as many executions.
  options+=(-entropic=1 -entropic_scale_per_exec_time=1)
  # Of what is rare there is a list, searched for all that an execution reaches: it is kept short.
  options+=(-entropic_feature_frequency_threshold=10)
  options+=(-print_final_stats=1 -artifact_prefix="$findings"/)
  if [[ -f tests/fuzz/$target.dict ]]; then options+=(-dict=tests/fuzz/"$target".dict); fi
  SECONDS=0
  nice "$build/fuzz_$target" "${options[@]}" "${inputs[@]}" > "$log" 2>&1 || status=1
  count=$(find "$findings" -type f | wc -l)
  printf '%-20s %12s %10s %12s %9s\n' "$target" "$(stat_of number_of_executed_units "$log")" \
    "$SECONDS" "$(stat_of average_exec_per_sec "$log")" "$count"
done
exit "$status"
