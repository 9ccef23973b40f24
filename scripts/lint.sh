#!/usr/bin/env bash
# Style and static analysis: clang-format and clang-tidy (.clang-format, .clang-tidy), on compile
# commands of clang in build/lint. Takes minutes.
#
#     scripts/lint.sh                      # all of src, estimators and apps
#     scripts/lint.sh src/vision/*.cpp     # some files
set -euo pipefail
cd "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/.."

scripts/setup.sh lint
scripts/format.sh --check
cmake -G Ninja -S . -B build/lint -DCMAKE_CXX_COMPILER=clang++ \
  -DFATHOM_TESTS=OFF -DFATHOM_BENCHMARKS=OFF -DFATHOM_PRECOMPILED_HEADERS=OFF > /dev/null

sources=("$@")
[[ ${#sources[@]} -gt 0 ]] || mapfile -t sources < <(find src estimators apps -name '*.cpp' | sort)
# One file at a time and $(nproc) at once; xargs fails where one of them does.
printf '%s\0' "${sources[@]}" |
  xargs -0 -n 1 -P "$(nproc)" clang-tidy -p build/lint --quiet
printf 'lint: %d files are clean\n' "${#sources[@]}"
