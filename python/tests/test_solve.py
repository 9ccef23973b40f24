"""Solves of small graphs, and refusals."""

import os
import signal
import tempfile
import threading
import unittest

import fathom
import numpy

EDGE = "EDGE_SE2 {} {} {} {} {} 100 0 0 100 0 400\n"
SQUARE = "".join(EDGE.format(k, k + 1, 1, 0, 1.5707963267948966) for k in range(3))


class Solve(unittest.TestCase):
    def setUp(self):
        with tempfile.NamedTemporaryFile("w", suffix=".g2o", delete=False) as file:
            file.write(SQUARE + EDGE.format(3, 0, 1.2, 0, 1.5707963267948966))
        self.path = file.name
        self.addCleanup(os.remove, self.path)

    def test_arrays_and_estimators_agree(self):
        log = fathom.read_g2o(self.path)
        self.assertEqual((len(log), log.registration_count), (4, 1))
        one = fathom.solve(log)
        other = fathom.solve(log, "ceres_pose_graph")
        self.assertEqual(one.trajectory.shape, (4, 3))
        self.assertEqual(one.covariances.shape, (4, 3, 3))
        self.assertGreater(one.chi2, 0)
        self.assertAlmostEqual(one.chi2, other.chi2, places=6)
        numpy.testing.assert_allclose(one.trajectory, other.trajectory, atol=1e-4)

    def test_what_looks_wrong_is_said(self):
        log = fathom.MeasurementLog()
        for information in (1e3, 1e22, 1e3):
            log.add_keyframe((1, 0, 0), numpy.eye(3) / information)
        log.add_registration(fathom.RelativePose(0, 3, (3, 0, 0), 1e-3 * numpy.eye(3)))
        self.assertTrue(any("times" in one for one in fathom.solve(log).remarks))
        self.assertEqual(fathom.solve(fathom.read_g2o(self.path)).remarks, [])

    def test_limits_that_nothing_would_hold_are_refused(self):
        log = fathom.read_g2o(self.path)
        for limits in ({"time_limit_s": 1.0}, {"memory_limit_mib": 100}):
            with self.assertRaisesRegex(fathom.InputError, "would be ignored"):
                fathom.replay(log, "ekf", **limits)
            with self.assertRaisesRegex(fathom.InputError, "would be ignored"):
                fathom.solve(log, isolation="none", **limits)
        limited = fathom.replay(log, "ekf", isolation="process", time_limit_s=60.0)
        self.assertEqual(limited.outcome, "converged")

    def test_headings_are_wrapped(self):
        log = fathom.MeasurementLog((0, 0, 7.0))
        log.add_keyframe((1, 0, -6.0), 0.01 * numpy.eye(3))
        start, newest = log.dead_reckoning
        self.assertAlmostEqual(start[2], 7.0 - 2 * numpy.pi)
        self.assertAlmostEqual(newest[2], 1.0)
        self.assertEqual(fathom.replay(log, "ekf").trajectory[0, 2], start[2])

    def test_a_covariance_is_positive_definite(self):
        for covariance in (-numpy.eye(3), numpy.zeros((3, 3))):
            with self.assertRaisesRegex(fathom.InputError, "positive definite"):
                fathom.RelativePose(0, 1, (0, 0, 0), covariance)

    def test_written_log_reads_back(self):
        log = fathom.read_g2o(self.path)
        fathom.write_g2o(log, self.path)
        self.assertEqual(fathom.read_g2o(self.path).to_g2o(), log.to_g2o())

    def test_misspelt_option_is_refused_with_the_nearest(self):
        with self.assertRaisesRegex(fathom.InputError, "did you mean 'max_iterations'"):
            fathom.solve(fathom.read_g2o(self.path), max_iteratoins=3)

    def test_unknown_estimator_and_missing_file(self):
        self.assertTrue(issubclass(fathom.InputError, ValueError))
        with self.assertRaisesRegex(ValueError, "did you mean 'ekf'"):
            fathom.solve(fathom.read_g2o(self.path), "ekff")
        with self.assertRaises(fathom.InputError):
            fathom.read_g2o(self.path + ".none")

    def test_another_thread_runs_on_and_its_interrupt_ends_the_solve(self):
        count = 4000  # the timer fires long before an EKF is through
        with open(self.path, "w") as file:
            for k in range(1, count):
                file.write(EDGE.format(k - 1, k, 1, 0, 0))
                if k > 1:
                    file.write(EDGE.format(k - 2, k, 2, 0, 0))
        log = fathom.read_g2o(self.path)
        # Fires only if the solve lets go of the interpreter's lock.
        timer = threading.Timer(0.3, os.kill, (os.getpid(), signal.SIGINT))
        timer.start()
        with self.assertRaises(KeyboardInterrupt):
            fathom.solve(log, "ekf")
        timer.join()


if __name__ == "__main__":
    unittest.main()
