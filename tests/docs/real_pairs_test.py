"""Tests of scripts/reproduce/real_pairs.py: scripts/reproduce.sh --test"""

import math
import sys
import unittest
from pathlib import Path

TOP = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(TOP / "scripts/reproduce"))
sys.path.insert(0, str(TOP / "tests/docs"))

import real_pairs  # noqa: E402
from in_a_folder import InAFolder  # noqa: E402


class RealPairs(InAFolder):
    def folder(self, name, *edges):
        turned = 2 * math.asin(math.sqrt(0.5))
        self.write(f"{name}/ground_truth.tum", "# t x y z qx qy qz qw\n0 0 0 0 0 0 0 1\n"
                   f"1 2 1 0 0 0 {math.sin(turned / 2)} {math.cos(turned / 2)}\n")
        self.write(f"{name}/measurements.g2o", "VERTEX_SE2 0 0 0 0\n"
                   "EDGE_SE2 0 1 9 9 9 1 0 0 1 0 1\n" + "\n".join(edges) + "\n")
        return self.top / name

    def test_a_registration_is_not_the_step_and_its_covariance_is_told_apart(self):
        # Off by 0.1 m along the x of the world, the −y of the turned keyframe; C₀ = diag(1, 4, 9),
        # and with a tilt of 2 rad diag(5, 4, 9).
        z = f"EDGE_SE2 0 1 1.9 1 {math.pi / 2 - 0.05}"
        plain = self.folder("plain", f"{z} 1 0 0 0.25 0 {1 / 9}")
        tilted = self.folder("tilted", f"{z} 0.2 0 0 0.25 0 {1 / 9}")
        (pair,) = real_pairs.pairs_of(plain, tilted, 2.0)
        turned = math.pi / 2 - 0.05
        for found, right in zip(pair.error,
                                (0.1 * math.cos(turned), -0.1 * math.sin(turned), 0.05)):
            self.assertAlmostEqual(found, right, places=12)
        for found, right in zip(pair.tilt, (1, 0, 0, 0, 0, 0)):
            self.assertAlmostEqual(found, right, places=12)
        x, y, t = pair.error
        for found, right in ((pair.nis, x * x / 10 + y * y / 4 + t * t / 25),
                             (pair.nis_of_translation, x * x / 10 + y * y / 4),
                             (pair.nis_of_heading, t * t / 25)):
            self.assertAlmostEqual(found((3.0, 4.0)), right, places=12)

    def test_inverse_of_a_full_matrix(self):
        a, b, c, d, e, f = m = (4.0, 1.0, -0.5, 3.0, 0.7, 2.0)
        rows = ((a, b, c), (b, d, e), (c, e, f))
        p, q, r, s, t, u = real_pairs.inverse(m)
        columns = ((p, q, r), (q, s, t), (r, t, u))
        for i, row in enumerate(rows):
            for j, column in enumerate(columns):
                self.assertAlmostEqual(sum(map(lambda v, w: v * w, row, column)), float(i == j))

    @staticmethod
    def pairs(errors):
        return [real_pairs.Pair(i, k, error, (1e-12, 0, 0, 1e-12, 0, 1e-12), (4, 0, 0, 4, 0, 0))
                for (i, k), error in errors.items()]

    def test_the_fit_is_the_closed_form_where_tilt_is_round(self):
        # Mean ‖e‖² / (4 tilt²) is 2, the mean of the squared headings the floor's square.
        pairs = self.pairs({(0, 1): (0.3, 0.1, 0.02), (0, 2): (-0.1, 0.2, -0.05),
                            (1, 2): (0.2, -0.4, 0.01)})
        tilt, floor = real_pairs.fitted(pairs)
        self.assertAlmostEqual(tilt, math.sqrt((0.1 + 0.05 + 0.2) / 3 / 8), places=6)
        self.assertAlmostEqual(floor, math.sqrt((4e-4 + 25e-4 + 1e-4) / 3), places=6)

    def test_an_interval_knows_that_pairs_share_pictures(self):
        # Picture 0 is off, in all of its pairs: nine values that are one.
        errors = {(i, k): (float(i == 0), 0, 0) for i in range(10) for k in range(i + 1, 10)}
        low, high = real_pairs.interval(self.pairs(errors), lambda p: p.error[0])
        self.assertEqual(low, 0)  # it is not drawn in a third of the draws
        self.assertGreater(high, 0.4)  # of independent pairs: 0.2 ± 0.12
        self.assertEqual(real_pairs.interval(self.pairs(errors), lambda p: 7.0), (7, 7))


if __name__ == "__main__":
    unittest.main()
