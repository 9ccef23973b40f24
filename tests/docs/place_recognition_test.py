"""Tests of scripts/reproduce/place_recognition.py: scripts/reproduce.sh --test"""

import sys
import unittest
from pathlib import Path

TOP = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(TOP / "scripts/reproduce"))
sys.path.insert(0, str(TOP / "tests/docs"))

import place_recognition  # noqa: E402
from in_a_folder import InAFolder  # noqa: E402

# As the files of the RRR collection: steps, then loops from the later pose to the earlier one.
GRAPH = """VERTEX_SE2 0 0 0 0
EDGE_SE2 0 1 1.0 0.0 0.0 4000 0 0 4000 0 40000
EDGE_SE2 1 2 1.0 0.0 0.0 4000 0 0 4000 0 40000
EDGE_SE2 2 3 1.0 0.0 0.0 4000 0 0 4000 0 40000
EDGE_SE2 1 1 0.0 0.0 0.0 1.898179e+002 0 0 1.898179e+002 0 1.898179e+003
EDGE_SE2 3 0 -3.0 0.0 0.0 1.898179e+002 0 0 1.898179e+002 0 1.898179e+003
EDGE_SE2 2 0 1.0 9.0 0.0 1.898179e+002 0 0 1.898179e+002 0 1.898179e+003
EDGE_SE2 3 1 -2.0 4.0 0.0 1.898179e+002 0 0 1.898179e+002 0 1.898179e+003""".split("\n")


class PlaceRecognition(InAFolder):
    def reference(self, poses, times):
        self.write("poses.csv", poses)
        self.write("times.txt", times)
        return place_recognition.Reference(self.top / "poses.csv", self.top / "times.txt")

    def test_loops_are_neither_steps_nor_edges_to_oneself(self):
        found = [(loop.first, loop.second) for loop in place_recognition.loops_of(GRAPH)]
        self.assertEqual(found, [(3, 0), (2, 0), (3, 1)])

    def test_a_graph_with_some_loops_keeps_its_steps(self):
        lines = list(place_recognition.only_with(GRAPH, {(3, 0)}))
        self.assertEqual(lines, [*GRAPH[:4], GRAPH[5]])

    def test_kept_are_used_with_more_than_half_of_their_weight(self):
        self.write("registrations.csv", "from,to,fate,nis,weight\n3,0,used,,0.51\n2,0,used,,0.5\n"
                   "3,1,rejected,9,1\n")
        self.assertEqual(place_recognition.kept_loops(self.top), {(3, 0)})

    def test_verdicts_by_an_interpolated_reference_of_a_turned_world(self):
        # Along y, heading along y: x of a body is the world's y.
        half = 1.5707963267948966
        poses = "\n".join(f"{time}, 0, {time * 2 - 1}, {half}"
                          for time in (0.5, 1.0, 1.5, 2.0, 2.5))
        reference = self.reference(poses, "0.5\n1.0\n1.25\n2.0\n")
        x, y, heading = reference.pose(2)
        self.assertAlmostEqual(y, 1.5)
        self.assertAlmostEqual(heading, half)
        loops = place_recognition.loops_of(GRAPH)
        self.assertAlmostEqual(reference.distance(loops[0]), 0.0)
        self.assertEqual([reference.verdict(loop) for loop in loops], ["right", "false", "open"])

    def test_nothing_is_said_in_a_gap_or_outside(self):
        reference = self.reference("0, 0, 0, 0\n1, 1, 0, 0\n3, 3, 0, 0\n", "0.5\n2.0\n-1\n0.2\n")
        self.assertIsNone(reference.pose(1))
        self.assertIsNone(reference.pose(2))
        loops = place_recognition.loops_of(GRAPH)
        self.assertEqual([reference.verdict(loop) for loop in loops],
                         ["open", "unknown", "unknown"])
        self.assertEqual([line.split()[0] for line in reference.tum()], ["0", "3"])


if __name__ == "__main__":
    unittest.main()
