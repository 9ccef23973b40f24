"""Figures of results: those of the table, without runs that failed, over the same trials."""

import importlib.util
import unittest

import fathom
import numpy
from small_study import FAILING

ERROR = "mean_position_error_m"
HAS_PANDAS = importlib.util.find_spec("pandas") is not None


class OfAStudyWithFailures(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.results = fathom.compare(FAILING)
        cls.addClassCleanup(cls.results.close)

    def errors(self, estimator):
        """Of all runs, by trial."""
        rows = [row for row in self.results.rows if row["estimator"] == estimator]
        self.assertEqual([row["trial"] for row in rows], [0, 1, 2])
        return numpy.array([row[ERROR] for row in rows])

    def test_metrics_are_of_runs_that_were_done(self):
        errors = self.errors("ekf")
        numpy.testing.assert_array_equal(self.results.metric(ERROR, "ekf"), errors[1:])
        numpy.testing.assert_array_equal(self.results.metric(ERROR, "ekf", failed=True), errors)
        self.assertEqual(len(self.results.metric(ERROR, "dead_reckoning")), 3)
        self.assertIn(f"{errors[1:].mean():.3g}", self.results.table())

    def test_differences_are_over_the_trials_that_both_did(self):
        found = self.results.difference(ERROR, "ekf", "trajectory_iekf")
        differences = (self.errors("ekf") - self.errors("trajectory_iekf"))[1:]
        expected = fathom.paired_difference(differences, [0, 0])
        self.assertEqual({name: found[name] for name in expected}, expected)
        self.assertEqual((found["count"], found["trials"], found["over"]), (2, 2, "trials"))
        self.assertIsNone(self.results.difference("memory_bytes", "ekf", "trajectory_iekf"))

    def test_intervals_are_of_runs_that_were_done(self):
        found = self.results.interval(ERROR, "ekf")
        self.assertEqual(found, fathom.bootstrap_interval(self.errors("ekf")[1:]))
        self.assertIsNone(self.results.interval("memory_bytes", "ekf"))

    def test_other_names_are_refused(self):
        for action in (
            lambda: self.results.interval("anes", "ekf"),
            lambda: self.results.interval("anees", "efk"),
            lambda: self.results.difference("anes", "ekf", "trajectory_iekf"),
            lambda: self.results.difference("anees", "ekf", "trajectory_iefk"),
        ):
            with self.assertRaisesRegex(fathom.InputError, "did you mean"):
                action()

    @unittest.skipUnless(HAS_PANDAS, "no pandas; 'scripts/setup.sh python' installs it")
    def test_frames_have_no_metrics_of_failed_runs(self):
        frame = self.results.to_frame().xs("ekf", level="estimator")
        self.assertEqual(len(frame), 3)
        self.assertNotIn(frame.outcome.iloc[0], ("converged", "iteration_limit"))
        self.assertEqual(frame[ERROR].mean(), self.results.metric(ERROR, "ekf").mean())
        whole = self.results.to_frame(failed=True).xs("ekf", level="estimator")
        numpy.testing.assert_array_equal(whole[ERROR], self.errors("ekf"))


class OfSeveralSurveys(unittest.TestCase):
    def test_draws_are_surveys(self):
        mission = {"type": "single_loop", "loop_length_m": 2, "loop_width_m": 1}
        camera = {"width": 160, "height": 120, "fx": 125, "fy": 125, "cx": 79.5, "cy": 59.5}
        data = {"type": "simulated", "mission": mission, "camera": camera}
        study = {"dataset": data, "surveys": 2, "trials": 2}
        with fathom.compare(study, ["sparse_gauss_newton", "ekf"]) as results:
            ours, theirs = (results.metric(ERROR, one) for one in results.estimators)
            found = results.difference(ERROR, *results.estimators)
            self.assertEqual((found["count"], found["trials"], found["over"]), (2, 4, "surveys"))
            of_surveys = (ours - theirs).reshape(2, 2).mean(axis=1)
            expected = fathom.paired_difference(of_surveys, [0, 0])
            self.assertAlmostEqual(found["mean"], expected["mean"], places=15)
            self.assertEqual(found["p_value"], expected["p_value"])
            low, high = results.interval(ERROR, "ekf")
            narrow_low, narrow_high = fathom.bootstrap_interval(theirs)
            self.assertTrue(low < narrow_low and narrow_high < high)
            self.assertIn(f"[{low:.3g}, {high:.3g}]", results.table())


if __name__ == "__main__":
    unittest.main()
