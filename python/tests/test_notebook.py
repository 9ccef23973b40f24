"""The notebooks of the examples, cell by cell."""

import contextlib
import glob
import io
import json
import os
import sys
import types
import unittest

HERE = os.path.dirname(os.path.abspath(__file__))
FOLDER = os.path.join(HERE, "..", "..", "examples", "notebook")


class Image:
    """In place of IPython's: the picture has to be there."""

    def __init__(self, path, width=None):
        with open(path, "rb") as file:
            if file.read(4) != b"\x89PNG":
                raise ValueError(f"{path} is no PNG")


def cells_of(path):
    with open(path) as file:
        cells = json.load(file)["cells"]
    return ["".join(cell["source"]) for cell in cells if cell["cell_type"] == "code"]


class Notebooks(unittest.TestCase):
    def test_every_cell_runs(self):
        try:
            import pandas  # noqa: F401
        except ImportError:
            self.skipTest("no pandas; 'scripts/setup.sh python' installs it")
        display = types.ModuleType("IPython.display")
        display.Image = Image
        sys.modules.setdefault("IPython", types.ModuleType("IPython"))
        sys.modules["IPython.display"] = display
        notebooks = glob.glob(os.path.join(FOLDER, "*.ipynb"))
        self.assertTrue(notebooks)
        for notebook in notebooks:
            names = {"__name__": "__main__"}
            printed = io.StringIO()
            with contextlib.redirect_stdout(printed):
                for cell in cells_of(notebook):
                    exec(compile(cell, notebook, "exec"), names)
            self.assertIn("dead_reckoner", printed.getvalue())
            self.assertIn("did you mean 'trials'", printed.getvalue())


if __name__ == "__main__":
    unittest.main()
