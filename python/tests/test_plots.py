"""Plots: what is drawn where, with which words on the axes."""

import importlib.util
import sys
import unittest
import unittest.mock

import fathom
import numpy
from small_study import FAILING, STUDY

HAS_MATPLOTLIB = importlib.util.find_spec("matplotlib") is not None


@unittest.skipUnless(HAS_MATPLOTLIB, "no matplotlib; 'apt-get install python3-matplotlib' has it")
class Plots(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        import matplotlib

        matplotlib.use("Agg")
        cls.results = fathom.compare(STUDY)
        cls.addClassCleanup(cls.results.close)
        cls.example = cls.results.example["ekf"]

    def tearDown(self):
        import matplotlib.pyplot

        matplotlib.pyplot.close("all")

    def lines(self, ax):
        ax.figure.canvas.draw()
        return {line.get_label(): line.get_xydata() for line in ax.get_lines()}

    def words(self, ax):
        return ax.get_xlabel(), ax.get_ylabel()

    def test_maps(self):
        for ax in (self.example.plot(), self.results.plot()):
            lines = self.lines(ax)
            self.assertTrue({"ground truth", "dead reckoning", "loops", "ekf"} <= set(lines))
            numpy.testing.assert_allclose(lines["ekf"], self.example.trajectory[:, [1, 0]])
            self.assertEqual(self.words(ax), ("y (m)", "x (m)"))
            self.assertEqual(ax.get_aspect(), 1.0)
            self.assertTrue(ax.xaxis_inverted())  # y is to the left
        self.assertEqual(set(self.lines(self.example.log.plot())), {"loops", "dead reckoning"})

    def test_dead_reckoning_is_moved_with_the_estimate(self):
        start = {"x_m": 5, "y_m": 3, "heading_rad": 1}
        study = {"dataset": {"type": "simulated_log", "start": start}}
        with fathom.compare(study, ["ekf"]) as results:
            of_run = self.lines(results.example["ekf"].plot())
            for label, line in self.lines(results.plot()).items():
                numpy.testing.assert_allclose(of_run[label], line, atol=1e-9)

    def test_errors(self):
        errors = self.results.series("position_error_m", "ekf", trial=1)
        ax = self.results.plot("error", trial=1)
        numpy.testing.assert_array_equal(self.lines(ax)["ekf"][:, 1], errors)
        self.assertEqual(self.words(ax), ("time (s)", "position error (m)"))
        self.assertEqual(len(self.lines(self.example.plot("error"))), 1)

    def test_nees(self):
        ax = self.example.plot("nees")
        nees = self.results.series("pose_nees", "ekf")
        numpy.testing.assert_allclose(self.lines(ax)["ekf"][:, 1], nees / 3)
        self.assertEqual(ax.get_xlabel(), "time (s)")
        bounds = ax.collections[0].get_paths()[0].vertices[:, 1]
        numpy.testing.assert_allclose((bounds.min(), bounds.max()), fathom.anees_interval(1))
        ax = self.results.plot("nees", cell=1)
        bounds = ax.collections[0].get_paths()[0].vertices[:, 1]
        numpy.testing.assert_allclose((bounds.min(), bounds.max()), fathom.anees_interval(2))
        both = [self.results.series("pose_nees", "ekf", 1, trial=trial) for trial in (0, 1)]
        numpy.testing.assert_allclose(self.lines(ax)["ekf"][:, 1], sum(both) / 6)

    def test_regimes(self):
        ax = self.results.plot("regimes", estimator="trajectory_iekf")
        squares = ax.get_images()[0].get_array()
        self.assertEqual(squares.shape, (3, 2))
        means = [
            self.results.metric("mean_position_error_m", one, {"noise": 0.02, "loops": 0.1}).mean()
            for one in ("trajectory_iekf", "ekf")
        ]
        self.assertAlmostEqual(squares[1, 1], means[0] / min(means))
        self.assertEqual(self.words(ax), ("noise", "loops"))
        self.assertEqual([one.get_text() for one in ax.get_yticklabels()], ["0.01", "0.1", "1"])
        with self.assertRaisesRegex(fathom.InputError, "of anees the least is not the best"):
            self.results.plot("regimes", metric="anees")

    def test_axes_of_the_users(self):
        import matplotlib.figure

        ax = matplotlib.figure.Figure().subplots()
        self.assertIs(self.example.plot("error", ax), ax)
        self.assertIs(self.results.plot("nees", ax), ax)


class Axes:
    """As much of matplotlib's as keeps what is drawn."""

    def __init__(self):
        self.lines = {}
        self.bounds = None

    def plot(self, x, y, label):
        self.lines[label] = y

    def fill_between(self, x, low, high, **style):
        self.bounds = low[0], high[0]

    def __getattr__(self, name):
        return lambda *arguments, **names: None


class Means(unittest.TestCase):
    def test_nees_is_of_the_runs_that_were_done(self):
        with fathom.compare(FAILING) as results:
            axes = results.plot("nees", Axes())
            done = [results.series("pose_nees", "ekf", trial=trial) for trial in (1, 2)]
        numpy.testing.assert_allclose(axes.lines["ekf"], sum(done) / 6)
        # Of the estimator that was done three times.
        numpy.testing.assert_allclose(axes.bounds, fathom.anees_interval(3))

    def test_regimes_of_what_does_not_rank_are_refused(self):
        poor = {**STUDY, "association.false_loops.share": 0.3, "report.metrics": ["chi2"]}
        with fathom.compare(poor) as results:
            with self.assertRaisesRegex(
                fathom.InputError, "chi2 does not rank: where measurements do not fit each other"
            ):
                results.plot("regimes", Axes(), metric="chi2")


class Without(unittest.TestCase):
    def test_matplotlib_is_asked_for_in_one_line(self):
        with unittest.mock.patch.dict(sys.modules, {"matplotlib": None, "matplotlib.pyplot": None}):
            with self.assertRaisesRegex(ImportError, "^plot needs matplotlib: install [^\n]*$"):
                fathom.MeasurementLog().plot()

    def test_what_is_not_known_is_not_drawn(self):
        log = fathom.MeasurementLog()
        log.add_keyframe((1, 0, 0), numpy.eye(3))
        with self.assertRaisesRegex(fathom.InputError, "'error': needs ground truth"):
            fathom.solve(log).plot("error", ax=object())


if __name__ == "__main__":
    unittest.main()
