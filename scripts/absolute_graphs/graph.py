"""Pose graphs on the plane as files have them, and poses."""

import math

import numpy as np


def wrap(angle):
    return np.mod(np.asarray(angle) + np.pi, 2.0 * np.pi) - np.pi


def compose(a, b):
    c, s = math.cos(a[2]), math.sin(a[2])
    return (a[0] + c * b[0] - s * b[1], a[1] + s * b[0] + c * b[1], float(wrap(a[2] + b[2])))


def upper(values, size):
    matrix = np.zeros((size, size))
    matrix[np.triu_indices(size)] = values
    return matrix + np.triu(matrix, 1).T


class Graph:
    """The lines of a g2o or TORO file."""

    def __init__(self, path):
        self.vertices, self.edges, self.priors, self.fixed = {}, [], [], False
        with open(path, encoding="utf-8") as file:
            for line in file:
                self.read(line.split("#")[0].split())

    def read(self, words):
        if not words:
            return
        tag, numbers = words[0], [float(word) for word in words[1:]]
        if tag in ("VERTEX_SE2", "VERTEX2"):
            self.vertices[int(words[1])] = tuple(numbers[1:4])
        elif tag in ("EDGE_SE2", "EDGE2"):
            n = numbers[5:11]
            if tag == "EDGE2":  # xx xy yy tt xt yt
                n = [n[0], n[1], n[4], n[2], n[5], n[3]]
            self.edges.append((int(words[1]), int(words[2]), numbers[2:5], upper(n, 3)))
        elif tag == "EDGE_PRIOR_SE2":
            self.priors.append((int(words[1]), numbers[1:4], upper(numbers[4:10], 3)))
        elif tag == "EDGE_PRIOR_SE2_XY":
            information = np.zeros((3, 3))
            information[:2, :2] = upper(numbers[3:6], 2)
            self.priors.append((int(words[1]), numbers[1:3] + [0.0], information))
        elif tag == "FIX":
            self.fixed = True

    def ids(self):
        ends = {i for edge in self.edges for i in edge[:2]}
        return sorted(ends | set(self.vertices))


def read_tum(path):
    poses = {}
    with open(path, encoding="utf-8") as file:
        for line in file:
            words = line.split("#")[0].split()
            if words:
                t, x, y, _, _, _, qz, qw = (float(word) for word in words)
                poses[round(t)] = (x, y, 2.0 * math.atan2(qz, qw))
    return poses
