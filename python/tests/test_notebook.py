"""The notebooks of the examples, cell by cell, and the texts that are stored as their outputs.

    test_notebook.py --write    stores what they give now
"""

import ast
import contextlib
import glob
import importlib.util
import io
import json
import os
import sys
import types
import unittest

HERE = os.path.dirname(os.path.abspath(__file__))
FOLDER = os.path.join(HERE, "..", "..", "examples", "notebook")
NEEDS = {".plot(": "matplotlib", "to_frame(": "pandas"}


class Image:
    """In place of IPython's: the picture has to be there."""

    def __init__(self, path, width=None):
        with open(path, "rb") as file:
            if file.read(4) != b"\x89PNG":
                raise ValueError(f"{path} is no PNG")


def notebooks():
    for path in sorted(glob.glob(os.path.join(FOLDER, "*.ipynb"))):
        with open(path, encoding="utf-8") as file:
            yield path, json.load(file)


def missing_of(source):
    """The package that a cell needs and that is not there, or None."""
    for part, package in NEEDS.items():
        if part in source and importlib.util.find_spec(package) is None:
            return package
    return None


def run(source, names):
    """What a cell prints, and the value of its last expression."""
    tree = ast.parse(source)
    last = tree.body.pop() if isinstance(tree.body[-1], ast.Expr) else None
    printed, value = io.StringIO(), None
    with contextlib.redirect_stdout(printed):
        exec(compile(tree, "cell", "exec"), names)
        if last is not None:
            value = eval(compile(ast.Expression(last.value), "cell", "eval"), names)
    return printed.getvalue(), value


def outputs_of(printed, value):
    """As the format of notebooks has them: texts alone, as pictures would be large."""
    outputs = []
    if printed:
        lines = printed.splitlines(True)
        outputs.append({"name": "stdout", "output_type": "stream", "text": lines})
    if value is not None and not isinstance(value, Image):
        data = {"text/plain": repr(value).splitlines(True)}
        outputs.append({"data": data, "execution_count": None, "metadata": {},
                        "output_type": "execute_result"})
    return outputs


def prepare():
    display = types.ModuleType("IPython.display")
    display.Image = Image
    ipython = types.ModuleType("IPython")
    ipython.get_ipython = lambda: None  # matplotlib asks
    sys.modules.setdefault("IPython", ipython)
    sys.modules["IPython.display"] = display
    if importlib.util.find_spec("matplotlib") is not None:
        import matplotlib

        matplotlib.use("Agg")


class Notebooks(unittest.TestCase):
    def test_every_cell_runs_and_gives_what_is_stored(self):
        prepare()
        found = list(notebooks())
        self.assertTrue(found)
        for path, notebook in found:
            names = {"__name__": "__main__"}
            for cell in notebook["cells"]:
                source = "".join(cell["source"])
                if cell["cell_type"] != "code":
                    continue
                with self.subTest(source[:60]):
                    missing = missing_of(source)
                    if missing:
                        self.skipTest(f"no {missing}; 'apt-get install python3-{missing}' has it")
                    printed, value = run(source, names)
                    self.assertEqual(outputs_of(printed, value), cell["outputs"])
                    if hasattr(value, "_repr_html_"):
                        self.assertIn("<table", value._repr_html_())


def write():
    prepare()
    for path, notebook in notebooks():
        names = {"__name__": "__main__"}
        for cell in notebook["cells"]:
            if cell["cell_type"] == "code":
                cell["outputs"] = outputs_of(*run("".join(cell["source"]), names))
        with open(path, "w", encoding="utf-8") as file:
            file.write(json.dumps(notebook, indent=1, ensure_ascii=False) + "\n")


if __name__ == "__main__":
    write() if sys.argv[1:] == ["--write"] else unittest.main()
