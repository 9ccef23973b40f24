"""What is given in place of something else is refused in one line that says what is expected."""

import unittest

import fathom
import misbehaving
import numpy

ALONE = {"dataset": {"type": "simulated_log"}, "trials": 1}


def small_log():
    log = fathom.MeasurementLog()
    log.add_keyframe((1, 0, 0), 0.01 * numpy.eye(3))
    log.add_registration(fathom.RelativePose(1, 0, (-1, 0, 0), 0.01 * numpy.eye(3)))
    return log


class OfCalls(unittest.TestCase):
    def refused(self, text, call):
        with self.subTest(text), self.assertRaises(fathom.InputError) as caught:
            call()
        self.assertIn(text, str(caught.exception))
        self.assertNotIn("\n", str(caught.exception))

    def test_a_study_has_the_estimators_of_the_list(self):
        with_ekf = {**ALONE, "estimators": [{"type": "ekf"}]}
        mine = misbehaving.Follows
        for study, given, expected in (
            (ALONE, [mine], ["follows"]),
            (ALONE, mine, ["follows"]),
            (ALONE, "ekf", ["ekf"]),
            (ALONE, {"type": "ekf", "name": "one"}, ["one"]),
            (ALONE, (mine, "ekf"), ["follows", "ekf"]),
            (with_ekf, mine, ["ekf", "follows"]),
            (with_ekf, None, ["ekf"]),
        ):
            with self.subTest(str(given)), fathom.compare(study, given) as results:
                self.assertEqual(results.estimators, expected)
        for wrong, text in (
            ([], "estimators: is empty"),
            ([mine, mine], "two estimators are called 'follows'"),
            (["ekf", "ekf"], "two estimators are called 'ekf'"),
            (int, "got the class int"),
            ([int], "got the class int"),
            (3, "got 3"),
            ([fathom.MeasurementLog()], "got an object of MeasurementLog"),
        ):
            self.refused(text, lambda: fathom.compare(ALONE, wrong))

    def test_settings_are_a_dict(self):
        self.refused("the study: is empty", lambda: fathom.compare({}, ["ekf"]))
        self.refused("the configuration: is empty", lambda: fathom.run({}))
        self.refused("x.g2o: ", lambda: fathom.read_g2o("x" * 300 + ".g2o"))
        text = "set: expected a dict as {'seed': 3}, got 'seed=3'"
        self.refused(text, lambda: fathom.compare(ALONE, set="seed=3"))
        self.refused(text, lambda: fathom.run(ALONE, set="seed=3"))

    def test_logs_and_estimators(self):
        log = small_log()
        self.refused(
            "log: expected a MeasurementLog, as of read_g2o(FILE), got 'no.g2o'",
            lambda: fathom.solve("no.g2o", "ekf"),
        )
        self.refused("estimator: expected a name", lambda: fathom.solve(log, 3))
        self.refused("got an object of MeasurementLog", lambda: fathom.replay(log, log))

    def test_pictures_altitudes_and_alignments(self):
        a = numpy.zeros((4, 4), numpy.uint8)
        self.refused("a: expected an array", lambda: fathom.register(1, a, 2, 2, {}))
        self.refused(
            "altitude_b: expected a number of metres above 0, got -2",
            lambda: fathom.register(a, a, 2, -2, {}),
        )
        self.refused("altitude_a: ", lambda: fathom.register(a, a, "2", 2, {}))
        self.refused("seed: ", lambda: fathom.register(a, a, 2, 2, {}, seed=-1))
        poses = numpy.zeros((2, 3))
        self.refused(
            "did you mean 'origin'", lambda: fathom.evaluate(poses, poses, alignment="orign")
        )

    def test_attributes(self):
        log = small_log()
        for right, thing, wrong in (
            ("motion", log.registrations[0], "moton"),
            ("registrations", log, "registration"),
        ):
            with self.assertRaisesRegex(AttributeError, f"did you mean .*'{right}'"):
                getattr(thing, wrong)
        self.assertFalse(hasattr(log, "_repr_png_"))


class OfEstimators(unittest.TestCase):
    def test_a_method_that_is_missing(self):
        class Lacks(fathom.Estimator):
            def __init__(self, setup):
                pass

            def pose(self, k):
                return (0, 0, 0)

            def add_keyframe(self, step):
                pass

            def updte(self, measurements):
                pass

        text = "Lacks: has no update; .*'updte'; did you mean 'update'"
        with self.assertRaisesRegex(fathom.InputError, text):
            fathom.replay(small_log(), Lacks)

    def test_a_method_that_looks_misspelt(self):
        own = dict.fromkeys(("pose_of", "poses"), len)
        own["joint_covarance"] = misbehaving.WrongShape.joint_covariance
        with self.assertWarnsRegex(UserWarning, "'joint_covarance'; did you mean") as warned:
            fathom.options(type("Slips", (misbehaving.Follows,), own))
        self.assertEqual(len(warned.warnings), 1)


if __name__ == "__main__":
    unittest.main()
