"""Estimators in Python: equal to those built in, and their faults are outcomes."""

import os
import subprocess
import sys
import tempfile
import unittest

import fathom
import misbehaving
import numpy

HERE = os.path.dirname(os.path.abspath(__file__))
EXAMPLES = os.path.join(HERE, "..", "..", "examples", "python")
CSAIL = os.path.join(os.environ["FATHOM_TEST_DATA"], "pose_graphs", "CSAIL.g2o")
sys.path.insert(0, EXAMPLES)

from ekf import NumpyEkf  # noqa: E402  (its folder is known only now)

STUDY = {
    "dataset": {"type": "simulated_log"},
    "estimators": [{"type": "ekf"}],
    "trials": 2,
}


def small_log():
    log = fathom.MeasurementLog()
    for k in range(1, 7):
        log.add_keyframe((1, 0, 1.2), numpy.diag([0.01, 0.02, 0.003]))
        if k > 3:
            covariance = [[0.02, 0.005, 0.001], [0.005, 0.03, 0.002], [0.001, 0.002, 0.004]]
            log.add_registration(fathom.RelativePose(k, k - 4, (-0.3, -0.6, 1.4), covariance))
    return log


def children():
    out = subprocess.run(["ps", "--ppid", str(os.getpid()), "-o", "comm="], capture_output=True)
    return [name for name in out.stdout.decode().split() if name != "ps"]


class Faults(unittest.TestCase):
    """Each with the outcome, and a part of the fault; no child is left."""

    CASES = [
        ("Raises", "numerical_failure", "KeyError: 'no such loop' (misbehaving.py:"),
        ("WrongShape", "numerical_failure", "joint_covariance: expected shape (3, 3), got (4, 4)"),
        ("UpperTriangle", "numerical_failure", "is not symmetric"),
        ("NegativeVariances", "numerical_failure", "has a negative variance"),
        ("NegativeNis", "numerical_failure", "has the NIS -2.75, expected 0 or more"),
        ("NegativeWeights", "numerical_failure", "a weight is -7, expected 0 to 1"),
        ("NotANumber", "numerical_failure", "pose"),
        ("TooFewPoses", "numerical_failure", "pose: expected shape (3,), got (2,)"),
        ("WordForPose", "numerical_failure", "pose: expected numbers of shape (3,), got str"),
        ("WrongOutcome", "numerical_failure", "got 'convergd', expected converged"),
        ("TooManyDecisions", "numerical_failure", "has 7 decisions, expected 1"),
        ("LosesWhatIsDone", "numerical_failure", "a report of converged has a decision 'lost'"),
        ("UsesWhatFailed", "numerical_failure", "a report of numerical_failure has a decision"),
        ("CountsBackwards", "numerical_failure", "a report has -1 iterations, expected 0 or more"),
        ("ReportsNothingKnown", "numerical_failure", "returned an object of int, expected an"),
        ("RaisesInInit", "numerical_failure", "ValueError: cannot begin (misbehaving.py:"),
        ("Exits", "numerical_failure", "SystemExit: 3"),
        ("Dies", "crashed", "about to die"),
        ("Hangs", "timed_out", ""),
        ("EatsMemory", "out_of_memory", ""),
        ("DiesInDestructor", "crashed", "signal 6"),
    ]

    def test_each_is_an_outcome(self):
        log = small_log()
        for name, outcome, fault in self.CASES:
            with self.subTest(name):
                limits = {"time_limit_s": 5 if name == "Hangs" else 60, "memory_limit_mib": 2000}
                ended = fathom.replay(log, getattr(misbehaving, name), **limits)
                self.assertEqual(ended.outcome, outcome, ended.fault)
                self.assertIn(fault, ended.fault)
                self.assertNotIn("\n", ended.fault)
                self.assertEqual(children(), [])

    def test_what_is_no_fault(self):
        for kind in (misbehaving.Prints, misbehaving.Forks, misbehaving.ForksAndExits):
            self.assertEqual(fathom.replay(small_log(), kind).outcome, "converged")
            self.assertEqual(children(), [])

    def test_a_study_goes_on_and_counts_them(self):
        with_them = fathom.compare(
            dict(STUDY, time_limit_s=5, memory_limit_mib=2000),
            [misbehaving.Raises, misbehaving.Dies, misbehaving.Hangs, NumpyEkf],
            jobs=2,
        )
        outcomes = {}
        for row in with_them.rows:
            outcomes.setdefault(row["estimator"], []).append(row["outcome"])
        self.assertEqual(outcomes["raises"], ["numerical_failure"] * 2)
        self.assertEqual(outcomes["dies"], ["crashed"] * 2)
        self.assertEqual(outcomes["hangs"], ["timed_out"] * 2)
        self.assertEqual(outcomes["ekf"], ["converged"] * 2)
        self.assertEqual(outcomes["numpy_ekf"], ["converged"] * 2)
        alone = fathom.compare(STUDY)
        numpy.testing.assert_array_equal(
            with_them.metric("mean_position_error_m", "ekf"),
            alone.metric("mean_position_error_m", "ekf"),
        )
        self.assertEqual(children(), [])


class EqualsTheBuiltIn(unittest.TestCase):
    def assert_equal(self, ours, theirs):
        self.assertLess(numpy.abs(ours.trajectory - theirs.trajectory).max(), 1e-9)
        self.assertLess(numpy.abs(ours.covariances - theirs.covariances).max(), 1e-9)
        self.assertLess(abs(ours.chi2 - theirs.chi2), 1e-7)
        nis = [[loop["nis"] for loop in one.loops] for one in (ours, theirs)]
        numpy.testing.assert_allclose(nis[0], nis[1], rtol=1e-6)

    def test_full_covariances_and_loops_written_backwards(self):
        log = small_log()
        self.assert_equal(fathom.replay(log, NumpyEkf), fathom.replay(log, "ekf"))

    @unittest.skipUnless(os.path.exists(CSAIL), f"no {CSAIL}")
    def test_csail_through_compare(self):
        study = {"dataset": {"type": "g2o", "path": CSAIL}, "estimators": [{"type": "ekf"}]}
        results = fathom.compare(study, [NumpyEkf])
        self.assertEqual(results.estimators, ["ekf", "numpy_ekf"])
        self.assert_equal(results.example["numpy_ekf"], results.example["ekf"])
        self.assertAlmostEqual(results.metric("chi2", "numpy_ekf")[0], 41.3802, places=4)


class SharedErrors(unittest.TestCase):
    """Registrations that tell what those of a picture share."""

    OWN = numpy.diag([0.004, 0.006, 0.0008]) + 0.0005

    def errors(self, lever):
        G = numpy.array([[0.3, 0.1, 2.0], [-0.2, -2.1, 0.2], [0.01, 0.0, lever]])
        return fathom.PictureErrors(G, (0.02, 0.01, 0.03))

    def told(self, k, lever):
        shared = fathom.SharedErrors(self.errors(lever), self.errors(-lever), self.OWN)
        return fathom.RelativePose(k, k - 4, (-0.3, -0.6, 1.4), shared=shared)

    def log(self):
        log = fathom.MeasurementLog()
        for k in range(1, 7):
            log.add_keyframe((1, 0, 1.2), numpy.diag([0.01, 0.02, 0.003]))
            for lever in (0.1, 0.2) if k > 3 else ():  # two of the same pictures
                log.add_registration(self.told(k, lever * k))
        return log

    def test_the_covariance_is_the_total_of_the_parts(self):
        z = self.told(5, 0.4)
        ends = (z.shared.from_, z.shared.to)
        of_both = [one.G @ numpy.diag(one.sigma**2) @ one.G.T for one in ends]
        numpy.testing.assert_allclose(z.shared.total, sum(of_both) + self.OWN, rtol=1e-12)
        numpy.testing.assert_allclose(z.covariance, z.shared.total, rtol=1e-9)
        self.assertIsNone(small_log().registrations[0].shared)

    def test_they_are_written_and_read_beside_the_graph(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "graph.g2o")
            fathom.write_g2o(self.log(), path)
            again = fathom.read_g2o(path)
        for one, other in zip(self.log().registrations, again.registrations):
            numpy.testing.assert_array_equal(one.shared.own, other.shared.own)
            numpy.testing.assert_array_equal(one.shared.to.G, other.shared.to.G)
            numpy.testing.assert_array_equal(one.shared.to.sigma, other.shared.to.sigma)

    def test_who_does_not_look_is_given_the_total(self):
        ours = fathom.replay(self.log(), NumpyEkf)
        theirs = fathom.replay(self.log(), "ekf", shared_errors="independent")
        numpy.testing.assert_allclose(ours.trajectory, theirs.trajectory, atol=1e-9)
        states = fathom.replay(self.log(), "ekf", shared_errors="states")
        self.assertGreater(numpy.abs(states.trajectory - theirs.trajectory).max(), 1e-4)

    def test_an_estimator_says_which_cost_is_its_own(self):
        class Estimates(NumpyEkf):
            def estimates_shared_errors(self):
                return True

        independent = fathom.replay(self.log(), NumpyEkf)
        self.assertLess(fathom.replay(self.log(), Estimates).chi2, independent.chi2)

    def test_what_cannot_be_is_refused(self):
        G = numpy.eye(3)
        for what, make in {
            "sigma: expected finite": lambda: fathom.PictureErrors(G, (0.1, -0.1, 0)),
            "G: expected finite": lambda: fathom.PictureErrors(G * numpy.nan, (0, 0, 0)),
            "own: expected a positive": lambda: fathom.SharedErrors(
                self.errors(0), self.errors(0), numpy.diag([1, 1, 0])),
        }.items():
            with self.assertRaisesRegex(fathom.InputError, what):
                make()


class Options(unittest.TestCase):
    def test_are_those_of_the_class_and_checked(self):
        (gate,) = fathom.options(NumpyEkf)
        self.assertEqual((gate["key"], gate["default"]), ("gate", "off"))
        with self.assertRaisesRegex(fathom.InputError, "gate"):
            fathom.replay(small_log(), NumpyEkf, gate=-1)
        with self.assertRaisesRegex(fathom.InputError, "did you mean 'gate'"):
            fathom.replay(small_log(), NumpyEkf, gaet=3)
        rejecting = fathom.replay(small_log(), NumpyEkf, gate=1e-12)
        self.assertEqual({loop["fate"] for loop in rejecting.loops}, {"rejected"})

    def test_types_follow_from_defaults(self):
        class Many(misbehaving.Follows):
            options = {
                "flag": True,
                "count": fathom.Option(3, at_least=1),
                "share": 0.5,
                "word": fathom.Option("a", choices=("a", "b")),
                "list": [1.0, 2.0],
            }

            def __init__(self, setup, **options):
                super().__init__(setup)
                if options != expected:
                    raise ValueError(options)

        expected = {"flag": False, "count": 4, "share": 0.25, "word": "b", "list": [3.0]}
        self.assertEqual(fathom.replay(small_log(), Many, **expected).fault, "")
        for wrong in ({"flag": 2}, {"count": 0}, {"share": "x"}, {"word": "c"}, {"list": 1}):
            with self.assertRaises(fathom.InputError):
                fathom.replay(small_log(), Many, **wrong)

    def test_limits_that_a_type_does_not_have_are_refused(self):
        for option, expected in (
            (fathom.Option(1, choices=("1", "2")), "'limited': choices are of text"),
            (fathom.Option(True, at_least=0), "'limited': at_least and at_most are of numbers"),
            (fathom.Option("x", at_most=3), "'limited': at_least and at_most are of numbers"),
            (fathom.Option([1.0], at_least=0), "'limited': at_least and at_most are of numbers"),
        ):
            kind = type("Limited", (misbehaving.Follows,), {"options": {"limited": option}})
            with self.assertRaisesRegex(fathom.InputError, expected):
                fathom.options(kind)

    def test_a_name_that_is_taken_or_no_word(self):
        for name in ("ekf", "Two Words"):
            kind = type("Named", (misbehaving.Follows,), {"name": name})
            with self.assertRaisesRegex(fathom.InputError, name):
                fathom.replay(small_log(), kind)


if __name__ == "__main__":
    unittest.main()
