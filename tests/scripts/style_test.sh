#!/usr/bin/env bash
# scripts/lint.sh --style finds a spoilt source wherever it lies. Each part of it that is not
# installed as the scripts want it is skipped.
#
#     style_test.sh SOURCES
set -euo pipefail
sources=$1

has() { command -v "$1" > /dev/null; }
for program in git autopep8 clang-format; do
  has "$program" || {
    printf "skipped: %s is not installed; 'scripts/setup.sh lint' installs it\n" "$program"
    exit 0
  }
done
/usr/bin/python3 -m flake8 --version > /dev/null 2>&1 || {
  printf "skipped: flake8 is not installed; 'scripts/setup.sh lint' installs it\n"
  exit 0
}
clang-format --version | grep -q 'version 14\.' || {
  printf 'skipped: does not apply: the format is that of clang-format 14\n'
  exit 0
}

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
mkdir -p "$folder/programs" "$folder/tree"
# What the script installs is there, or the test would not have come this far.
printf '#!/bin/sh\nshift 2\nfor name in "$@"; do echo "installed $name"; done\n' \
  > "$folder/programs/dpkg-query"
chmod +x "$folder/programs/dpkg-query"
PATH=$folder/programs:$PATH
cd "$folder/tree"
cp -r "$sources"/{scripts,.clang-format} .
git init --quiet

# spoil FILE TEXT: the style of FILE with TEXT in it is at fault, and the message names it.
spoil() {
  mkdir -p "$(dirname "$1")"
  printf '%b' "$2" > "$1"
  git add "$1"
  if scripts/lint.sh --style > said 2>&1 || ! grep -q "$1" said; then
    printf 'failed: not found in %s:\n%b\n' "$1" "$2"
    cat said
    exit 1
  fi
  git rm --quiet --force "$1"
}

printf 'int one();\n' > clean.cpp
printf '"""One."""\n\nONE = 1\n' > clean.py
git add clean.cpp clean.py
scripts/lint.sh --style > said 2>&1 || { cat said && printf 'failed: the clean tree\n' && exit 1; }
spoil python/src/module.cpp 'int  two( ) { return 2; }\n'
spoil adapters/gtsam/gtsam.hpp 'int  two( ) { return 2; }\n'
spoil src/core/two.cpp 'int  two( ) { return 2; }\n'
spoil python/fathom/module.py 'TWO=2\n'
spoil examples/python/unused.py '"""Two."""\n\nimport os\n'
