#!/usr/bin/env bash
# Installs what is missing, configures and builds. All that builds Fathom does it here, so that every
# build has what is installed now, whatever an earlier one had.
#
#     scripts/build.sh                    # preset release, all targets
#     scripts/build.sh import python      # with what these groups of scripts/setup.sh bring
#     scripts/build.sh --preset asan      # or debug, tsan, package
#     scripts/build.sh --target fathom    # the program alone
#     scripts/build.sh -DFATHOM_PYTHON=OFF -DCMAKE_PREFIX_PATH=/opt/gtsam   # choices for CMake
set -euo pipefail
cd "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/.."

fail() {
  printf 'build: error: %s\n' "$1" >&2
  exit 1
}

preset=release
groups=() choices=() targets=()
while [[ $# -gt 0 ]]; do
  case "$1" in
    --preset) preset=${2:?--preset of which name?} && shift ;;
    --target) targets+=(--target "${2:?--target of which name?}") && shift ;;
    -D*) choices+=("$1") ;;
    -*) fail "unknown flag '$1'; there are --preset, --target and -D" ;;
    *) groups+=("$1") ;;
  esac
  shift
done
folder=build/$preset
cache=$folder/CMakeCache.txt

scripts/setup.sh "${groups[@]}"

# A folder that was copied or moved holds paths of where it was.
if [[ -f $cache ]]; then
  source=$(sed -n 's/^CMAKE_HOME_DIRECTORY:INTERNAL=//p' "$cache")
  [[ $(realpath -m "$source") == "$(realpath .)" ]] ||
    fail "$folder was configured for $source; remove it: rm -rf $PWD/$folder"
  grep -q '^CMAKE_GENERATOR:INTERNAL=Ninja$' "$cache" ||
    fail "$folder was configured for another tool than Ninja; remove it: rm -rf $PWD/$folder"
fi

mkdir -p "$folder"
log=$folder/configure.log
if ! cmake --preset "$preset" "${choices[@]}" > "$log" 2>&1; then
  cat "$log" >&2
  fail "CMake could not configure $folder (above); if that is of another version: rm -rf $PWD/$folder"
fi
sed -n 's/^-- Features/build: features/p' "$log"

# What was asked for and installed, and is not found all the same, would be missing without a word.
while read -r name has choice group packages; do
  [[ $has == 0 && $choice == AUTO && " ${groups[*]} " == *" $group "* ]] || continue
  # shellcheck disable=SC2086
  dpkg-query --show $packages > /dev/null 2>&1 || continue  # the system does not pack it
  fail "$packages is installed, but CMake finds no $name in it; as root: apt-get install --reinstall $packages"
done < "$folder/features.txt"

# A compiler takes up to 1.5 GB here.
free_kb=$(sed -n 's/^MemAvailable: *\([0-9]*\) kB/\1/p' /proc/meminfo)
jobs=$(nproc)
if [[ $jobs -gt $((free_kb / 1500000)) ]]; then jobs=$((free_kb / 1500000)); fi
if [[ $jobs -lt 1 ]]; then jobs=1; fi
cmake --build --preset "$preset" --parallel "$jobs" "${targets[@]}"
