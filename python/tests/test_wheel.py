"""The package as pip installs it, out of the build that is tested."""

import base64
import hashlib
import importlib.util
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest
import venv
import zipfile

import fathom

TOP = pathlib.Path(__file__).resolve().parents[2]
USED = """
import importlib.metadata, numpy, fathom
log = fathom.MeasurementLog()
log.add_keyframe((1, 0, 0), numpy.eye(3))
print(fathom.__file__, fathom.__version__, importlib.metadata.version("fathom"))
print(fathom.solve(log).outcome)
"""
HAS_PIP = importlib.util.find_spec("pip") is not None


@unittest.skipUnless(HAS_PIP, "no pip; 'apt-get install python3-pip' has it")
class Wheel(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = pathlib.Path(temporary.name)

    def run_in(self, *command, **environment):
        inherited = {key: value for key, value in os.environ.items() if key != "PYTHONPATH"}
        return subprocess.run(
            [str(word) for word in command],
            capture_output=True,
            text=True,
            cwd=self.folder,
            env={**inherited, **environment},
        )

    def pip(self, python, *words, **environment):
        return self.run_in(
            python, "-m", "pip", *words, "--no-index", "--no-cache-dir", **environment
        )

    def wheel(self, *words, **environment):
        """Made in an isolated build, as pip does by default: it needs no index for that."""
        asked = ("wheel", "--no-deps", "-w", self.folder, *words, TOP)
        return self.pip(sys.executable, *asked, **environment)

    def test_an_environment_of_its_own(self):
        # Its numpy and pip are the system's.
        venv.create(self.folder / "venv", system_site_packages=True)
        python = self.folder / "venv" / "bin" / "python"
        done = self.pip(python, "install", "--no-build-isolation", TOP)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        used = self.run_in(python, "-c", USED)
        self.assertEqual(used.returncode, 0, used.stderr)
        file, version, installed, outcome = used.stdout.split()
        self.assertTrue(file.startswith(str(self.folder)), file)
        self.assertEqual((version, installed), (fathom.__version__, fathom.__version__))
        self.assertEqual(outcome, "converged")
        ours, theirs = pathlib.Path(fathom.__file__).parent, pathlib.Path(file).parent
        for name in ("py.typed", "_fathom.pyi", "__init__.py"):
            self.assertEqual((ours / name).read_text(), (theirs / name).read_text())

    def test_the_record_is_of_its_files(self):
        done = self.wheel()
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        (path,) = self.folder.glob("*.whl")
        with zipfile.ZipFile(path) as wheel:
            (record,) = [name for name in wheel.namelist() if name.endswith("/RECORD")]
            lines = [line.split(",") for line in wheel.read(record).decode().splitlines()]
            self.assertEqual([name for name, *_ in lines], wheel.namelist())
            for name, digest, size in lines[:-1]:
                content = wheel.read(name)
                found = base64.urlsafe_b64encode(hashlib.sha256(content).digest()).decode()
                self.assertEqual((digest, size), (f"sha256={found.rstrip('=')}", str(len(content))))
            self.assertFalse([name for name in wheel.namelist() if "__pycache__" in name])

    def test_what_cmake_is_asked_for(self):
        # In place of CMake: it says how it was called, and fails.
        cmake = self.folder / "cmake"
        cmake.write_text('#!/bin/sh\necho "path [$PYTHONPATH] $*"\nexit 1\n')
        cmake.chmod(0o755)
        path = f"{self.folder}:{os.environ['PATH']}"
        done = self.wheel("-v", FATHOM_BUILD_DIR="", PATH=path)
        said = done.stdout + done.stderr
        # A path of pip's own would hide the system's numpy from CMake.
        self.assertIn("path [] --preset release -B ", said)
        self.assertIn(f"-DPython3_EXECUTABLE={os.path.realpath(sys.executable)}", said)
        self.assertIn("fathom: error: 'cmake --preset release", said)
        self.assertNotIn("Traceback", said)

    def test_a_build_folder_without_the_module(self):
        done = self.wheel(FATHOM_BUILD_DIR="/nowhere")
        self.assertIn("error: FATHOM_BUILD_DIR: expected _fathom", done.stdout + done.stderr)
        self.assertNotIn("Traceback", done.stdout + done.stderr)


if __name__ == "__main__":
    unittest.main()
