#!/usr/bin/env bash
# Submits a study to SLURM: registrations, shards and the merge, each after the one before. Prints
# the number of the last job; when that is done, OUT holds the study as one run would have made it.
# docs/cluster.md.
#
#     scripts/cluster/submit.sh STUDY --shards N --out DIR [--fathom PROGRAM]
#         [--arguments 'FLAGS OF compare'] [-- OPTIONS OF sbatch]
#
#     scripts/cluster/submit.sh configs/studies/regimes.yaml --shards 64 --out /shared/regimes \
#       -- --partition=short --time=30 --mem=512M
#
# DIR is on a file system that all nodes have; what is there of the same study is gone on with.
# A study over graphs has no pictures to register: --no-registrations leaves that out.
set -euo pipefail
here=$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")

fail() {
  printf 'submit: error: %s\n' "$1" >&2
  exit 2
}

study=
shards=
out=
program=fathom
arguments=()
registers=yes
while [[ $# -gt 0 && $1 != -- ]]; do
  case $1 in
    --shards | --out | --fathom | --arguments)
      [[ $# -gt 1 ]] || fail "$1 takes a value"
      case $1 in
        --shards) shards=$2 ;;
        --out) out=$2 ;;
        --fathom) program=$2 ;;
        --arguments) read -r -a arguments <<< "$2" ;;
      esac
      shift
      ;;
    --no-registrations) registers=no ;;
    -h | --help)
      sed -n '2,/^set /{/^set /d;s/^# \{0,1\}//;p}' "${BASH_SOURCE[0]}"
      exit 0
      ;;
    -*) fail "unknown flag $1 (--help lists them)" ;;
    *)
      [[ -z $study ]] || fail "one study at a time; got $study and $1"
      study=$1
      ;;
  esac
  shift
done
[[ ${1:-} != -- ]] || shift
options=("$@")

[[ -n $study && -n $out ]] || fail "a study and --out DIR are needed (--help has an example)"
[[ -f $study ]] || fail "$study: no such file"
[[ $shards =~ ^[1-9][0-9]*$ ]] || fail "--shards: expected a whole number from 1 on, got '$shards'"
command -v sbatch > /dev/null || fail "sbatch is not installed here"
[[ $program == */* ]] || program=$(command -v "$program") || fail "$program is not installed; --fathom names it"
[[ -x $program ]] || fail "$program: cannot be run"
mkdir -p "$out/shards" "$out/registrations" "$out/logs"

export FATHOM_STUDY FATHOM_OUT FATHOM FATHOM_ARGUMENTS FATHOM_STEP
export FATHOM_SHARDS=$shards FATHOM_REGISTERS=$registers
FATHOM_STUDY=$(readlink -f "$study")
FATHOM_OUT=$(readlink -f "$out")
FATHOM=$(readlink -f "$program")
FATHOM_ARGUMENTS=$(printf '%s\n' "${arguments[@]}")
# The study's own paths are relative to where it is submitted.
submit() {
  FATHOM_STEP=$1
  shift
  sbatch --parsable --export=ALL --chdir="$PWD" --output="$FATHOM_OUT/logs/$FATHOM_STEP-%a.log" \
    "$@" "${options[@]}" "$here/fathom.sbatch" | cut -d';' -f1
}

last=
after=()
if [[ $registers == yes ]]; then
  last=$(submit register --array="1-$shards")
  last=$(submit caches --dependency="afterok:$last" --kill-on-invalid-dep=yes)
  after=(--dependency="afterok:$last" --kill-on-invalid-dep=yes)
fi
last=$(submit shards --array="1-$shards" "${after[@]}")
last=$(submit merge --dependency="afterok:$last" --kill-on-invalid-dep=yes)
printf '%s\n' "$last"
