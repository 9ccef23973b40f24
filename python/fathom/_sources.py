"""What code an estimator in Python is: the content of its file and of its imports beside it."""

import ast
import hashlib
import inspect
import os
import pathlib
import sys
import uuid
import weakref

from ._fathom import InputError

_loaded = {}  # file: hash of its content when a class of it, or of one that imports it, was defined
_of_no_file = weakref.WeakKeyDictionary()  # class: a name that no other has


def note_definition(cls):
    """Keeps what the sources of a class are now, as it is defined: they may change later, while
    what was loaded stays."""
    file = _file_of(cls)
    if file is None:
        return
    for source in sources_of(file).values():
        if source == file:
            _loaded[source] = _hash(source)
        else:
            _loaded.setdefault(source, _hash(source))


def code_of(cls):
    """The place of a class, and names and hashes of what a study must have again to go on. A class
    without a file, as of a notebook, is one that no other session has, nor this one when its cell
    has run again: what else the cells define cannot be told."""
    file = _file_of(cls)
    if file is None:
        name = f"{cls.__module__}.{cls.__qualname__}"
        return name, [(cls.__qualname__, _of_no_file.setdefault(cls, uuid.uuid4().hex))]
    code = []
    for name, source in sorted(sources_of(file).items()):
        content = _hash(source)
        if _loaded.setdefault(source, content) != content:
            raise InputError(f"{source}: has changed since it was loaded; start Python again")
        code.append((name, content))
    return str(file), code


def sources_of(file: pathlib.Path) -> dict:
    """The file and, by their names from its folder (of a module in a package, from the folder of
    the package), those of that folder that it imports, and that these import."""
    root = file.parent
    while (root / "__init__.py").is_file():
        root = root.parent
    found = {}
    waiting = [file]
    while waiting:
        source = waiting.pop()
        name = source.relative_to(root).as_posix()
        if name not in found:
            found[name] = source
            waiting += _imports_of(source, root)
    return found


def require_own_imports(file: pathlib.Path):
    """Refuses a module that was taken from elsewhere, as one of its name was loaded before."""
    for name in sources_of(file):
        module = sys.modules.get(name.removesuffix("/__init__.py").removesuffix(".py"))
        place = getattr(module, "__file__", None)
        if place and pathlib.Path(place).resolve() != (file.parent / name).resolve():
            raise InputError(f"imports '{module.__name__}', but {place} of the same name is loaded")


def _file_of(cls):
    try:
        file = pathlib.Path(inspect.getfile(cls)).resolve()
    except (TypeError, OSError):
        return None
    if not file.is_file() or file.suffix != ".py":
        return None
    # The module's file is not the class's where its code was typed or made.
    made_in = {one.__code__.co_filename for one in vars(cls).values() if inspect.isfunction(one)}
    return file if not made_in or str(file) in map(os.path.realpath, made_in) else None


def _hash(file: pathlib.Path) -> str:
    return hashlib.sha256(file.read_bytes()).hexdigest()


def _imports_of(source: pathlib.Path, root: pathlib.Path) -> list:
    try:
        tree = ast.parse(source.read_bytes())
    except SyntaxError:
        return []
    files = []
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            files += [file for one in node.names for file in _files_of(root, one.name)]
        elif isinstance(node, ast.ImportFrom):
            base = source.parents[node.level - 1] if node.level else root
            for one in node.names:
                files += _files_of(base, ".".join(filter(None, (node.module, one.name))))
    return files


def _files_of(base: pathlib.Path, dotted: str) -> list:
    """Of a.b.c: a, a.b and a.b.c, each as a module or a package, as far as they are there."""
    files = []
    for part in dotted.split("."):
        base = base / part
        either = (base.with_name(part + ".py"), base / "__init__.py")
        files += [one for one in either if one.is_file()]
    return [file.resolve() for file in files]
