#!/usr/bin/env bash
# From a fresh Debian 12 or 13 to a comparison: installs what is missing, builds build/release/fathom,
# and compares three estimators on eight simulated surveys. Further arguments go to `fathom compare`:
#
#     scripts/quickstart.sh --seed 7 --out runs/seed_7
#
# Paths in them are relative to the top of the repository.
set -euo pipefail
cd "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/.."

out=(--out runs/quickstart)
for argument in "$@"; do
  case "$argument" in --out | --out=*) out=() ;; esac
done

scripts/build.sh --target fathom
build/release/fathom compare configs/quickstart.yaml "${out[@]}" "$@"
