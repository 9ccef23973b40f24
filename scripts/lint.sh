#!/usr/bin/env bash
# Style and static analysis of the whole tree: clang-format and clang-tidy (.clang-format,
# .clang-tidy), autopep8 and flake8.
#
#     scripts/lint.sh                       # all; clang-tidy takes twenty minutes on two cores
#     scripts/lint.sh --style               # format and flake8 alone, which take seconds
#     scripts/lint.sh --since v0.2.0        # clang-tidy of what has changed since that commit
#     scripts/lint.sh --since-release       # … since the last release
#     scripts/lint.sh --since-release 24    # … at most 24 units, of what has changed last
#     scripts/lint.sh src/vision/*.cpp      # … of some files
#
# clang-tidy, and with it the warnings of clang, reads the compile commands in build/lint.
set -euo pipefail
cd "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/.."

fail() {
  printf 'lint: error: %s\n' "$1" >&2
  exit 1
}

# The commit of the last release: its tag, or else what CITATION.cff says.
last_release() {
  git describe --tags --abbrev=0 --match 'v[0-9]*' 2> /dev/null ||
    sed -n 's/^commit: //p' CITATION.cff
}

# Sources that have changed since a commit, what has changed last first, and for each header that
# has, those that include it under its name; of many the first three.
changed_since() {
  local file
  { git diff --name-only HEAD && git log --format= --name-only "$1.."; } | awk '!seen[$0]++' |
    while read -r file; do
      [[ -f $file ]] || continue
      case "$file" in
        *.cpp) printf '%s\n' "$file" ;;
        *.hpp)
          # head ends before git grep does, or there is none.
          { git grep -l --fixed-strings "$(sed -E 's|^(include\|tests)/||' <<< "$file")\"" -- '*.cpp' ||
            true; } | { head -3; cat > /dev/null; } ;;
      esac
    done | awk '!seen[$0]++'
}

base=
most=1000000
is_style=
case "${1:-}" in
  --style) is_style=yes ;;
  --since) base=${2:?which commit?} && shift 2 ;;
  --since-release)
    base=$(last_release)
    if ! git cat-file -e "$base^{commit}" 2> /dev/null; then
      printf 'lint: this clone does not reach back to the last release; its last commit is read\n'
      base=$(git rev-parse --quiet --verify HEAD^ || git rev-parse HEAD)
    fi
    most=${2:-$most}
    shift $#
    ;;
  -*) fail "unknown flag '$1'; there are --style, --since COMMIT and --since-release" ;;
esac

scripts/setup.sh lint import python adapters
scripts/format.sh --check
git ls-files -z '*.py' |
  xargs -0 /usr/bin/python3 -m flake8 --max-line-length 100 --extend-ignore E203,W503,W504
if [[ -n $is_style ]]; then exit 0; fi

# As units of twelve sources: most of what clang-tidy reads are headers.
cmake -G Ninja -S . -B build/lint -DCMAKE_CXX_COMPILER=clang++ -DCMAKE_BUILD_TYPE=Debug \
  -DCMAKE_UNITY_BUILD=ON -DCMAKE_UNITY_BUILD_BATCH_SIZE=12 -DFATHOM_PRECOMPILED_HEADERS=OFF > /dev/null

# Units of what is compiled at all: not the examples that others build, nor what the build writes.
units_of() {
  local unit
  while read -r unit; do
    case "$unit" in
      */Unity/*) sed -n "s|^#include \"$PWD/\(.*\)\"$|$unit \1|p" "$unit" ;;
      "$PWD"/build/*) ;;
      *) printf '%s %s\n' "$unit" "${unit#"$PWD"/}" ;;
    esac
  done < <(sed -n 's|^  "file": "\(.*\)",\?$|\1|p' build/lint/compile_commands.json)
}
if [[ -n $base ]]; then
  mapfile -t chosen < <(changed_since "$base")
else
  chosen=("$@")
fi
if [[ -n $base || $# -gt 0 ]]; then
  # In the order of the files; one that is no source of the build has no unit.
  mapfile -t units < <(awk 'NR == FNR { unit[$2] = $1; next }
    $0 in unit && !seen[unit[$0]]++ { print unit[$0] }' <(units_of) <(printf '%s\n' "${chosen[@]}"))
  if [[ ${#units[@]} -gt $most ]]; then
    printf 'lint: %d of %d units, of what has changed last\n' "$most" "${#units[@]}"
    units=("${units[@]:0:most}")
  fi
else
  mapfile -t units < <(units_of | cut -d ' ' -f 1 | sort -u)
fi
# clang-tidy of units by a pattern of their paths, with less of the checks; one unit at a time and
# $(nproc) at once. A unit includes sources. xargs fails where one of them does.
tidy() {
  printf '%s\n' "${units[@]}" | { grep "$1" "$2" || true; } |
    xargs -d '\n' --no-run-if-empty -n 1 -P "$(nproc)" \
      clang-tidy -p build/lint --quiet --checks="-bugprone-suspicious-include$3" || return 1
}
# Tests and benchmarks may be plain and slow, and may do on purpose what elsewhere is a slip.
plain=,-performance-*,-bugprone-implicit-widening-of-multiplication-result
plain+=,-bugprone-misplaced-widening-cast,-bugprone-suspicious-missing-comma
plain+=,-bugprone-integer-division
plain+=,-bugprone-suspicious-memory-comparison,-clang-analyzer-security.FloatLoopCounter
if [[ ${#units[@]} -eq 0 ]]; then
  printf 'lint: no source to read\n'
  exit 0
fi
tidy -v '/\(tests\|benchmarks\)/' ''
tidy -e '/\(tests\|benchmarks\)/' "$plain"
printf 'lint: %d units of sources are clean\n' "${#units[@]}"

# What sources of a module that are compiled together take from one another.
if [[ $# -eq 0 && -z $base ]]; then
  cmake -G Ninja -S . -B build/unity -DCMAKE_UNITY_BUILD=ON -DCMAKE_UNITY_BUILD_BATCH_SIZE=0 \
    -DFATHOM_PRECOMPILED_HEADERS=OFF > /dev/null
  /usr/bin/python3 scripts/unity_leaks.py build/unity
fi
