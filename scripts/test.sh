#!/usr/bin/env bash
# Installs what is missing, builds everything with warnings as errors, and runs every test.
#
#     scripts/test.sh                        # preset release
#     scripts/test.sh asan                   # or debug, tsan
#     scripts/test.sh release -R geometry    # further arguments go to ctest
#
# At the end it lists what was skipped, and what makes it run.
set -euo pipefail
cd "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/.."

preset=${1:-release}
scripts/build.sh --preset "$preset" import python adapters docs
status=0
# One more than there are processors: some tests wait, for a cluster, a browser or a limit of time.
ctest --preset "$preset" --parallel "$(($(nproc) + 1))" "${@:2}" || status=$?
scripts/skipped_tests.py "build/$preset/Testing/Temporary/LastTest.log"
exit "$status"
