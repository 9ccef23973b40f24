"""A name that is not there is refused with the nearest one."""

import copy
import os
import pathlib
import pickle
import tempfile
import unittest

import fathom
import numpy
from small_study import STUDY


class Names(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.results = fathom.compare(STUDY)
        cls.addClassCleanup(cls.results.close)

    def refusal(self, action):
        with self.assertRaises(fathom.InputError) as caught:
            action()
        self.assertNotIn("\n", str(caught.exception))
        return str(caught.exception)

    def test_of_results(self):
        results, example = self.results, self.results.example["ekf"]
        series = results.series
        for nearest, action in (
            ("anees", lambda: results.metric("anes", "ekf")),
            ("ekf", lambda: results.metric("anees", "ekff")),
            ("dead_reckoning", lambda: results.metric("anees", "dead_reckonin")),
            ("noise", lambda: results.metric("anees", "ekf", {"nois": 0.01})),
            ("0.01", lambda: results.metric("anees", "ekf", {"noise": "0.011", "loops": 1})),
            ("pose_nees", lambda: series("pose_ness", "ekf")),
            ("ekf", lambda: series("pose_nees", "efk")),
            ("trial", lambda: results.rows[0]["trail"]),
            ("ekf", lambda: results.example["efk"]),
            ("seed", lambda: results.configuration["sed"]),
            ("noise", lambda: results.axes["nois"]),
            ("anees", lambda: example.metrics["aneess"]),
            ("trajectory", lambda: results.plot("trajektory")),
            ("keyframes", lambda: example.to_frame("keyframe")),
            ("registrations", lambda: example.log.to_frame("registration")),
            ("ate_rmse_m", lambda: fathom.evaluate(numpy.eye(3), numpy.eye(3))["ate_rms_m"]),
        ):
            with self.subTest(nearest):
                text = self.refusal(action)
                self.assertTrue(text.endswith(f"; did you mean '{nearest}'?"), text)
                with self.assertRaises(KeyError):
                    action()

    def test_none_is_near(self):
        text = self.refusal(lambda: self.results.metric("anees", "nothing_of_the_kind"))
        self.assertIn("there are ekf, trajectory_iekf, dead_reckoning", text)
        text = self.refusal(lambda: self.results.series("nothing_of_the_kind", "ekf"))
        self.assertTrue(text.endswith(" and others"), text)

    def test_what_is_known_of_no_run_is_no_misspelling(self):
        self.assertEqual(len(self.results.metric("memory_bytes", "ekf")), 0)
        self.assertEqual(len(self.results.metric("rpe_7_keyframes_m", "ekf")), 0)
        self.assertIsNone(self.results.series("loop_from", "dead_reckoning"))

    def test_runs_that_are_not_there(self):
        self.assertIn("0 to 5, got 6", self.refusal(lambda: self.results.metric("anees", "ekf", 6)))
        for trial in (2, -1):
            text = self.refusal(lambda: self.results.series("x_m", "ekf", trial=trial))
            self.assertEqual(text, f"ekf has no run of trial {trial} of survey 0 in cell 0")

    def test_a_cell_by_its_values(self):
        expected = self.results.metric("anees", "ekf", 4)
        for loops in (0.1, "0.1"):
            found = self.results.metric("anees", "ekf", {"noise": 0.02, "loops": loops})
            numpy.testing.assert_array_equal(found, expected)
        self.assertEqual(self.results.cells[4], {"noise": "0.02", "loops": "0.1"})
        text = self.refusal(lambda: self.results.metric("anees", "ekf", {"noise": 0.02}))
        self.assertIn("3 cells fit", text)
        self.assertIn("loops", text)

    def test_a_cell_by_values_that_are_words_in_files(self):
        for key, values in (
            ("estimators.0.gate_probability", [None, 0.9]),
            ("dataset.loops.shared_is_told", [True, False]),
        ):
            axis = {"key": key, "name": "axis", "values": values}
            changes = {"dataset.loops.shared_sigma_m": 0.01, "sweep": [axis], "trials": 1}
            with fathom.compare(STUDY, set=changes) as results:
                self.assertEqual([results.cell({"axis": value}) for value in values], [0, 1])

    def test_a_dict_of_names_is_one_still(self):
        row = self.results.rows[0]
        self.assertIsNone(row.get("trail"))
        for other in (copy.deepcopy(row), pickle.loads(pickle.dumps(row))):
            self.assertEqual(other, row)
            self.assertIn("'trial'", self.refusal(lambda: other["trail"]))


class Closing(unittest.TestCase):
    def test_a_temporary_folder_goes(self):
        with fathom.compare({**STUDY, "trials": 1}) as results:
            folder = pathlib.Path(results.folder)
            self.assertTrue((folder / "report.html").is_file())
        self.assertFalse(folder.exists())
        self.assertEqual(len(results.metric("anees", "ekf")), 1)
        for action in (results.table, lambda: results.series("x_m", "ekf")):
            with self.assertRaisesRegex(fathom.InputError, "are closed; open them with"):
                action()
        results.close()

    def test_it_stays_at_the_end_of_a_process_that_was_forked(self):
        with fathom.compare({**STUDY, "trials": 1}) as results:
            child = os.fork()
            if child == 0:
                results.close()
                os._exit(0)
            os.waitpid(child, 0)
            self.assertTrue(os.path.exists(results.folder))

    def test_a_folder_of_the_users_stays(self):
        with tempfile.TemporaryDirectory() as folder:
            with fathom.compare({**STUDY, "trials": 1}, out=folder + "/study"):
                pass
            with fathom.open_results(folder + "/study") as results:
                self.assertEqual(len(results.metric("anees", "ekf")), 1)
            self.assertTrue(os.path.exists(folder + "/study/results.sqlite"))


if __name__ == "__main__":
    unittest.main()
