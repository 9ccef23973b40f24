#!/bin/sh
# A solver that reads a g2o file and writes poses: here Fathom's own, of another name. Use it as
#     fathom solve GRAPH.g2o --estimator command \
#         --set 'estimator.command=examples/command/by_files.sh {input} {output}'
set -eu
results=$(mktemp -d)
trap 'rm -r "$results"' EXIT
"${FATHOM:-fathom}" solve "$1" --estimator "${SOLVER:-ceres_pose_graph}" \
  --out "$results/run" --quiet > "$results/log"
cp "$results/run/trajectory.tum" "$2"
