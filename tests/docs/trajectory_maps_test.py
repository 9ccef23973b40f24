"""Tests of what draws the runs of a study: scripts/reproduce.sh --test"""

import sqlite3
import struct
import sys
import unittest
import xml.etree.ElementTree
from contextlib import closing
from pathlib import Path
from types import SimpleNamespace

TOP = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(TOP / "scripts/reproduce"))
sys.path.insert(0, str(TOP / "tests/docs"))

from in_a_folder import InAFolder  # noqa: E402
from stored_runs import StoredRuns  # noqa: E402
from trajectory_maps import pairs_of, svg_of, ways_of  # noqa: E402

SCHEMA = """
    CREATE TABLE axis (axis, name); CREATE TABLE axis_value (axis, place, label);
    CREATE TABLE cell (cell); CREATE TABLE cell_value (cell, axis, place);
    CREATE TABLE estimator (estimator, name);
    CREATE TABLE run (run, cell, survey, trial, estimator); CREATE TABLE series (run, name, data);
    INSERT INTO axis VALUES (0, 'separation');
    INSERT INTO axis_value VALUES (0, 0, '5'), (0, 1, '10');
    INSERT INTO cell VALUES (0), (1); INSERT INTO cell_value VALUES (0, 0, 0), (1, 0, 1);
    INSERT INTO estimator VALUES (0, 'dead_reckoning'), (1, 'trajectory_iekf');"""
LINE = {"x_m": (0, 1, 2), "y_m": (0, 0, 1)}
TRUTH = {"truth_x_m": (0, 1, 2.5), "truth_y_m": (0, 0, 1)}
# Trial 0 uses both steps and one pair beside, and one of its registrations is rejected.
FIRST = {"loop_from": (0, 1, 0, 0), "loop_to": (1, 2, 2, 1), "loop_fate": (0, 0, 0, 1)}
SECOND = {"loop_from": (0, 0), "loop_to": (1, 2), "loop_fate": (1, 0)}


class StoredStudy(InAFolder):
    def setUp(self):
        super().setUp()
        with closing(sqlite3.connect(self.top / "results.sqlite")) as store:
            store.executescript(SCHEMA)
            for run, (trial, estimator, series) in enumerate((
                    (0, 0, LINE | TRUTH), (0, 1, LINE | FIRST), (1, 1, LINE | SECOND))):
                store.execute("INSERT INTO run VALUES (?, 1, 0, ?, ?)", (run, trial, estimator))
                for name, values in series.items():
                    store.execute("INSERT INTO series VALUES (?, ?, ?)",
                                  (run, name, struct.pack(f"<{len(values)}d", *values)))
            store.commit()
        self.runs = StoredRuns(SimpleNamespace(folder=self.top), {"separation": 10})

    def test_used_registrations_are_pairs(self):
        self.assertEqual(self.runs.pairs("trajectory_iekf"), [(0, 1), (1, 2), (0, 2)])

    def test_neighbours_are_counted_over_all_runs(self):
        self.assertEqual(self.runs.trials(), [(0, 0), (0, 1)])
        self.assertEqual(self.runs.share_of_neighbours("trajectory_iekf"), 2 / 4)

    def test_a_cell_that_is_not_there_is_an_error(self):
        with self.assertRaises(LookupError):
            StoredRuns(SimpleNamespace(folder=self.top), {"separation": 7})

    def test_maps_have_every_way_and_pair(self):
        text = svg_of([ways_of(self.runs, "ways"), pairs_of(self.runs, "pairs")], 2)
        drawn = xml.etree.ElementTree.fromstring(text)
        names = [element.tag.rpartition("}")[2] for element in drawn]
        self.assertEqual(names.count("circle"), 3)
        colours = [element.get("stroke") for element in drawn if element.tag.endswith("polyline")]
        self.assertEqual(colours.count("#d55e00"), 3)
        self.assertEqual(colours.count("#0072b2"), 1)
        self.assertIn("pairs: 3 keyframes, 3 pairs", text)


if __name__ == "__main__":
    unittest.main()
