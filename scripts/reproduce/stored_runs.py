"""Reads series of runs from the results.sqlite of a study (docs/outputs.md)."""

import sqlite3
import struct
from contextlib import closing

_SERIES = """
    SELECT series.name, series.data
    FROM series JOIN run USING (run) JOIN estimator USING (estimator)
    WHERE cell = ? AND survey = ? AND trial = ? AND estimator.name = ?"""
_PLACE = """
    SELECT cell FROM cell_value JOIN axis USING (axis) JOIN axis_value USING (axis, place)
    WHERE axis.name = ? AND label = ?"""


class StoredRuns:
    """The runs of the cell of a study with these labels, {axis: label}."""

    def __init__(self, study, cell):
        self.file = study.folder / "results.sqlite"
        found = {row[0] for row in self._rows("SELECT cell FROM cell")}
        for axis, label in cell.items():
            found &= {row[0] for row in self._rows(_PLACE, axis, str(label))}
        if len(found) != 1:
            raise LookupError(f"{self.file}: {len(found)} cells of {cell}")
        self.cell = found.pop()

    def _rows(self, query, *values):
        with closing(sqlite3.connect(f"file:{self.file}?mode=ro", uri=True)) as store:
            return store.execute(query, values).fetchall()

    def trials(self):
        """(survey, trial) of all."""
        return self._rows("SELECT DISTINCT survey, trial FROM run WHERE cell = ? ORDER BY 1, 2",
                          self.cell)

    def series(self, estimator, survey=0, trial=0):
        """Of a run, by name."""
        return {name: struct.unpack(f"<{len(data) // 8}d", data)
                for name, data in self._rows(_SERIES, self.cell, survey, trial, estimator)}

    def way(self, estimator, of_truth=False):
        """Positions of the keyframes of the first run."""
        found = self.series(estimator)
        prefix = "truth_" if of_truth else ""
        return list(zip(found[prefix + "x_m"], found[prefix + "y_m"]))

    def pairs(self, estimator, survey=0, trial=0):
        """The pairs of keyframes whose registrations a run used."""
        found = self.series(estimator, survey, trial)
        return [(int(i), int(k)) for i, k, fate in
                zip(found["loop_from"], found["loop_to"], found["loop_fate"]) if fate == 0]

    def share_of_neighbours(self, estimator):
        """Of consecutive keyframes, over all runs, those that are registered with each other."""
        registered = steps = 0
        for survey, trial in self.trials():
            steps += len(self.series(estimator, survey, trial)["x_m"]) - 1
            registered += len({pair for pair in self.pairs(estimator, survey, trial)
                               if abs(pair[0] - pair[1]) == 1})
        return registered / steps
