#!/usr/bin/env bash
# Formats all C++ sources; with --check it changes nothing and fails where it would.
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
find src include estimators apps tests benchmarks -name '*.[ch]pp' -print0 |
  xargs -0 clang-format "${mode[@]}"
