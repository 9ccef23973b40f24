"""Data frames: their index, their units."""

import importlib.util
import sys
import unittest
import unittest.mock

import fathom
import numpy
from small_study import STUDY

HAS_PANDAS = importlib.util.find_spec("pandas") is not None


@unittest.skipUnless(HAS_PANDAS, "no pandas; 'scripts/setup.sh python' installs it")
class Frames(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.results = fathom.compare(STUDY)
        cls.addClassCleanup(cls.results.close)
        cls.example = cls.results.example["ekf"]

    def test_of_results(self):
        frame = self.results.to_frame()
        self.assertEqual(
            frame.index.names, ["cell", "noise", "loops", "survey", "trial", "estimator"]
        )
        self.assertTrue(frame.index.is_unique)
        ours = frame.xs(("ekf", 0.02, 0.1), level=("estimator", "noise", "loops"))
        numpy.testing.assert_array_equal(
            ours.mean_position_error_m, self.results.metric("mean_position_error_m", "ekf", 4)
        )
        units = frame.attrs["units"]
        self.assertEqual(units["mean_position_error_m"], "m")
        self.assertEqual(units["heading_rmse_rad"], "rad")
        self.assertEqual(units["update_ms.median"], "ms")
        self.assertNotIn("anees", units)

    def test_of_a_log(self):
        log = self.example.log
        steps = log.to_frame()
        self.assertEqual((steps.index.name, len(steps)), ("keyframe", len(log) - 1))
        self.assertEqual(steps.loc[3, "x_m"], log.steps[2].motion[0])
        self.assertEqual(steps.loc[3, "cov_yt"], log.steps[2].covariance[1, 2])
        self.assertEqual(steps.attrs["units"]["cov_yt"], "m rad")
        self.assertEqual(steps.attrs["units"]["x_m"], "m")
        loops = log.to_frame("registrations")
        self.assertEqual((loops.index.name, len(loops)), ("registration", log.registration_count))
        self.assertEqual(loops.loc[1, "to"], log.registrations[1].to)
        self.assertEqual(len(fathom.MeasurementLog().to_frame("registrations")), 0)

    def test_of_a_solution(self):
        frame = self.example.to_frame()
        self.assertEqual((frame.index.name, len(frame)), ("keyframe", len(self.example.log)))
        for column, name in (("position_error_m", "position_error_m"), ("x_m", "x_m")):
            numpy.testing.assert_array_equal(frame[column], self.results.series(name, "ekf"))
        nees = self.results.series("pose_nees", "ekf")
        numpy.testing.assert_array_equal(frame.pose_nees, [numpy.nan, *nees])
        numpy.testing.assert_array_equal(frame.truth_y_m, self.example.ground_truth[:, 1])
        self.assertEqual(frame.attrs["units"]["heading_error_rad"], "rad")
        fates = [loop["fate"] for loop in self.example.loops]
        self.assertEqual(list(self.example.to_frame("loops").fate), fates)
        without_loops = fathom.solve(fathom.MeasurementLog()).to_frame("loops")
        self.assertEqual(list(without_loops), list(self.example.loops[0]))
        self.assertEqual(len(without_loops), 0)
        without_truth = fathom.solve(self.example.log).to_frame()
        self.assertNotIn("position_error_m", without_truth)


class Without(unittest.TestCase):
    def test_pandas_is_asked_for_in_one_line(self):
        with unittest.mock.patch.dict(sys.modules, {"pandas": None}):
            with self.assertRaisesRegex(ImportError, "^to_frame needs pandas: install [^\n]*$"):
                fathom.MeasurementLog().to_frame()


if __name__ == "__main__":
    unittest.main()
