#!/usr/bin/env bash
# Builds the site of docs/ and the reference of include/, warnings being errors.
#
#     scripts/docs.sh                      # both, into build/site; open build/site/index.html
#     scripts/docs.sh site FOLDER          # the pages alone, into FOLDER
#     scripts/docs.sh reference FOLDER     # the reference alone, into FOLDER/reference
#
# Ends with status 77 where the tool is missing; scripts/setup.sh docs installs both.
set -euo pipefail
cd "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/.."

need() {
  command -v "$1" > /dev/null && return
  printf "docs: skipped: %s is not installed; 'scripts/setup.sh docs' installs it\n" "$1"
  exit 77
}

site() {
  need mkdocs
  # No __pycache__ among the sources. What it says is of interest where it fails; --quiet would hide
  # the warning that it fails for.
  local said
  said=$(PYTHONDONTWRITEBYTECODE=1 mkdocs build --strict --config-file docs/site/mkdocs.yml \
    --site-dir "$1" 2>&1) || { printf '%s\n' "$said" >&2 && return 1; }
}

reference() {
  need doxygen
  mkdir -p "$1"
  local version
  version=$(sed -n 's/^project(fathom VERSION \([0-9.]*\).*/\1/p' CMakeLists.txt)
  { cat docs/site/Doxyfile
    printf 'OUTPUT_DIRECTORY = "%s"\nHTML_OUTPUT = reference\nPROJECT_NUMBER = %s\n' "$1" "$version"; } |
    doxygen -
}

case "${1:-all}" in
  site | reference) "$1" "$(realpath -m "${2:?which folder?}")" ;;
  all)
    site "$PWD/build/site"
    reference "$PWD/build/site"
    ;;
  *)
    printf "docs: error: unknown argument '%s'; use none, site or reference\n" "$1" >&2
    exit 2
    ;;
esac
