#!/usr/bin/env python3
"""Pose graphs with absolute measurements and with holes, made from plain ones, and a least-squares
solver of its own for them (NumPy and SciPy; nothing of Fathom is in it).

  absolute_graphs make KIND GRAPH TRUTH.tum OUT.g2o [--seed N]
      KIND pose: EDGE_PRIOR_SE2 of every 10th pose, full information, in a world that is turned and
      shifted; fix: EDGE_PRIOR_SE2_XY of every 20th, likewise; compass: headings of all, FIX;
      semi: information of rank 1 and 2 in any direction of every 7th; mixed: headings of all and
      fixes of every 20th. All but compass are without FIX.
  absolute_graphs holes COUNT GRAPH OUT.g2o [--seed N]
      takes odometry edges out, no two neighbours, so that the graph stays connected.
  absolute_graphs solve GRAPH START.tum
      prints F at the minimum below a start.
"""

import argparse
import sys

import numpy as np

from graph import Graph, compose, read_tum, wrap
from least_squares import Problem

WORLD = (120.0, -45.0, 0.8)


def numbers(values):
    return " ".join(repr(float(value)) for value in values)


def plain_lines(path, without=()):
    """Vertices and edges of a file as they stand, without FIX."""
    with open(path, encoding="utf-8") as file:
        for index, line in enumerate(file):
            words = line.split()
            is_plain = words and not words[0].startswith("#") and words[0] != "FIX"
            if is_plain and index not in without:
                yield line.rstrip("\n") + "\n"


def random_information(random, rank, sigma):
    """Of a random basis, `sigma` by axis; the axes beyond the rank are not measured."""
    basis = np.linalg.qr(random.normal(size=(len(sigma), len(sigma))))[0]
    L = np.diag(1.0 / np.asarray(sigma)) @ basis[:, :rank]
    return L @ L.T


def prior(name, pose, information):
    triangle = information[np.triu_indices(3)]
    return f"EDGE_PRIOR_SE2 {name} {numbers(pose)} {numbers(triangle)}\n"


def fix(random, name, pose, sigma=0.3):
    information = random_information(random, 2, [sigma, 2.0 * sigma])
    noise = np.linalg.inv(np.linalg.cholesky(information)).T @ random.normal(size=2)
    at = np.array(pose[:2]) + noise
    return f"EDGE_PRIOR_SE2_XY {name} {numbers(at)} {numbers(information[np.triu_indices(2)])}\n"


def heading(random, name, pose, sigma=0.02):
    information = np.zeros((3, 3))
    information[2, 2] = sigma ** -2
    return prior(name, (0.0, 0.0, float(wrap(pose[2] + sigma * random.normal()))), information)


def measured(random, name, pose, rank, sigma=(0.2, 0.3, 0.05)):
    information = random_information(random, rank, sigma)
    noise = np.asarray(sigma) * random.normal(size=3)
    return prior(name, compose(pose, noise), information)


def make(kind, graph, truth, out, seed):
    random = np.random.default_rng(seed)
    poses = read_tum(truth)
    names = Graph(graph).ids()
    world = (0.0, 0.0, 0.0) if kind == "compass" else WORLD
    with open(out, "w", encoding="utf-8") as file:
        file.writelines(plain_lines(graph))
        if kind == "compass":
            file.write(f"FIX {names[0]}\n")
        for k, name in enumerate(names):
            pose = compose(world, poses[name])
            if kind == "pose" and k % 10 == 0:
                file.write(measured(random, name, pose, 3))
            if kind in ("fix", "mixed") and k % 20 == 0:
                file.write(fix(random, name, pose))
            if kind in ("compass", "mixed"):
                file.write(heading(random, name, pose))
            if kind == "semi" and k % 7 == 0:
                file.write(measured(random, name, pose, 1 + (k // 7) % 2))


def is_connected(pairs, names):
    parent = {name: name for name in names}

    def root(name):
        while parent[name] != name:
            parent[name] = parent[parent[name]]
            name = parent[name]
        return name

    for a, b in pairs:
        parent[root(a)] = root(b)
    return len({root(name) for name in names}) == 1


def take_out(count, graph, out, seed):
    random = np.random.default_rng(seed)
    read = Graph(graph)
    names = read.ids()
    pairs = [edge[:2] for edge in read.edges]
    steps = list(zip(names, names[1:]))
    gone = set()
    for index in random.permutation(len(steps)):
        if len(gone) == count:
            break
        step = steps[index]
        near = {steps[i] for i in (index - 1, index + 1) if 0 <= i < len(steps)}
        tried = gone | {step}
        left = [pair for pair in pairs if tuple(sorted(pair)) not in tried]
        if not near & gone and is_connected(left, names):
            gone = tried
    if len(gone) < count:
        sys.exit(f"{graph}: loops connect it with at most {len(gone)} holes drawn")
    without = set()
    with open(graph, encoding="utf-8") as file:
        for index, line in enumerate(file):
            words = line.split()
            is_edge = words and words[0] in ("EDGE_SE2", "EDGE2")
            if is_edge and tuple(sorted(map(int, words[1:3]))) in gone:
                without.add(index)
    with open(out, "w", encoding="utf-8") as file:
        file.writelines(plain_lines(graph, without))


def solve(graph, start):
    read = Graph(graph)
    poses = read_tum(start)
    x = np.array([poses[name] for name in read.ids()])
    problem = Problem(read)
    if problem.is_fixed and read.vertices:
        origin = read.vertices[read.ids()[0]]
        turned = compose((0.0, 0.0, -x[0][2]), x[0])
        back = (-turned[0], -turned[1], -x[0][2])
        x = np.array([compose(origin, compose(back, pose)) for pose in x])
    elif not problem.is_fixed:
        x = np.array([compose(WORLD, pose) for pose in x])
    return problem.minimise(x)[0]


def main():
    layout = argparse.RawDescriptionHelpFormatter
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=layout)
    commands = parser.add_subparsers(dest="command", required=True)
    for name, arguments in (("make", ("kind", "graph", "truth", "out")),
                            ("holes", ("count", "graph", "out")), ("solve", ("graph", "start"))):
        command = commands.add_parser(name)
        for argument in arguments:
            command.add_argument(argument)
        command.add_argument("--seed", type=int, default=1)
    given = parser.parse_args()
    if given.command == "make":
        make(given.kind, given.graph, given.truth, given.out, given.seed)
    elif given.command == "holes":
        take_out(int(given.count), given.graph, given.out, given.seed)
    else:
        print(f"{solve(given.graph, given.start):.10g}")


if __name__ == "__main__":
    main()
