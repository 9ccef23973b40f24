"""The stubs say what the extension has, and nothing else; whatever is public has a docstring."""

import ast
import inspect
import os
import unittest

import fathom
from fathom import _fathom

STUB = os.path.join(os.path.dirname(fathom.__file__), "_fathom.pyi")
OF_EVERY_OBJECT = set(dir(object)) | {"__module__", "__dict__", "__weakref__", "__annotations__"}
OF_EVERY_OBJECT |= {"__getattr__"}  # to a type checker every name would be one
OF_EXCEPTIONS = set(dir(ValueError))


def names_of_the_stub():
    with open(STUB) as file:
        tree = ast.parse(file.read())
    names = {}
    for node in tree.body:
        if isinstance(node, ast.ClassDef):
            names[node.name] = {n.name for n in node.body if isinstance(n, ast.FunctionDef)}
        elif isinstance(node, ast.FunctionDef):
            names[node.name] = None
        elif isinstance(node, ast.AnnAssign):
            names[node.target.id] = None
    return names


def names_of_the_module():
    names = {}
    for name, value in vars(_fathom).items():
        if name.startswith("__"):
            continue
        own = set(dir(value)) - OF_EVERY_OBJECT - OF_EXCEPTIONS if inspect.isclass(value) else None
        names[name] = {n for n in own if not n.startswith("_pybind")} if own is not None else None
    return names


class Stubs(unittest.TestCase):
    def test_the_version_is_that_of_the_build(self):
        lists = os.path.join(os.path.dirname(__file__), "..", "..", "CMakeLists.txt")
        with open(lists) as file:
            self.assertIn(f"project(fathom VERSION {fathom.__version__} ", file.read())

    def test_are_complete(self):
        stub, module = names_of_the_stub(), names_of_the_module()
        self.assertEqual(set(stub), set(module))
        for name, members in module.items():
            if members is not None:
                self.assertEqual(stub[name] - {"__init__"}, members, name)

    def test_public_names_have_docstrings(self):
        for name in fathom.__all__:
            value = getattr(fathom, name)
            self.assertTrue(inspect.getdoc(value), name)
            for member, of in vars(value).items() if inspect.isclass(value) else ():
                if callable(of) and not member.startswith("_") and name != "InputError":
                    self.assertTrue(inspect.getdoc(of), f"{name}.{member}")


if __name__ == "__main__":
    unittest.main()
