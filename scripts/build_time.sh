#!/usr/bin/env bash
# Processor time that a build of the program takes at two commits, in turn on this machine: user and
# system seconds of CMake and of all compilers, packages being there.
#
#     scripts/build_time.sh 1534217 HEAD     # once each
#     scripts/build_time.sh 1534217 HEAD 3   # three times each
set -euo pipefail
cd "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/.."

commits=("${1:?which commit?}" "${2:?against which?}")
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
for commit in "${commits[@]}"; do
  git clone --quiet . "$folder/$commit"
  git -C "$folder/$commit" checkout --quiet "$(git rev-parse "$commit")"
done
for ((turn = 1; turn <= ${3:-1}; ++turn)); do
  for commit in "${commits[@]}"; do
    rm -rf "$folder/$commit/build"
    (
      cd "$folder/$commit"
      TIMEFORMAT="$commit: %U s user, %S s system, %R s in all"
      time {
        cmake --preset release > build.log 2>&1
        cmake --build --preset release --parallel "$(nproc)" --target fathom >> build.log 2>&1
      }
    )
  done
done
