"""Studies and runs from dicts and files, results, interrupts."""

import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import threading
import unittest

import fathom
import misbehaving
import numpy

STUDY = {
    "dataset": {"type": "simulated_log"},
    "estimators": [{"type": "ekf"}, {"type": "trajectory_iekf", "max_iterations": 3}],
    "trials": 3,
    "sweep": [{"key": "dataset.odometry.sigma_theta_rad", "name": "noise", "values": [0.01, 0.02]}],
}


class Dicts(unittest.TestCase):
    """The same checks as of files, by the same code."""

    def refusal(self, study, **keywords):
        with self.assertRaises(fathom.InputError) as caught:
            fathom.compare(study, **keywords)
        return str(caught.exception)

    def test_misspelt_and_wrong(self):
        simple = {"dataset": {"type": "simulated_log"}}
        self.assertIn("did you mean 'trials'", self.refusal({**simple, "trails": 3}))
        self.assertIn("trials", self.refusal({**simple, "trials": 0}))
        self.assertIn("'many'", self.refusal({**simple, "trials": "many"}))
        self.assertIn("did you mean 'ekf'", self.refusal(simple, estimators=["ekff"]))
        self.assertIn("cannot use a value of type set", self.refusal({**simple, "seed": {1}}))
        self.assertIn("trials", self.refusal({**simple, "trials": None}))
        self.assertNotIn(":1:", self.refusal({**simple, "trails": 3}))

    def test_what_is_nested_too_deeply_or_in_itself(self):
        deep, loop, ring = {}, {}, []
        for _ in range(500):
            deep = {"a": deep}
        loop["dataset"] = loop
        ring.append(ring)
        for wrong in (deep, loop, {"sweep": ring}):
            estimator = {"type": "ekf", "gate": wrong}
            for text in (
                self.refusal(wrong),
                self.refusal(STUDY, set=wrong),
                self.refusal(STUDY, estimators=[estimator]),
            ):
                self.assertIn("is nested too deeply, or in itself", text)
                self.assertNotIn("\n", text)

    def test_a_list_that_is_set_replaces_the_whole_list(self):
        changes = {
            "estimators": [{"type": "incremental_smoother"}],
            "sweep": [{"key": "seed", "name": "seed", "values": [5]}],
        }
        gated = [{"type": "ekf", "gate_probability": 0.5}, {"type": "ekf", "name": "two"}]
        study = {**STUDY, "estimators": gated}
        with fathom.compare(study, set=changes, trials=1) as results:
            self.assertEqual(results.estimators, ["incremental_smoother"])
            self.assertNotEqual(results.configuration["estimators.0.gate_probability"], "0.5")
            self.assertEqual(results.axes, {"seed": ["5"]})
        # Their items by their places.
        changes = {"estimators.1": {"max_iterations": 1}}
        with fathom.compare(STUDY, set=changes, trials=1) as results:
            self.assertEqual(results.configuration["estimators.1.max_iterations"], "1")
            self.assertEqual(results.estimators, ["ekf", "trajectory_iekf"])

    def test_values_of_numpy_and_paths(self):
        graph = pathlib.Path(tempfile.mkdtemp()) / "graph.g2o"
        log = fathom.MeasurementLog((numpy.float64(1), 2, 3))
        log.add_keyframe(numpy.array([1, 0, 0]), numpy.eye(3))
        fathom.write_g2o(log, graph)
        results = fathom.compare(
            {"dataset": {"type": "g2o", "path": graph}, "seed": numpy.int64(4)}, ["ekf"]
        )
        self.assertEqual(results.configuration["seed"], "4")
        self.assertEqual({row["outcome"] for row in results.rows} - {""}, {"converged"})


class Studies(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.results = fathom.compare(STUDY)

    def test_rows_and_arrays(self):
        self.assertEqual(self.results.estimators, ["ekf", "trajectory_iekf"])
        self.assertEqual(len(self.results.rows), 2 * 3 * 3)
        self.assertEqual({row["noise"] for row in self.results.rows}, {"0.01", "0.02"})
        errors = self.results.metric("mean_position_error_m", "ekf", cell=1)
        self.assertEqual(errors.shape, (3,))
        self.assertTrue((errors > 0).all())
        self.assertIn("trajectory_iekf", self.results.table())
        self.assertTrue(os.path.exists(os.path.join(self.results.folder, "report.html")))

    def test_frame(self):
        try:
            import pandas  # noqa: F401
        except ImportError:
            self.skipTest("no pandas; 'scripts/setup.sh python' installs it")
        frame = self.results.to_frame()
        mean = frame.xs(("ekf", 0), level=("estimator", "cell")).mean_position_error_m.mean()
        self.assertEqual(mean, self.results.metric("mean_position_error_m", "ekf").mean())

    def test_equal_to_the_program(self):
        with tempfile.TemporaryDirectory() as folder:
            study = os.path.join(folder, "study.yaml")
            with open(study, "w") as file:
                file.write(
                    "dataset: {type: simulated_log}\n"
                    "estimators:\n  - {type: ekf}\n  - {type: trajectory_iekf, max_iterations: 3}\n"
                    "trials: 3\nsweep:\n  - {key: dataset.odometry.sigma_theta_rad, name: noise,"
                    " values: [0.01, 0.02]}\n"
                )
            out = os.path.join(folder, "out")
            subprocess.run(
                [os.environ["FATHOM_BINARY"], "compare", study, "--out", out, "--quiet"],
                check=True,
            )
            theirs = fathom.open_results(out)
            again = fathom.compare(study, out=out)  # nothing is left to do
        for name in ("mean_position_error_m", "anees", "chi2"):
            for cell in (0, 1):
                for estimator in self.results.estimators:
                    ours = self.results.metric(name, estimator, cell)
                    numpy.testing.assert_array_equal(ours, theirs.metric(name, estimator, cell))
                    numpy.testing.assert_array_equal(ours, again.metric(name, estimator, cell))

    def test_series_of_a_run(self):
        errors = self.results.series("position_error_m", "ekf", trial=2)
        self.assertGreater(len(errors), 10)
        self.assertIsNone(self.results.series("update_ms", "dead_reckoning"))

    def test_the_temporary_folder_goes_with_the_results(self):
        results = fathom.compare(STUDY, trials=1)
        folder = results.folder
        del results
        self.assertFalse(os.path.exists(folder))


class Runs(unittest.TestCase):
    def test_a_run_of_a_class(self):
        config = {"dataset": {"type": "simulated_log"}}
        ours = fathom.run(config, misbehaving.Follows)
        theirs = fathom.run(config, "ekf")
        numpy.testing.assert_allclose(
            ours.trajectory, ours.log.dead_reckoning, rtol=0, atol=1e-12
        )
        self.assertLess(
            theirs.metrics["mean_position_error_m"], ours.metrics["mean_position_error_m"]
        )
        judged = fathom.evaluate(
            theirs.trajectory, theirs.ground_truth, covariances=theirs.covariances
        )
        for name in ("mean_position_error_m", "anees"):
            self.assertAlmostEqual(judged[name], theirs.metrics[name], places=12)

    def test_files_of_a_run(self):
        with tempfile.TemporaryDirectory() as folder:
            out = os.path.join(folder, "run")
            run = fathom.run({"dataset": {"type": "simulated_log"}}, "ekf", out=out)
            times, poses = fathom.read_tum(os.path.join(out, "trajectory.tum"))
            numpy.testing.assert_array_equal(times, run.times_ns)
            numpy.testing.assert_allclose(poses, run.trajectory, atol=1e-12)
            fathom.write_tum(os.path.join(folder, "again.tum"), times, poses)
            again = fathom.read_tum(os.path.join(folder, "again.tum"))
            numpy.testing.assert_array_equal(again[1][:, :2], poses[:, :2])


class Interrupts(unittest.TestCase):
    """Ctrl-C: once the work has begun, and no child is left."""

    def interrupted(self, action):
        timer = threading.Timer(0.5, os.kill, (os.getpid(), signal.SIGINT))
        timer.start()
        with self.assertRaises(KeyboardInterrupt):
            action()
        timer.join()
        out = subprocess.run(["ps", "--ppid", str(os.getpid()), "-o", "comm="], capture_output=True)
        self.assertEqual(set(out.stdout.decode().split()), {"ps"})

    def test_of_a_study(self):
        study = {"dataset": {"type": "simulated_log"}, "trials": 100000}
        self.interrupted(lambda: fathom.compare(study, jobs=2))

    def test_of_a_hanging_estimator(self):
        log = fathom.MeasurementLog()
        for k in range(5):
            log.add_keyframe((1, 0, 0), numpy.eye(3))
        log.add_registration(fathom.RelativePose(5, 0, (-5, 0, 0), numpy.eye(3)))
        self.interrupted(lambda: fathom.replay(log, misbehaving.Hangs))
        self.interrupted(lambda: fathom.replay(log, misbehaving.Hangs, isolation="none"))

    def test_of_a_batch_solve(self):
        class HangsInBatch(misbehaving.Follows):
            can_batch = True

            def finish(self, start):
                while True:
                    pass

        log = fathom.MeasurementLog()
        log.add_keyframe((1, 0, 0), numpy.eye(3))
        self.interrupted(lambda: fathom.solve(log, HangsInBatch))

    def test_progress_that_raises_ends_the_study(self):
        def stop(progress):
            if progress["done"] > 2:
                raise StopIteration("enough")

        with self.assertRaisesRegex(StopIteration, "enough"):
            fathom.compare({**STUDY, "trials": 1000}, progress=stop)


if __name__ == "__main__":
    sys.exit(unittest.main())
