"""Estimators in Python on the command line: a file is a plug-in, and belongs to its study."""

import os
import re
import subprocess
import sys
import tempfile
import unittest

import fathom
import numpy

HERE = os.path.dirname(os.path.abspath(__file__))
EXAMPLES = os.path.join(HERE, "..", "..", "examples", "python")

# Clauses of absolute measurements and an uncertain start, which the example refuses; of holes, and
# of numbers beyond doubles.
NOT_IN_SIXTY_LINES = set(
    "nan_absolute beyond_doubles uncertain_zero uncertain_map exact_absolute without_information "
    "linear_case nanometre_fixes rotated_absolute far_absolute repeatable_absolute "
    "least_squares_near holes_and_loops holes_and_fixes".split()
)


class CommandLine(unittest.TestCase):
    def fathom(self, *words, path=None):
        environment = {key: value for key, value in os.environ.items() if key != "PYTHONPATH"}
        environment.update({"FATHOM_PLUGIN_PATH": path} if path else {})
        return subprocess.run(
            [os.environ["FATHOM_BINARY"], *words], capture_output=True, text=True, env=environment
        )

    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)

    def file(self, name, text):
        path = os.path.join(self.folder.name, name)
        with open(path, "w") as file:
            file.write(text)
        return path

    def test_a_file_is_a_plug_in(self):
        study = self.file(
            "study.yaml",
            "dataset: {type: simulated_log}\n"
            f"plugins: [{EXAMPLES}/ekf.py]\n"
            "estimators: [{type: ekf}, {type: numpy_ekf}]\n",
        )
        out = os.path.join(self.folder.name, "out")
        ended = self.fathom("compare", study, "--out", out, "--quiet")
        self.assertEqual((ended.returncode, ended.stderr), (0, ""))
        results = fathom.open_results(out)
        for name in ("mean_position_error_m", "anees", "chi2"):
            ours, theirs = results.metric(name, "numpy_ekf"), results.metric(name, "ekf")
            self.assertEqual(len(ours), 1)
            numpy.testing.assert_allclose(ours, theirs, rtol=1e-7)
        self.assertGreater(results.metric("memory_bytes", "numpy_ekf")[0], 0)

    def test_its_other_files_belong_to_the_study(self):
        self.file("part.py", "GATE = 5.0\n")
        plugin = self.file(
            "mine.py",
            "import part\nimport misbehaving\n"
            "class Mine(misbehaving.Follows):\n    pass\n",
        )
        study = {"dataset": {"type": "simulated_log"}, "estimators": [{"type": "mine"}]}
        out = os.path.join(self.folder.name, "out")
        code = (
            "import fathom, sys; sys.path.append(sys.argv[1]); "
            f"print(len(fathom.compare({study!r}, plugins=[{plugin!r}], out={out!r}).rows))"
        )

        def run():
            return subprocess.run(
                [sys.executable, "-c", code, HERE], capture_output=True, text=True
            )

        self.assertEqual(run().stdout.strip(), "2")
        self.assertEqual(run().stdout.strip(), "2")
        self.file("part.py", "GATE = 6.0\n")
        self.assertIn("part.py", run().stderr)

    def test_conformance_of_a_file(self):
        ended = self.fathom("conformance", "numpy_ekf", "--plugin", EXAMPLES + "/ekf.py")
        broken = re.findall(r"breaks (\w+)", ended.stdout)
        self.assertTrue(set(broken) <= NOT_IN_SIXTY_LINES, ended.stdout)
        self.assertIn("numpy_ekf: keeps ", ended.stdout)

    def test_a_common_base_is_no_estimator(self):
        text = (
            "import fathom\nclass Common(fathom.Estimator):\n    __init__ = pose = len\n"
            "class Mine(Common):\n    add_keyframe = update = len\n"
        )
        path = self.file("common.py", text)
        ended = self.fathom("list", "estimators", "--plugin", path)
        self.assertEqual(ended.returncode, 0, ended.stderr)
        self.assertIn("mine", ended.stdout)
        self.assertNotIn("common ", ended.stdout)

    def test_refusals_are_one_line(self):
        cases = [
            ("import nothing_of_this_name\n", "ModuleNotFoundError"),
            ("def broken(:\n", "SyntaxError"),
            ("x = 1\n", "defines no subclass of fathom.Estimator"),
            ("import sys\nsys.exit(1)\n", "SystemExit: 1"),
            (
                "import fathom\nclass Ekf(fathom.Estimator):\n"
                "    __init__ = pose = add_keyframe = update = len\n",
                "estimator 'ekf': the name is taken",
            ),
            (
                "import fathom\nclass Mine(fathom.Estimator):\n    pose = len\n",
                "Mine: has no __init__, add_keyframe, update",
            ),
        ]
        for text, expected in cases:
            with self.subTest(expected):
                path = self.file("mine.py", text)
                ended = self.fathom("list", "estimators", "--plugin", path)
                self.assertEqual(ended.returncode, 2, ended.stderr)
                self.assertEqual(ended.stderr.count("\n"), 1, ended.stderr)
                self.assertIn(expected, ended.stderr)
                self.assertIn("mine.py", ended.stderr)

    def test_of_the_search_path(self):
        ended = self.fathom("list", "estimators", path=EXAMPLES + "/ekf.py")
        self.assertIn("numpy_ekf: ", ended.stdout)


if __name__ == "__main__":
    unittest.main()
