"""Which code an estimator is: what belongs to a study, and what may not change under it."""

import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import unittest

import fathom
import misbehaving
import numpy

STUDY = {"dataset": {"type": "simulated_log"}, "estimators": [{"type": "ekf"}]}

SOURCE = '''
import fathom
from part import OFFSET

class Mine(fathom.Estimator):
    """dead reckoning, moved"""
    name = "{name}"

    def __init__(self, setup):
        self.poses = [setup.start]

    def pose(self, k):
        return self.poses[k] + (OFFSET if k else 0.0)

    def add_keyframe(self, step):
        x, y, t = self.poses[-1]
        u = step.forward().motion
        c, s = fathom_cos(t), fathom_sin(t)
        moved = [x + c * u[0] - s * u[1], y + s * u[0] + c * u[1], t + u[2]]
        self.poses.append(fathom_array(moved))

    def update(self, measurements):
        {update}

from numpy import array as fathom_array, cos as fathom_cos, sin as fathom_sin
'''


def plugin(folder, name="mine", offset=0.0, update="return None"):
    folder = pathlib.Path(folder)
    folder.mkdir(exist_ok=True)
    (folder / "part.py").write_text(f"OFFSET = {offset}\n")
    (folder / f"{name}.py").write_text(SOURCE.format(name=name, update=update))
    return folder / f"{name}.py"


def run(code, *arguments, timeout=60, **environment):
    return subprocess.run(
        [sys.executable, "-c", code, *map(str, arguments)],
        capture_output=True,
        text=True,
        timeout=timeout,
        env={**os.environ, **environment},
    )


def compare(*words, cwd=None):
    return subprocess.run(
        [os.environ["FATHOM_BINARY"], *map(str, words)],
        capture_output=True,
        text=True,
        timeout=60,
        cwd=cwd,
    )


class Code(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.top = pathlib.Path(folder.name)
        self.study = self.top / "s.yaml"
        self.study.write_text("dataset: {type: simulated_log}\nestimators: [{type: mine}]\n")

    def test_a_class_of_a_notebook_that_was_run_again_is_another(self):
        out = self.top / "out"

        def defined(offset):
            space = {"fathom": fathom, "numpy": numpy, "offset": offset, "__name__": "__main__"}
            exec(
                compile(
                    "class Cell(fathom.Estimator):\n"
                    "    def __init__(self, setup): self.x = [setup.start]\n"
                    "    def pose(self, k): return self.x[k]\n"
                    "    def add_keyframe(self, step): self.x.append(self.x[-1] + offset)\n"
                    "    def update(self, measurements): return None\n",
                    "<cell>",
                    "exec",
                ),
                space,
            )
            return space["Cell"]

        first = defined(0.0)
        fathom.compare(STUDY, [first], out=out)
        fathom.compare(STUDY, [first], out=out)
        with self.assertRaisesRegex(fathom.InputError, "Cell"):
            fathom.compare(STUDY, [defined(1.0)], out=out)

    def test_a_file_that_changed_since_it_was_loaded_is_refused(self):
        for changed in ("mine.py", "part.py"):
            file = plugin(self.top / changed.replace(".", "_"))
            code = (
                "import sys, pathlib, fathom\n"
                "file = pathlib.Path(sys.argv[1]); sys.path.insert(0, str(file.parent))\n"
                "import mine\n"
                "changed = file.parent / sys.argv[2]\n"
                "changed.write_text(changed.read_text() + '# other\\n')\n"
                "fathom.compare({'dataset': {'type': 'simulated_log'}}, [mine.Mine])\n"
            )
            done = run(code, file, changed)
            self.assertIn("InputError", done.stderr)
            self.assertIn(f"{changed}: has changed since it was loaded", done.stderr)

    def test_what_it_imports_belongs_to_the_study_wherever_it_lies(self):
        words = ("compare", self.study, "--plugin", "mine.py", "--out", self.top / "out")
        for folder in ("a", "b"):
            plugin(self.top / folder)
            (self.top / folder / "unrelated.py").write_text(f"raise RuntimeError  # {folder}\n")
            done = compare(*words, cwd=self.top / folder)
            self.assertEqual(done.returncode, 0, done.stderr)
        plugin(self.top / "b", offset=1.0)
        done = compare(*words, cwd=self.top / "b")
        self.assertEqual(done.returncode, 2)
        self.assertIn("plug-in part.py has changed", done.stderr)

    def test_a_module_of_the_same_name_from_elsewhere_is_refused(self):
        first = plugin(self.top / "a")
        second = plugin(self.top / "b", name="other", offset=5.0)
        done = compare(
            "compare", self.study, "--plugin", first, "--plugin", second, "--out", self.top / "o"
        )
        self.assertEqual(done.returncode, 2)
        self.assertIn("imports 'part'", done.stderr)

    def test_two_threads_may_ask_for_the_first_plugin(self):
        file = plugin(self.top / "a")
        file.write_text("import time; time.sleep(0.3)\n" + file.read_text())
        code = (
            "import threading, fathom\n"
            "found = []\n"
            "ask = lambda: found.append('mine' in fathom.estimators())\n"
            "threads = [threading.Thread(target=ask) for _ in range(2)]\n"
            "[t.start() for t in threads]; [t.join() for t in threads]\n"
            "print(found)\n"
        )
        self.assertEqual(run(code, FATHOM_PLUGIN_PATH=str(file)).stdout.strip(), "[True, True]")

    def test_two_studies_may_read_a_plugin_at_the_same_time(self):
        file = plugin(self.top / "a")
        file.write_text("import time; time.sleep(0.3)\n" + file.read_text())
        code = (
            "import threading, fathom\n"
            "study = {'dataset': {'type': 'simulated_log'}, 'estimators': [{'type': 'mine'}]}\n"
            "found = []\n"
            f"more = dict(plugins=[{str(file)!r}])\n"
            "ask = lambda: found.extend(fathom.compare(study, **more).estimators)\n"
            "threads = [threading.Thread(target=ask) for _ in range(2)]\n"
            "[t.start() for t in threads]; [t.join() for t in threads]\n"
            "print(found)\n"
        )
        self.assertEqual(run(code).stdout.strip(), "['mine', 'mine']")

    def test_an_interrupt_that_an_estimator_raises_is_a_failure(self):
        file = plugin(self.top / "a", update="raise KeyboardInterrupt")
        done = compare("compare", self.study, "--plugin", file, "--out", self.top / "out")
        self.assertEqual(done.returncode, 1, done.stderr)
        runs = (self.top / "out" / "runs.csv").read_text()
        self.assertIn("numerical_failure", runs)
        self.assertNotIn("crashed", runs)
        file.write_text("raise KeyboardInterrupt\n")
        done = compare("list", "estimators", "--plugin", file)
        self.assertNotEqual(done.returncode, -signal.SIGSEGV)


class Inputs(unittest.TestCase):
    def refused(self, text, call):
        with self.assertRaisesRegex(fathom.InputError, text):
            call()

    def test_numbers_are_checked(self):
        skew = [[1, 0.9, 0], [0, 1, 0], [0, 0, 1]]
        log = fathom.MeasurementLog()
        self.refused("start", lambda: fathom.MeasurementLog((numpy.nan, 0, 0)))
        self.refused("symmetric", lambda: log.add_keyframe((1, 0, 0), skew))
        self.refused("symmetric", lambda: fathom.RelativePose(0, 1, (1, 0, 0), skew))
        self.refused("motion", lambda: log.add_keyframe((1, 0, 1j), numpy.eye(3)))
        self.refused("motion", lambda: log.add_keyframe(("1", "0", "0"), numpy.eye(3)))
        camera = {"width": 8, "height": 8, "fx": 8, "fy": 8}
        picture = numpy.zeros((8, 8), numpy.uint8)
        for tilt in ((0, 0, numpy.nan), (0, 0, -1), (numpy.inf, 0, 1)):
            self.refused(
                "tilt_a", lambda: fathom.register(picture, picture, 2, 2, camera, tilt_a=tilt)
            )

    def test_options_are_described_as_they_should_be(self):
        def with_options(given):
            return type("Odd", (misbehaving.Follows,), {"options": given})

        for given in ({"n": 2**40}, {"n": fathom.Option(1, help=None)}, {5: 1}):
            self.refused("option .*type", lambda: fathom.options(with_options(given)))
        self.refused("expected a dict", lambda: fathom.options(with_options(None)))
        self.refused("a list of files", lambda: fathom.estimators(plugins="mine.py"))

    def test_an_option_of_the_name_of_a_keyword(self):
        log = fathom.MeasurementLog()
        log.add_keyframe((1, 0, 0), numpy.eye(3))
        log.add_registration(fathom.RelativePose(0, 1, (1, 0, 0), numpy.eye(3)))
        for how in ({"start": "chordal"}, {"options": {"start": "chordal"}}):
            solution = fathom.solve(log, "sparse_gauss_newton", **how)
            self.assertEqual(solution.outcome, "converged")
        self.refused("start", lambda: fathom.solve(log, "sparse_gauss_newton", start="chordl"))

    def test_measurements_may_be_kept(self):
        kept = []

        class Keeps(fathom.Estimator):
            """keeps what it is given"""

            def __init__(self, setup):
                self.x = [setup.start]

            def pose(self, k):
                return self.x[k]

            def add_keyframe(self, step):
                self.x.append(self.x[-1] + step.motion)

            def update(self, measurements):
                kept.append(measurements)

        log = fathom.MeasurementLog()
        for k in range(1, 50):
            log.add_keyframe((1, 0, 0), numpy.eye(3))
            log.add_registration(fathom.RelativePose(k - 1, k, (k, 0, 0), numpy.eye(3)))
        fathom.replay(log, Keeps, isolation="none")
        del log
        given = [one.registrations[0].motion[0] for one in kept]
        self.assertEqual(given, list(range(1, 50)))


if __name__ == "__main__":
    unittest.main()
