#!/usr/bin/env bash
# Installs what is missing, builds everything with warnings as errors, and runs every test.
#
#     scripts/test.sh                        # preset release
#     scripts/test.sh asan                   # or debug, tsan
#     scripts/test.sh release -R geometry    # further arguments go to ctest
set -euo pipefail
cd "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/.."

preset=${1:-release}
jobs=$(nproc)

scripts/setup.sh import
scripts/setup.sh python
scripts/setup.sh adapters
scripts/format.sh --check
[[ -f build/$preset/build.ninja ]] || cmake --preset "$preset"
cmake --build --preset "$preset" --parallel "$jobs"
ctest --preset "$preset" --parallel "$jobs" "${@:2}"
