"""Configurations: a file's path, a dict, or both; all checked by the same code."""

import json
import os
import pathlib
from collections.abc import Iterable, Mapping

from ._estimator import Estimator, described
from ._fathom import InputError, _Registry, _Settings
from ._names import shown

_DEEPEST = 32


def as_yaml(values: dict) -> str:
    """A dict as JSON, which is YAML. None is written as `off`."""
    return json.dumps(as_written(values, ""), ensure_ascii=False)


def settings_of(values: dict, source: str) -> _Settings:
    settings = _Settings()
    settings.put_yaml(as_yaml(values), source)
    return settings


class Asked:
    """What a run or a study is asked for: settings, the registry, the file if it is one."""

    def __init__(self, config, changes, plugins, what, added=()):
        self._what = what
        self.file = ""
        if isinstance(config, dict):
            self.settings = _Settings()
            self.put(config)
        else:
            self.file = os.fspath(config)
            self.settings = _Settings.read(self.file)
        for key, value in _inside(changes):
            if isinstance(value, (list, tuple)):  # replaces a list as a whole
                self.settings.drop_below(f"{key}.")
        self.put(changes)
        self.settings.require_keys(self.file or what)
        self.settings.load_plugins(files_of(plugins))
        self.registry = _Registry()
        parts = [_inside(part) for part in (config, changes, *added)]
        for one in dict.fromkeys(one for part in parts for _, one in part if is_estimator(one)):
            self.registry.add(one)
        self._add(added)

    def _add(self, estimators):
        """To the list of a study."""
        first = self.settings.estimator_count()
        for i, one in enumerate(estimators):
            self.put({f"estimators.{first + i}": one})

    def put(self, values: dict):
        self.settings.put_yaml(as_yaml(values), self._what)

    @property
    def title(self) -> str:
        return pathlib.Path(self.file).stem if self.file else "study"


def listed(estimators) -> list:
    """Estimators to add to those of a study, each a dict. None: none; one may stand alone."""
    if estimators is None:
        return []
    if isinstance(estimators, (str, dict)) or not isinstance(estimators, Iterable):
        estimators = [estimators]
    items = [one if isinstance(one, dict) else {"type": one} for one in estimators]
    if not items:
        raise InputError("estimators: is empty; without it a study has its own, or all known ones")
    for one in items:
        require_name_or_class(one.get("type"), "estimators")
    return items


def changes_of(given, **more) -> dict:
    """The settings `set`, and those of others that are not None."""
    if not isinstance(given, Mapping):
        raise InputError(f"set: expected a dict as {{'seed': 3}}, got {shown(given)}")
    return {**given, **{key: value for key, value in more.items() if value is not None}}


def require_name_or_class(estimator, what):
    if not (isinstance(estimator, str) or is_estimator(estimator)):
        raise InputError(
            f"{what}: expected a name or a subclass of fathom.Estimator, got {shown(estimator)}"
        )


def files_of(plugins) -> list:
    if isinstance(plugins, (str, os.PathLike)):
        raise InputError("plugins: expected a list of files, [FILE]")
    return [os.fspath(file) for file in plugins]


def is_estimator(value) -> bool:
    return isinstance(value, type) and issubclass(value, Estimator)


def _inside(value, key="", depth=0):
    """Key and value of it and of all that it holds; items of a list have the list's key."""
    _require_depth(depth, key)
    yield key, value
    if isinstance(value, dict):
        for name, one in value.items():
            yield from _inside(one, f"{key}.{name}".lstrip("."), depth + 1)
    elif isinstance(value, (list, tuple)):
        for one in value:
            yield from _inside(one, key, depth + 1)


def _require_depth(depth, key):
    """As of a file (core/yaml_limits.hpp). What holds itself has no end."""
    if depth > _DEEPEST:
        raise InputError(
            f"{key}: is nested too deeply, or in itself; the limit of lists and dicts in each "
            f"other is {_DEEPEST}"
        )


def as_written(value, key, depth=0):
    """A value of a key as files have it: of None `off`, of an estimator its name."""
    _require_depth(depth, key)
    if value is None:
        return "off"
    if isinstance(value, (bool, int, str)):
        return value
    if isinstance(value, float):
        return value if abs(value) < float("inf") else str(value)
    if is_estimator(value):
        return described(value)["name"]
    if isinstance(value, dict):
        inner = {str(name): one for name, one in value.items()}
        return {
            name: as_written(one, f"{key}.{name}".lstrip("."), depth + 1)
            for name, one in inner.items()
        }
    if hasattr(value, "tolist"):  # of numpy
        return as_written(value.tolist(), key, depth + 1)
    if isinstance(value, (list, tuple)):
        return [as_written(one, key, depth + 1) for one in value]
    if isinstance(value, os.PathLike):
        return os.fspath(value)
    raise InputError(f"{key}: cannot use a value of type {type(value).__name__}")
