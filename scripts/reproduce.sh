#!/usr/bin/env bash
# Makes the tables and figures of the docs from shipped configurations and writes them between their
# markers: docs/reproduce.md.
#
#     scripts/reproduce.sh                 # every page; hours
#     scripts/reproduce.sh cost.md         # one page
#     scripts/reproduce.sh --quick         # what takes seconds
#     scripts/reproduce.sh --list          # the makers, and how old their figures are
#     scripts/reproduce.sh --check         # compares the quick ones, writes nothing
#
# Builds the programs first; --no-build takes them as they are. --help has all options. --test runs
# the tests of all this. Ends with
# status 77 where python3 is missing; scripts/setup.sh installs it.
set -euo pipefail
cd "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/.."

command -v python3 > /dev/null || {
  printf "reproduce: skipped: python3 is not installed; 'scripts/setup.sh' installs it\n"
  exit 77
}

# No __pycache__ among the sources.
[[ ${1:-} != --test ]] || exec python3 -B -m unittest discover -s tests/docs -p '*_test.py'

arguments=()
build=yes
for argument in "$@"; do
  case "$argument" in
    --no-build) build=no ;;
    --list | --audit | --help | -h | --build | --build=*) build=no && arguments+=("$argument") ;;
    *) arguments+=("$argument") ;;
  esac
done
if [[ $build == yes ]]; then
  [[ -f build/release/build.ninja ]] || cmake --preset release
  cmake --build --preset release --parallel "$(nproc)" --target \
    fathom back_ends wrong_loops study_errors registration_benchmark back_ends_benchmark front_end_benchmark \
    incremental_benchmark long_survey_benchmark shared_errors_benchmark survey_benchmark \
    trajectory_iekf_benchmark
fi
exec python3 -B scripts/reproduce "${arguments[@]}"
