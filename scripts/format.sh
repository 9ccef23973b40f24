#!/usr/bin/env bash
# Formats all sources, C++ by clang-format and Python by autopep8; with --check it changes nothing and
# fails where it would.
set -euo pipefail
cd "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/.."

case "${1:-}" in
  '') mode=(-i) ;;
  --check) mode=(--dry-run -Werror) ;;
  *)
    printf "format: error: unknown argument '%s'; use none, or --check\n" "$1" >&2
    exit 2
    ;;
esac
# Another version breaks some lines elsewhere: the format is that of Debian 12's.
if ! clang-format --version | grep -q 'version 14\.'; then
  printf 'format: skipped: this is %s, and the format is that of clang-format 14\n' \
    "$(clang-format --version)"
else
  git ls-files -z '*.cpp' '*.hpp' | xargs -0 clang-format "${mode[@]}"
fi
# Longer lines are for who writes them: flake8 finds them.
python=(autopep8 --max-line-length 100 --ignore E203,E501,W503,W504)
if [[ ${1:-} == --check ]]; then
  changes=$(git ls-files -z '*.py' | xargs -0 "${python[@]}" --diff)
  [[ -z $changes ]] || { printf '%s\n' "$changes" >&2 && exit 1; }
else
  git ls-files -z '*.py' | xargs -0 "${python[@]}" --in-place
fi
