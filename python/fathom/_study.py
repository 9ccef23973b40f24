"""Studies: several estimators, surveys, trials, a sweep."""

import os
import shutil
import tempfile

from . import _fathom
from ._progress import heard_by
from ._results import Results
from ._settings import Asked


def compare(
    study,
    estimators=(),
    *,
    set={},
    plugins=(),
    out=None,
    surveys=None,
    trials=None,
    jobs=None,
    cache=True,
    mosaics=False,
    progress=None,
):
    """Runs a study, as `fathom compare` does, and goes on with one that was stopped.

    study: a YAML file, a folder of pictures, or a dict of the same keys.
    estimators: names, subclasses of fathom.Estimator, or dicts of type, name and options, that
        stand beside those of the study. A study without a list has these; where all are classes,
        it has the known ones, too.
    set: a dict of settings that replace those of the study; a list replaces a list as a whole.
    out: its folder; without one, a temporary folder that goes with the results.
    cache: folder of the registrations that are kept; True: the usual one, None: none.
    progress: True: a bar (of tqdm, where it is there); False: none; None: one where somebody looks,
        at a terminal or in a notebook. A function is called with a dict of done, of, failed, stage,
        step, steps, left_s.
    Returns Results; raises InputError.
    """
    changes = dict(set)
    for key, value in (("surveys", surveys), ("trials", trials), ("jobs", jobs)):
        if value is not None:
            changes[key] = value
    added = [one if isinstance(one, dict) else {"type": one} for one in estimators]
    asked = Asked(study, changes, plugins, "the study", added)
    temporary = tempfile.mkdtemp(prefix="fathom-") if out is None else None
    out = os.path.join(temporary, "study") if out is None else os.fspath(out)
    folder = None if not cache else "" if cache is True else os.fspath(cache)
    try:
        with heard_by(progress) as heard:
            example = _fathom._compare(
                asked.settings, asked.registry, asked.file, out, asked.title, folder, mosaics, heard
            )
        return Results(out, example, temporary)
    except BaseException:
        if temporary:
            shutil.rmtree(temporary, ignore_errors=True)
        raise
