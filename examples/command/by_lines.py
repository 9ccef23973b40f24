#!/usr/bin/env python3
"""Speaks the line protocol; a solver that is called with files does the work. Use it as
    fathom solve GRAPH.g2o --estimator command \
        --set 'estimator.command=examples/command/by_lines.py SOLVER {in} {out}'
where SOLVER reads a g2o file and writes TUM."""
import math
import os
import subprocess
import sys
import tempfile

vertices, edges, is_solved = {}, [], True


def solve(words):
    with tempfile.TemporaryDirectory() as folder:
        files = {"{in}": os.path.join(folder, "in.g2o"), "{out}": os.path.join(folder, "out")}
        with open(files["{in}"], "w") as graph:
            for k, pose in vertices.items():
                print("VERTEX_SE2", k, *pose, file=graph)
            print("FIX 0", *("EDGE_SE2 " + " ".join(edge) for edge in edges), sep="\n", file=graph)
        subprocess.run([files.get(word, word) for word in words], check=True, stdout=sys.stderr)
        written = [line for line in open(files["{out}"]) if not line.startswith("#")]
        for k, line in zip(vertices, written):
            t, x, y, z, qx, qy, qz, qw = map(float, line.split())
            vertices[k] = (x, y, 2 * math.atan2(qz, qw))


for line in sys.stdin:
    word, *rest = line.rstrip(";\n").split()
    if word == "ADD" and rest[0] == "VERTEX_XYT":
        vertices[int(rest[1])] = tuple(map(float, rest[2:]))
    elif word == "ADD":
        edges.append(rest[2:])
    elif word == "SOLVE_STATE":
        is_solved = False
    elif word == "QUERY_STATE":
        if not is_solved:
            solve(sys.argv[1:])
        is_solved = True
        asked = map(int, rest) if rest else vertices
        print("BEGIN", *(f"VERTEX_XYT {k} {'%.17g %.17g %.17g' % vertices[k]}" for k in asked),
              "END", sep="\n", flush=True)
