"""Tests of scripts/reproduce/positions.py: scripts/reproduce.sh --test"""

import cmath
import sys
import unittest
from pathlib import Path

TOP = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(TOP / "scripts/reproduce"))

from positions import between_fixes, scale_and_error  # noqa: E402


class Positions(unittest.TestCase):
    def test_a_similarity_is_found_again(self):
        estimate = {"0": 0j, "1": 2 + 0j, "2": 2 + 1j, "3": 5 - 1j}
        turn = 0.9 * cmath.exp(0.7j)
        reference = {t: turn * place + (3 - 4j) for t, place in estimate.items()}
        scale, left = scale_and_error(estimate, reference)
        self.assertAlmostEqual(scale, 0.9)
        self.assertAlmostEqual(left, 0.0)

    def test_what_is_left_is_the_mean_distance(self):
        # Four corners, each off by 1 outwards or inwards: no similarity takes that off.
        estimate = {"0": 4 + 0j, "1": 4j, "2": -4 + 0j, "3": -4j}
        reference = {"0": 5 + 0j, "1": 3j, "2": -5 + 0j, "3": -3j, "9": 100j}
        scale, left = scale_and_error(estimate, reference)
        self.assertAlmostEqual(scale, 1.0)
        self.assertAlmostEqual(left, 1.0)

    def test_a_straight_line_between_the_fixes_around_a_place(self):
        given = {"0": 0j, "10": 10 + 0j, "20": 10 + 10j}
        held_out = {"4": 4 + 3j, "15": 10 + 5j, "25": 99j}
        self.assertEqual(between_fixes(given, held_out), [0.0, 3.0])


if __name__ == "__main__":
    unittest.main()
