"""Estimators in Python: the base class, and what is found out about a subclass."""

import importlib.util
import inspect
import pathlib
import re
import sys
import warnings
from dataclasses import dataclass
from typing import Any, Optional, Sequence

from ._fathom import InputError, _suggestion
from ._sources import code_of, note_definition, require_own_imports

_REQUIRED = ("__init__", "pose", "add_keyframe", "update")


@dataclass(frozen=True)
class Option:
    """An option of an estimator. Its type is that of the default; None is a number that is off."""

    default: Any
    help: str = ""
    unit: str = ""
    at_least: Optional[float] = None
    at_most: Optional[float] = None
    choices: Sequence[str] = ()


@dataclass
class UpdateReport:
    """How an update or a solve ended.

    outcome: 'converged', 'iteration_limit', 'diverged' or 'numerical_failure'.
    iterations: linearisations made.
    loops: of an update, a decision for each registration given, in the order given: 'used',
        'rejected' or 'lost', or a tuple of one of these and the normalised innovation squared.
        None: all used, or all lost where the outcome is a failure. Of a failure none is used, and
        else none is lost. Of a solve, None.
    absolute: the same for each absolute measurement.
    """

    outcome: str = "converged"
    iterations: int = 0
    loops: Optional[list] = None
    absolute: Optional[list] = None


class Estimator:
    """A SLAM back end. A subclass writes __init__, pose, add_keyframe and update, and has:

    name: in studies; a-z, 0-9 and _. Without one, the name of the class in small letters.
    help: one line; without one, the first line of the docstring.
    options: a dict of Option, or of plain defaults, by name: keyword arguments of __init__.
    can_batch: whether finish() solves the whole log (setup.mode is then 'batch' or 'incremental').

    The harness calls, in this order:

        update(measurements)   of keyframe 0, if something absolute is measured of it
        add_keyframe(step)     once per keyframe, in order
        update(measurements)   with all that is measured of the newest keyframe, if anything is
        finish(start)          once, at the end of a log that is solved as a batch

    A call that raises, or returns what it should not, ends the run with the outcome
    'numerical_failure' and the exception as its fault. `fathom conformance --plugin FILE` tells
    whether the contract is kept.
    """

    name = ""
    help = ""
    options: dict = {}
    can_batch = False

    def __init_subclass__(cls, **arguments):
        super().__init_subclass__(**arguments)
        note_definition(cls)

    def __init__(self, setup, **options):
        """Keyframe 0 is there from the beginning, at setup.start."""
        raise NotImplementedError("an estimator has an __init__(self, setup, **options)")

    def pose(self, k: int):
        """x (m), y (m), theta (rad) of keyframe k, world axes."""
        raise NotImplementedError("an estimator has a pose(self, k)")

    def add_keyframe(self, step):
        """Appends the next keyframe by its motion (RelativePose) from the newest one."""
        raise NotImplementedError("an estimator has an add_keyframe(self, step)")

    def update(self, measurements):
        """Uses what was measured of the newest keyframe. Returns an UpdateReport, or None: done."""
        raise NotImplementedError("an estimator has an update(self, measurements)")

    def joint_covariance(self, keyframes: list):
        """3m x 3m covariance of (x, y, theta) of m keyframes, world axes, in the order given;
        keyframes may repeat. None where it is not known."""
        return None

    def finish(self, start):
        """Solves the log from `start`, N x 3, or from dead reckoning where that is None. Returns
        an UpdateReport or None."""
        return None

    def estimates_shared_errors(self) -> bool:
        """Whether what registrations of a picture share (RelativePose.shared) is estimated beside
        the poses: the cost that is minimised is then that of both."""
        return False

    def size(self) -> int:
        """Keyframes so far. Need not be written: they are counted."""
        raise NotImplementedError

    def loss(self, chi2: float, rank: int) -> float:
        """What a measurement counts in the cost that is minimised; the identity without a loss."""
        return chi2

    def loop_weights(self):
        """What every registration given so far weighs, in order; empty: 1 for all used."""
        return []

    def absolute_weights(self):
        """The same of every absolute measurement."""
        return []


_METHODS = [name for name, method in vars(Estimator).items() if inspect.isfunction(method)]


def _missing(cls):
    """Methods that are those of the base class."""
    return [name for name in _METHODS if getattr(cls, name) is getattr(Estimator, name)]


def _needed(cls):
    """Of these the ones that a subclass writes."""
    return [name for name in _REQUIRED if name in _missing(cls)]


def _require_methods(cls):
    """Those that a subclass writes; and warns of what looks like another, misspelt."""
    missing = _missing(cls)
    slips = [
        f"{cls.__qualname__}: has a method '{name}'{near}"
        for name in dir(cls)
        if not (name.startswith("_") or hasattr(Estimator, name)) and callable(getattr(cls, name))
        # 'poses' beside 'pose' is one of its own, however near to 'loss'.
        if (near := _suggestion(name, _METHODS)) == _suggestion(name, missing)
        if near
    ]
    if needed := _needed(cls):
        raise InputError("; ".join([f"{cls.__qualname__}: has no {', '.join(needed)}", *slips]))
    for slip in slips:
        warnings.warn(slip)


def described(cls) -> dict:
    """What the registry is told of a subclass of Estimator."""
    if not (isinstance(cls, type) and issubclass(cls, Estimator)):
        raise InputError(f"{cls!r} is no subclass of fathom.Estimator")
    _require_methods(cls)
    if not isinstance(cls.options, dict):
        raise InputError(f"{cls.__qualname__}.options: expected a dict")
    for what in ("name", "help"):
        if not isinstance(getattr(cls, what), str):
            raise InputError(f"{cls.__qualname__}.{what}: expected text")
    lines = (cls.help or (cls.__doc__ if cls.__doc__ != Estimator.__doc__ else "") or "").strip()
    options = {
        key: value if isinstance(value, Option) else Option(value)
        for key, value in cls.options.items()
    }
    place, code = code_of(cls)
    return {
        "name": cls.name or _snake(cls.__name__),
        "help": lines.splitlines()[0] if lines else "Written in Python",
        "can_batch": bool(cls.can_batch),
        "options": options,
        "place": place,
        "code": code,
    }


def classes_of(file: str) -> list:
    """The subclasses of Estimator that a file defines, but for incomplete ones that others of it
    complete; its folder is searched for its imports."""
    path = pathlib.Path(file).resolve()
    if str(path.parent) not in sys.path:
        sys.path.insert(0, str(path.parent))
    name = "fathom_plugin_" + re.sub(r"\W", "_", path.stem)
    spec = importlib.util.spec_from_file_location(name, path)
    module = importlib.util.module_from_spec(spec)
    sys.modules[name] = module
    spec.loader.exec_module(module)
    require_own_imports(path)
    classes = [
        value
        for key, value in vars(module).items()
        if isinstance(value, type)
        and issubclass(value, Estimator)
        and value.__module__ == name
        and not key.startswith("_")
    ]
    bases = {base for one in classes for base in one.__mro__[1:]}
    return [one for one in classes if not (one in bases and _needed(one))]


def _snake(name: str) -> str:
    return re.sub(r"(?<=[a-z0-9])(?=[A-Z])", "_", name).lower()
