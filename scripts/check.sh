#!/usr/bin/env bash
# What is too long for scripts/test.sh; docs/reliability.md has the results.
#
#     scripts/check.sh                # all stages; hours on two cores
#     scripts/check.sh asan faults    # these
#
#     asan     address and undefined behaviour, all tests
#     tsan     data races, the tests that use several threads
#     clang    a build by clang++, warnings as errors
#     tidy     clang-format, clang-tidy, flake8
#     fuzz     a minute of each fuzzer
#     faults   every call that the system may refuse, in every command that writes; 200 kills
#
# Each stage has a log in build/check, and a line in build/check/record.tsv: stage, result, what was
# counted, seconds, commit, date. Exit status 1 where one failed.
set -uo pipefail
cd "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/.." || exit 2

all=(asan tsan clang tidy fuzz faults)
folder=build/check

fail() {
  printf 'check: error: %s\n' "$1" >&2
  exit 2
}

run_stage() {
  case "$1" in
    asan) scripts/test.sh asan ;;
    # ThreadSanitizer does not see how the threads of TBB, which are those of OpenCV, wait.
    tsan) OPENCV_FOR_THREADS_NUM=1 scripts/test.sh tsan -L gtest ;;
    clang)
      scripts/setup.sh lint import python adapters &&
        cmake -S . -B build/clang -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_CXX_COMPILER=clang++ \
          -DCMAKE_UNITY_BUILD=ON -DCMAKE_UNITY_BUILD_BATCH_SIZE=24 &&
        ninja -C build/clang
      ;;
    tidy) scripts/lint.sh ;;
    fuzz) scripts/fuzz.sh --seconds 60 ;;
    faults)
      scripts/build.sh import &&
        tests/faults/matrix.py build/release/fathom build/release/tests/faults/libfathom_test_faults.so --all &&
        tests/faults/matrix.py build/release/fathom build/release/tests/faults/libfathom_test_faults.so --kills 200
      ;;
  esac
}

# Of the log of a stage, in a few words.
counted() {
  case "$1" in
    asan | tsan) sed -nE 's/^.* ([0-9]+) tests? failed out of ([0-9]+).*$/\2 tests, \1 failed/p' "$2" ;;
    clang) sed -nE 's/^\[[0-9]+\/([0-9]+)\].*$/\1 steps/p' "$2" | tail -1 ;;
    tidy) sed -nE 's/^.*[^0-9]([0-9]+ units).*$/\1/p' "$2" | tail -1 ;;
    fuzz | faults) tail -1 "$2" ;;
  esac
}

stages=("$@")
[[ ${#stages[@]} -gt 0 ]] || stages=("${all[@]}")
for stage in "${stages[@]}"; do
  [[ " ${all[*]} " == *" $stage "* ]] || fail "no stage '$stage'; there are ${all[*]}"
done

mkdir -p "$folder"
status=0
for stage in "${stages[@]}"; do
  printf 'check: %s, log in %s\n' "$stage" "$folder/$stage.log"
  commit=$(git rev-parse --short=8 HEAD)
  git diff --quiet HEAD || commit+=", changed"
  begin=$SECONDS
  result=passed
  run_stage "$stage" > "$folder/$stage.log" 2>&1 || result=failed status=1
  line=$(printf '%s\t%s\t%s\t%d\t%s\t%s' "$stage" "$result" "$(counted "$stage" "$folder/$stage.log")" \
    $((SECONDS - begin)) "$commit" "$(date +%F)")
  { grep -v "^$stage	" "$folder/record.tsv" 2> /dev/null; printf '%s\n' "$line"; } > "$folder/record.new"
  mv "$folder/record.new" "$folder/record.tsv"
  printf 'check: %s\n' "${line//	/, }"
done
exit "$status"
