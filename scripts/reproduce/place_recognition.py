"""Loops of place recognition: which a back end keeps, what a recorded reference says of them."""

import bisect
import csv
import math
from dataclasses import dataclass

# Between two poses of the reference that are further apart nothing is interpolated.
LONGEST_GAP_S = 1.0
# A loop nearer to the reference is right, one further off is false; between them it is open.
RIGHT_M, FALSE_M = 2.0, 5.0


@dataclass(frozen=True)
class Loop:
    """An edge of a graph that is not from one pose to the next."""

    first: int
    second: int
    motion: tuple  # x, y, heading of the second in the first


def _is_step(words):
    return abs(int(words[2]) - int(words[1])) == 1


def _is_edge(words):
    return bool(words) and words[0].startswith("EDGE_SE2")


def loops_of(lines):
    """The loops of a g2o file in its order, edges from a pose to itself left out."""
    found = []
    for line in lines:
        words = line.split()
        if _is_edge(words) and not _is_step(words) and words[1] != words[2]:
            found.append(Loop(int(words[1]), int(words[2]), tuple(map(float, words[3:6]))))
    return found


def only_with(lines, kept):
    """Lines of the graph with these loops (pairs of ids) alone: vertices and steps stay."""
    for line in lines:
        words = line.split()
        is_loop = _is_edge(words) and not _is_step(words)
        if not is_loop or (int(words[1]), int(words[2])) in kept:
            yield line


def kept_loops(folder):
    """Pairs of ids that a run kept: used, with more than half of their weight."""
    with open(folder / "registrations.csv", newline="", encoding="utf-8") as file:
        return {(int(row["from"]), int(row["to"])) for row in csv.DictReader(file)
                if row["fate"] == "used" and float(row["weight"]) > 0.5}


def _wrapped(angle):
    return math.atan2(math.sin(angle), math.cos(angle))


class Reference:
    """Recorded poses (time, x, y, heading), at the times of a graph's vertices."""

    def __init__(self, poses_csv, vertex_times):
        with open(poses_csv, encoding="utf-8") as file:
            self._poses = [tuple(map(float, line.split(","))) for line in file if line.strip()]
        self._times = [pose[0] for pose in self._poses]
        with open(vertex_times, encoding="utf-8") as file:
            self._vertex_times = [float(line) for line in file if line.strip()]

    def pose(self, vertex):
        """x, y, heading, or nothing in a gap of the reference."""
        time = self._vertex_times[vertex]
        after = bisect.bisect(self._times, time)
        if after in (0, len(self._times)):
            return None
        (start, *a), (end, *b) = self._poses[after - 1], self._poses[after]
        if end - start > LONGEST_GAP_S:
            return None
        share = (time - start) / (end - start)
        return (a[0] + share * (b[0] - a[0]), a[1] + share * (b[1] - a[1]),
                a[2] + share * _wrapped(b[2] - a[2]))

    def distance(self, loop):
        """How far the loop is from the reference's own motion, in metres; or nothing."""
        first, second = self.pose(loop.first), self.pose(loop.second)
        if first is None or second is None:
            return None
        dx, dy = second[0] - first[0], second[1] - first[1]
        c, s = math.cos(first[2]), math.sin(first[2])
        return math.hypot(c * dx + s * dy - loop.motion[0], c * dy - s * dx - loop.motion[1])

    def verdict(self, loop):
        """right, false, open; or unknown, where the reference has a gap."""
        distance = self.distance(loop)
        if distance is None:
            return "unknown"
        return "right" if distance <= RIGHT_M else "false" if distance > FALSE_M else "open"

    def tum(self):
        """Lines of a trajectory whose time stamps are the vertices' numbers."""
        for vertex in range(len(self._vertex_times)):
            pose = self.pose(vertex)
            if pose is not None:
                x, y, heading = pose
                yield (f"{vertex} {x!r} {y!r} 0 0 0 {math.sin(heading / 2)!r} "
                       f"{math.cos(heading / 2)!r}")
