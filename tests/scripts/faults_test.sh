#!/usr/bin/env bash
# scripts/setup.sh and scripts/build.sh on systems at fault, which a few programs of a folder act:
# each ends with one line that says what to do, and nothing is installed or built.
#
#     faults_test.sh SOURCES
set -euo pipefail
sources=$1

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
mkdir -p "$folder"/{programs,tree/build/release}
cp -r "$sources/scripts" "$folder/tree"
cd "$folder/tree"

act() {
  printf '#!/bin/sh\n%s\n' "$2" > "$folder/programs/$1"
  chmod +x "$folder/programs/$1"
}

# expect STATUS PATTERN COMMAND…: and on standard error one line of ours, which has PATTERN in it.
expect() {
  local status=0
  PATH=$folder/programs:${path:-$PATH} "${@:3}" > "$folder/out" 2> "$folder/error" || status=$?
  if [[ $status -ne $1 || $(grep -c 'error: ' "$folder/error") -ne 1 ]] ||
    ! grep -q "error: .*$2" "$folder/error"; then
    printf 'failed: %s: status %s, expected %s and "%s"; it said:\n' "${*:3}" "$status" "$1" "$2"
    cat "$folder/out" "$folder/error"
    exit 1
  fi
}

# A system with all packages asks for nothing and installs nothing.
act apt-get 'echo called >> '"$folder"'/installed; exit 1'
all_installed='for word in "$@"; do
  case "$word" in -* | *Status*) ;; *) echo "installed $word" ;; esac
done'
act dpkg-query "$all_installed"
PATH=$folder/programs:$PATH scripts/setup.sh import python
[[ ! -e $folder/installed ]] || { printf 'failed: installed what was there\n' && exit 1; }

# The network is away, and then one package is not to be had.
act id 'echo 0'
act dpkg-query '[ $# -eq 3 ]'
expect 1 'is there a network' scripts/setup.sh
act apt-get 'for word in "$@"; do if [ "$word" = update ]; then exit 0; fi; done; exit 100'
expect 1 'could not install: .*cmake' scripts/setup.sh

# An installation that was cut off: nothing more is installed before it is mended.
rm -f "$folder/installed"
act apt-get 'echo called >> '"$folder"'/installed'
act dpkg-query 'echo "half-configured libceres-dev"; echo "installed cmake"'
expect 1 'installed by half: libceres-dev; as root: dpkg --configure -a' scripts/setup.sh
[[ ! -e $folder/installed ]] || { printf 'failed: installed beside what is broken\n' && exit 1; }

# Neither root nor sudo.
act id 'echo 1000'
act dpkg-query '[ $# -eq 3 ]'
mkdir "$folder/few"
for program in bash sh env sed grep sort comm cat readlink dirname; do
  ln -s "$(command -v "$program")" "$folder/few/$program"
done
path=$folder/few expect 1 'neither root nor sudo.*apt-get install' scripts/setup.sh
path=

# Another system than Debian.
rm "$folder/programs/apt-get" "$folder/programs/dpkg-query"
path=$folder/few expect 1 'no apt-get here to install with' scripts/setup.sh
path=

# A build folder of another place, or of another tool.
act dpkg-query "$all_installed"
act cmake 'echo called >> '"$folder"'/configured'
cache=build/release/CMakeCache.txt
printf 'CMAKE_HOME_DIRECTORY:INTERNAL=/elsewhere\nCMAKE_GENERATOR:INTERNAL=Ninja\n' > "$cache"
expect 1 "was configured for /elsewhere; remove it: rm -rf $PWD/build/release" scripts/build.sh
printf 'CMAKE_HOME_DIRECTORY:INTERNAL=%s\nCMAKE_GENERATOR:INTERNAL=Unix Makefiles\n' "$PWD" > "$cache"
expect 1 "another tool than Ninja; remove it: rm -rf $PWD/build/release" scripts/build.sh
[[ ! -e $folder/configured ]] || { printf 'failed: configured all the same\n' && exit 1; }

# CMake finds nothing of a feature whose packages are there.
rm "$cache"
act cmake 'mkdir -p build/release
echo "exif 0 AUTO base libexif-dev" > build/release/features.txt
echo "proj 0 AUTO import libproj-dev" >> build/release/features.txt'
expect 1 'libproj-dev is installed, but CMake finds no proj in it; .*reinstall libproj-dev' \
  scripts/build.sh import
act cmake 'echo "CMake Error: why"; exit 1'
expect 1 'CMake could not configure build/release' scripts/build.sh
grep -q 'CMake Error: why' "$folder/error"
expect 1 "unknown flag '-x'" scripts/build.sh -x
expect 1 "unknown group 'all'" scripts/setup.sh all
