"""Studies: several estimators, surveys, trials, a sweep."""

import os
import shutil
import tempfile
import weakref

import numpy

from . import _fathom
from ._settings import Asked


class Results:
    """The results of a study.

    rows: a dict for every run: cell, the values of the sweep's axes, survey, trial, estimator,
        outcome, fault, and its metrics (docs/studies.md); what is not known is absent.
    estimators: their names; dead reckoning has rows beside them.
    folder: where report.html, tables and figures are.
    example: by estimator the Solution of the first trial, where the study was run here.
    """

    def __init__(self, folder, example=()):
        self._store = _fathom._Store(str(folder))
        self.folder = str(folder)
        self.rows = self._store.rows()
        self.estimators = self._store.estimators()
        self.configuration = dict(self._store.configuration())
        self.example = {one.estimator: one for one in example}

    def __repr__(self):
        return f"<fathom.Results of {len(self.rows)} runs, {', '.join(self.estimators)}>"

    def metric(self, name, estimator, cell=0):
        """A metric over the runs of a cell that have it, as an array."""
        return numpy.array(
            [
                row[name]
                for row in self.rows
                if row["estimator"] == estimator and row["cell"] == cell and name in row
            ]
        )

    def series(self, name, estimator, cell=0, survey=0, trial=0):
        """A series of one run (docs/formats.md), or None."""
        return self._store.series(name, estimator, cell, survey, trial)

    def table(self) -> str:
        """The table that `fathom compare` prints."""
        return self._store.table()

    def to_frame(self):
        """The rows as a data frame of pandas."""
        import pandas

        return pandas.DataFrame(self.rows)


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
    set: a dict of settings that replace those of the study.
    out: its folder; without one, a temporary folder that goes with the results.
    cache: folder of the registrations that are kept; True: the usual one, None: none.
    progress: is called with a dict of done, of, failed, stage, step, steps, left_s.
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
        example = _fathom._compare(
            asked.settings, asked.registry, asked.file, out, asked.title, folder, mosaics, progress
        )
        results = Results(out, example)
    except BaseException:
        if temporary:
            shutil.rmtree(temporary, ignore_errors=True)
        raise
    if temporary:
        weakref.finalize(results, shutil.rmtree, temporary, ignore_errors=True)
    return results


def open_results(folder) -> Results:
    """The results in a study's folder."""
    return Results(os.fspath(folder))
