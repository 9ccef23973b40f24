"""Registration of two pictures, evaluation, statistics, against closed forms."""

import math
import os
import tempfile
import unittest

import fathom
import numpy

CAMERA = {"width": 320, "height": 240, "fx": 250.0, "fy": 250.0}


def floor(seed=3, size=900):
    """A grey floor of soft blobs of several sizes."""
    random = numpy.random.default_rng(seed)
    total = numpy.zeros((size, size))
    for period in (4, 9, 20):
        grid = random.normal(size=(size // period + 2, size // period + 2))
        rows = numpy.arange(size) / period
        low = rows.astype(int)
        share = (rows - low)[:, None]
        along = grid[low] * (1 - share) + grid[low + 1] * share
        total += along[:, low] * (1 - share.T) + along[:, low + 1] * share.T
    total = (total - total.min()) / (total.max() - total.min())
    return (255 * total).astype(numpy.uint8)


class Registration(unittest.TestCase):
    def setUp(self):
        self.floor = floor()

    def picture(self, row, column):
        return numpy.ascontiguousarray(self.floor[row : row + 240, column : column + 320])

    def test_a_shift_in_pixels_is_one_in_metres(self):
        a, b = self.picture(300, 300), self.picture(250, 340)
        found = fathom.register(a, b, 2.0, 2.0, CAMERA)
        self.assertTrue(found, found.reason)
        # 50 rows up is forward, 40 columns to the right is to starboard; 2 m / 250 px.
        expected = numpy.array([50 * 2 / 250, -40 * 2 / 250, 0.0])
        numpy.testing.assert_allclose(found.motion, expected, atol=2e-3)
        self.assertGreater(numpy.linalg.eigvalsh(found.covariance).min(), 0)
        self.assertGreater(found.inliers, 20)

    def test_pictures_of_other_places_do_not_match(self):
        found = fathom.register(self.picture(0, 0), self.picture(600, 500), 2.0, 2.0, CAMERA)
        self.assertFalse(found)
        self.assertTrue(found.reason)
        self.assertIsNone(found.motion)
        self.assertIsNone(found.covariance)

    def test_refusals(self):
        a = self.picture(0, 0)
        colour = numpy.zeros((240, 320, 3), numpy.uint8)
        for wrong in (colour, a.astype(float), a[:100], numpy.asfortranarray(a)):
            with self.assertRaisesRegex(fathom.InputError, "b: "):
                fathom.register(a, wrong, 2.0, 2.0, CAMERA)
        with self.assertRaisesRegex(fathom.InputError, "did you mean 'width'"):
            fathom.register(a, a, 2.0, 2.0, {"widht": 3})
        with self.assertRaises(fathom.InputError):
            fathom.register(a, a, -1.0, 2.0, CAMERA)
        with self.assertRaisesRegex(fathom.InputError, "did you mean"):
            fathom.register(a, a, 2.0, 2.0, CAMERA, front_end={"ransac.iteratoins": 3})


class Evaluation(unittest.TestCase):
    def test_closed_form(self):
        reference = numpy.array([[0, 0, 0], [1, 0, 0], [2, 0, 0.0]])
        estimate = reference + [0, 0.3, 0]
        none = fathom.evaluate(estimate, reference, alignment="none")
        self.assertAlmostEqual(none["mean_position_error_m"], 0.3)
        self.assertAlmostEqual(fathom.evaluate(estimate, reference)["ate_rmse_m"], 0)
        turned = numpy.array([[0, 0, 0], [0, 1, math.pi / 2], [0, 2, math.pi / 2]])
        judged = fathom.evaluate(turned, reference, alignment="se2")
        self.assertAlmostEqual(judged["max_position_error_m"], 0)
        covariances = numpy.tile(0.09 * numpy.eye(3), (3, 1, 1))
        moved = reference + [[0, 0, 0], [0, 0.3, 0], [0, 0.3, 0]]
        judged = fathom.evaluate(moved, reference, covariances=covariances)
        self.assertAlmostEqual(judged["anees"], 1 / 3)
        aligned = fathom.evaluate(moved, reference, alignment="se2", covariances=covariances)
        self.assertLess(aligned["ate_rmse_m"], judged["ate_rmse_m"])
        self.assertEqual(aligned["anees"], judged["anees"])
        with self.assertRaises(fathom.InputError):
            fathom.evaluate(estimate, reference[:2])
        with self.assertRaisesRegex(fathom.InputError, "expected one of none, origin, se2"):
            fathom.evaluate(estimate, reference, alignment="scale")
        with self.assertRaisesRegex(fathom.InputError, "expected shape"):
            fathom.evaluate(estimate[:, :2], reference)
        covariances[1, 0, 2] = 0.01
        with self.assertRaisesRegex(fathom.InputError, r"covariances\[1\]: expected a symmetric"):
            fathom.evaluate(moved, reference, covariances=covariances)

    def test_what_cannot_be_judged_is_refused(self):
        poses = numpy.array([[0, 0, 0], [1, 0, 0], [2, 0, 0], [3, 0, 0.0]])
        for value, k in ((math.nan, 0), (math.inf, 3), (-math.inf, 1)):
            for column in range(3):
                wrong = poses.copy()
                wrong[k, column] = value
                for name, call in (
                    ("estimate", lambda: fathom.evaluate(wrong, poses)),
                    ("reference", lambda: fathom.evaluate(poses, wrong, alignment="se2")),
                ):
                    with self.assertRaises(fathom.InputError) as caught:
                        call()
                    text = f"pose {k} of the {name} is not finite; expected x, y"
                    self.assertTrue(str(caught.exception).startswith(text), caught.exception)
                    self.assertNotIn("\n", str(caught.exception))
        right = numpy.tile(0.09 * numpy.eye(3), (4, 1, 1))
        flat = right.copy()
        flat[2, 0, 1] = flat[2, 1, 0] = 0.1
        for wrong, k in ((-right, 0), (0 * right, 1), (flat, 2)):
            with self.assertRaisesRegex(fathom.InputError, f"^covariance {k} is not positive"):
                fathom.evaluate(poses, poses, covariances=wrong)
        known_start = right.copy()
        known_start[0] = 0
        self.assertIn("anees", fathom.evaluate(poses, poses, covariances=known_start))

    def test_what_read_tum_refuses_is_not_written(self):
        poses = numpy.array([[0, 0, 0], [1, 0, 0.0]])
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "trajectory.tum")
            for times, expected in (
                ([10**9, 10**9], r"times_ns\[1\]: expected more than the 1000000000 ns before it"),
                ([2 * 10**9, 10**9], r"times_ns\[1\]: .*got 1000000000 ns"),
                ([0.0, 1e9], "times_ns: expected whole nanoseconds, an array of int64"),
                ("ab", "times_ns: expected whole nanoseconds, an array of int64"),
            ):
                with self.assertRaisesRegex(fathom.InputError, expected):
                    fathom.write_tum(path, times, poses)
            with self.assertRaisesRegex(fathom.InputError, r"trajectory\[0\]: expected finite"):
                fathom.write_tum(path, [0, 10**9], poses + [[math.nan, 0, 0], [0, 0, 0]])
            self.assertFalse(os.path.exists(path))

    def test_statistics(self):
        values = [1.0, 2.0, 3.0, 10.0]
        self.assertEqual(fathom.moments(values)["median"], 2.5)
        self.assertAlmostEqual(
            fathom.moments(values)["standard_deviation"], numpy.std(values, ddof=1)
        )
        self.assertIsNone(fathom.moments([]))
        low, high = fathom.bootstrap_interval(values)
        # Student's t of three degrees of freedom: beyond the least and largest value.
        self.assertTrue(low < 1 and high > 10)
        # Six positive differences: the least p of the exact test, 2 / 2^6.
        test = fathom.paired_difference([1, 2, 3, 4, 5, 6], [0, 0, 0, 0, 0, 0])
        self.assertEqual((test["p_value"], test["exact"]), (2 / 64, True))
        numpy.testing.assert_allclose(fathom.holm([0.01, 0.04, 0.03]), [0.03, 0.06, 0.06])
        low, high = fathom.wilson_interval(5, 10)
        self.assertAlmostEqual(low + high, 1)
        low, high = fathom.anees_interval(50)
        self.assertTrue(0.7 < low < 1 < high < 1.4)
        with self.assertRaises(fathom.InputError):
            fathom.holm([2.0])


class Logs(unittest.TestCase):
    def test_chi2_of_a_residual_in_closed_form(self):
        log = fathom.MeasurementLog()
        log.add_keyframe((1, 0, 0), numpy.diag([0.01, 0.04, 0.0025]))
        self.assertEqual(log.chi2(log.dead_reckoning), 0)
        self.assertAlmostEqual(log.chi2([[0, 0, 0], [1.1, 0.2, 0]]), 1 + 1)

    def test_refusals(self):
        log = fathom.MeasurementLog()
        with self.assertRaisesRegex(fathom.InputError, "positive definite"):
            log.add_keyframe((1, 0, 0), numpy.zeros((3, 3)))
        with self.assertRaisesRegex(fathom.InputError, "finite"):
            log.add_keyframe((math.nan, 0, 0), numpy.eye(3))
        log.add_keyframe((1, 0, 0), numpy.eye(3))
        for ends in ((0, 0), (0, 7), (5, 1)):
            with self.assertRaisesRegex(fathom.InputError, "newest keyframe"):
                log.add_registration(fathom.RelativePose(*ends, (0, 0, 0), numpy.eye(3)))
        with self.assertRaises(fathom.InputError):
            log.chi2(numpy.zeros((7, 3)))


if __name__ == "__main__":
    unittest.main()
