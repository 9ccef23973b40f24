"""Studies: several estimators, surveys, trials, a sweep."""

import os
import shutil
import tempfile

from . import _fathom
from ._progress import heard_by
from ._results import Results
from ._settings import Asked, changes_of, listed


def compare(
    study,
    estimators=None,
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
    estimators: a list of names, subclasses of fathom.Estimator, or dicts of type, name and
        options, or one of these. They stand beside those that the study lists; if it lists none,
        they are all that it has. None: those of the study, or all that are known.
    set: a dict of settings that replace those of the study; a list replaces a list as a whole.
    out: its folder; without one, a temporary folder that goes with the results.
    cache: folder of the registrations that are kept; True: the usual one, None: none.
    progress: True: a bar (of tqdm, where it is there); False: none; None: one where somebody looks,
        at a terminal or in a notebook. A function is called with a dict of done, of, failed, stage,
        step, steps, left_s.
    Returns Results; raises InputError.
    """
    changes = changes_of(set, surveys=surveys, trials=trials, jobs=jobs)
    asked = Asked(study, changes, plugins, "the study", listed(estimators))
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
