"""One estimator: over a log, or over a data set."""

import os

from . import _fathom
from ._estimator import described
from ._fathom import InputError, MeasurementLog, _Registry
from ._names import shown
from ._progress import heard_by
from ._settings import (
    Asked,
    changes_of,
    files_of,
    is_estimator,
    require_name_or_class,
    settings_of,
)


def _registry_with(estimator, plugins=()):
    """The registry, and the name that the estimator has in it."""
    require_name_or_class(estimator, "estimator")
    _fathom._load_plugins(files_of(plugins))
    registry = _Registry()
    return registry, registry.add(estimator) if is_estimator(estimator) else estimator


def estimators(plugins=()) -> list:
    """Names of the estimators: built in, of FATHOM_PLUGIN_PATH, of these plug-ins and of all
    loaded before."""
    return _registry_with("", plugins)[0].names()


def options(estimator, plugins=()) -> list:
    """The options of an estimator: a dict each of key, type, unit, default, range, help."""
    registry, name = _registry_with(estimator, plugins)
    return registry.options(name)


def solve(
    log,
    estimator="sparse_gauss_newton",
    *,
    mode="auto",
    start=None,
    plugins=(),
    isolation="automatic",
    time_limit_s=None,
    memory_limit_mib=None,
    progress=None,
    options=None,
    **values,
):
    """Gives a log to an estimator: a name, or a subclass of fathom.Estimator.

    mode: 'batch', 'incremental', or 'auto': batch where the estimator can.
    start: N x 3, the initial guess of a batch solve; without one, dead reckoning. A word is the
        estimator's option of that name.
    isolation: 'process', 'none', or 'automatic': what is not built in, and every batch solve,
        has a process of its own, which may take time_limit_s and memory_limit_mib.
    progress: of a solve keyframe by keyframe, as of `compare`; a function is called with a dict of
        stage, step, steps.
    Other keywords, and the dict `options`, are the estimator's options. Returns a Solution; raises
    InputError.
    """
    if not isinstance(log, MeasurementLog):
        raise InputError(f"log: expected a MeasurementLog, as of read_g2o(FILE), got {shown(log)}")
    values = {**(options or {}), **values}
    if isinstance(start, str):
        values["start"], start = start, None
    registry, name = _registry_with(estimator, plugins)
    limits = {"time_limit_s": time_limit_s, "memory_limit_mib": memory_limit_mib}
    given = {key: value for key, value in limits.items() if value is not None}
    how = settings_of({"isolation": isolation, **given}, "solve")
    source = f"the options of {described(estimator)['name'] if is_estimator(estimator) else name}"
    with heard_by(progress) as heard:
        return _fathom._solve(
            log, registry, name, settings_of(values, source), mode, start, how, heard
        )


def replay(log, estimator, **keywords):
    """As solve, keyframe by keyframe."""
    return solve(log, estimator, mode="incremental", **keywords)


def run(
    config, estimator=None, *, set={}, plugins=(), out=None, cache=True, progress=None
):
    """Runs the front end and one estimator over a data set, as `fathom run` does.

    config: a YAML file, a folder of pictures, or a dict of the same keys.
    estimator: a name or a subclass of fathom.Estimator in place of the configuration's.
    set: a dict of settings that replace those of the configuration; a list replaces a list as a
        whole.
    out: folder of the run's files; without one, none are written.
    cache: folder of the registrations that are kept; True: the usual one.
    progress: as of `solve`.
    Returns a Solution.
    """
    if estimator is not None:
        require_name_or_class(estimator, "estimator")
    changes = changes_of(set, **{"estimator.type": estimator})
    asked = Asked(config, changes, plugins, "the configuration")
    folder = None if not cache else "" if cache is True else os.fspath(cache)
    out = os.fspath(out) if out else ""
    with heard_by(progress) as heard:
        return _fathom._run(asked.settings, asked.registry, asked.file, out, folder, heard)
