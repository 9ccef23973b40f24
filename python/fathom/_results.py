"""The results of a study: rows, metrics, series, by name."""

import itertools
import os
import shutil
import weakref

import numpy

from . import _display, _fathom, _frames, _plot
from ._fathom import InputError
from ._names import DEAD_RECKONING, Named, known, number_or_text, unknown
from ._settings import as_written


class Results:
    """The results of a study.

    rows: a dict for every run, failed ones too: cell, the values of the sweep's axes, survey,
        trial, estimator, outcome, fault, and its metrics (docs/studies.md); what is not known is
        absent.
    estimators: their names; dead reckoning has rows beside them.
    axes: the sweep: by the name of an axis its values, as text.
    cells: by the number of a cell the value on every axis.
    folder: where report.html, tables and figures are.
    example: by estimator the Solution of the first trial, where the study was run here.

    A cell is given by its number, or by a dict of axes and values that fits one cell alone. A name
    that is not there raises InputError, which is a KeyError, too, with the nearest one. As a
    context manager, results are closed at its end.
    """

    def __init__(self, folder, example=(), temporary=None):
        self._store = _fathom._Store(str(folder))
        self.folder = str(folder)
        self.title = self._store.title()
        self.rows = [Named("key of a row", row) for row in self._store.rows()]
        self.estimators = self._store.estimators()
        self.axes = Named("axis of the sweep", self._store.axes())
        self.cells = [dict(zip(self.axes, each)) for each in itertools.product(*self.axes.values())]
        self._tabled = self._store.metrics()
        self._by_place = {}  # rows by estimator and cell
        self._done_by_place = {}  # those that did not fail
        self._failed = self._store.failed()
        for row, failed in zip(self.rows, self._failed):
            place = row["estimator"], row["cell"]
            self._by_place.setdefault(place, []).append(row)
            if not failed:
                self._done_by_place.setdefault(place, []).append(row)
        # As the table has them, by estimator and cell: runs, those done, and their means.
        self._means = {(name, cell): means for name, cell, *means in self._store.means()}
        self.configuration = Named("key", self._store.configuration())
        self.example = Named("estimator", {one.estimator: one for one in example})
        self._removal = lambda: None
        if temporary:
            self._removal = weakref.finalize(self, _remove, temporary, os.getpid())

    def __enter__(self):
        return self

    def __exit__(self, *error):
        self.close()

    def close(self):
        """Lets go of the store, and removes a folder that is a temporary one. Rows and metrics
        stay; series, tables, intervals and differences can no longer be read."""
        self._store = None
        self._removal()

    def metric(self, name, estimator, cell=0, *, failed=False):
        """A metric over the runs of a cell that have it, as an array, by survey and trial; empty
        where it is known of none of them. Runs that failed have no part in it, as in the table,
        unless `failed`: what they say of themselves is no estimate. Arrays of two estimators may
        be of other trials: `difference` pairs them."""
        self._require_metric(name)
        rows = self._rows_of(estimator, cell)
        if not failed:
            rows = self._done_by_place.get((estimator, self.cell(cell)), [])
        return numpy.array([row[name] for row in rows if name in row])

    def interval(self, metric, estimator, cell=0):
        """(low, high), 95 %, of the mean of a metric, as the table has it: over the runs that were
        done, of several surveys over the surveys. None of fewer than two draws."""
        self._require_metric(metric)
        known("estimator", estimator, self._names())
        return self._open().interval(metric, estimator, self.cell(cell))

    def difference(self, metric, a, b, cell=0):
        """Of a metric of estimator a minus that of b, as the table has it: over the trials that
        both did, of several surveys over the surveys' mean differences. A dict: count and over
        ('surveys' or 'trials': what is tested), trials, mean, interval (95 %), p_value (Wilcoxon's
        signed-rank test, not adjusted; None of a single draw) and exact. None without a
        common trial."""
        self._require_metric(metric)
        for estimator in (a, b):
            known("estimator", estimator, self._names())
        return self._open().difference(metric, a, b, self.cell(cell))

    def series(self, name, estimator, cell=0, survey=0, trial=0):
        """A series of one run (docs/outputs.md), or None where only others of the trial have it."""
        series = self._series_of(estimator, cell, survey, trial)
        if name in series:
            return series[name]
        of_others = {}
        for other in self._names():
            of_others.update(self._open().series(other, self.cell(cell), survey, trial) or {})
        known("series", name, of_others)
        return None

    def cell(self, cell) -> int:
        """The number of a cell that is given by its number, or by axes and values."""
        if not isinstance(cell, dict):
            if cell not in range(len(self.cells)):
                raise InputError(f"cell: expected 0 to {len(self.cells) - 1}, got {cell!r}")
            return int(cell)
        wanted = {axis: _label(axis, value, self.axes[axis]) for axis, value in cell.items()}
        found = [i for i, each in enumerate(self.cells) if wanted.items() <= each.items()]
        if len(found) != 1:
            missing = ", ".join(axis for axis in self.axes if axis not in cell)
            raise InputError(f"cell: {len(found)} cells fit; a value is missing of {missing}")
        return found[0]

    def table(self) -> str:
        """The table that `fathom compare` prints."""
        return self._open().table()

    def to_frame(self, *, failed=False):
        """The rows as a data frame of pandas, by cell, the values of the sweep's axes (numbers,
        where they are), survey, trial and estimator; units in `attrs["units"]`. Runs that failed
        have an outcome and no metrics, unless `failed`."""
        return _frames.of_results(self, failed)

    def plot(
        self,
        what="trajectory",
        ax=None,
        *,
        cell=0,
        survey=0,
        trial=0,
        metric="mean_position_error_m",
        estimator=None,
    ):
        """Draws by matplotlib, into `ax` or into a new figure, of one trial: 'trajectory', with
        truth, dead reckoning and the loops of the first estimator; 'error', of positions against
        time. Of a cell: 'nees', the mean over the trials at every keyframe with its 95 % interval.
        Of a sweep over two axes: 'regimes', the mean of a metric of an estimator over that of the
        best one. Returns the axes."""
        if estimator is None:
            estimator = self.estimators[0]
        return _plot.of_results(self, what, ax, cell, survey, trial, metric, estimator)

    def __repr__(self):
        return _display.text_of_results(self)

    def _repr_html_(self):
        return _display.html_of_results(self)

    def _open(self):
        if self._store is None:
            raise InputError("the results are closed; open them with fathom.open_results(folder)")
        return self._store

    def _names(self):
        return [*self.estimators, DEAD_RECKONING]

    def _require_metric(self, name):
        if _fathom._metric(name) is None:
            names = dict.fromkeys(_fathom._metric_names())
            known("metric", name, names | dict.fromkeys(key for row in self.rows for key in row))

    def _rows_of(self, estimator, cell):
        known("estimator", estimator, self._names())
        return self._by_place.get((estimator, self.cell(cell)), [])

    def _means_of(self, estimator, cell):
        """Of the number of a cell: runs, how many of them were done, and the means of these."""
        return self._means.get((estimator, cell), (0, 0, {}))

    def _series_of(self, estimator, cell, survey, trial) -> dict:
        known("estimator", estimator, self._names())
        number = self.cell(cell)
        store = self._open()
        series = store.series(estimator, number, survey, trial) if min(survey, trial) >= 0 else None
        if series is None:
            raise InputError(
                f"{estimator} has no run of trial {trial} of survey {survey} in cell {number}"
            )
        return series


def open_results(folder) -> Results:
    """The results in a study's folder."""
    return Results(os.fspath(folder))


def _remove(folder, owner):
    """Not by a process that was forked, whose end is not that of the results."""
    if os.getpid() == owner:
        shutil.rmtree(folder, ignore_errors=True)


def _label(axis, value, labels):
    value = as_written(value, axis)
    is_word = isinstance(value, bool)
    text = str(value).lower() if is_word else str(value)
    for label in labels:
        if label == text or (not is_word and number_or_text(label) == value):
            return label
    raise unknown(f"value of {axis}", text, labels)
