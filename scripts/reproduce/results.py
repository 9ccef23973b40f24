"""Reads what a study wrote."""

import csv
import json
import re
from pathlib import Path


def _number(text):
    return float(text) if text else None


class Study:
    """Tables of a study's folder, see docs/report.md."""

    def __init__(self, folder):
        self.folder = Path(folder)
        self.summary = self._read("summary.csv")
        self.runs = self._read("runs.csv")

    def _read(self, name):
        with open(self.folder / name, newline="", encoding="utf-8") as file:
            return list(csv.DictReader(file))

    def row(self, estimator, metric, **cell):
        """The row of summary.csv of an estimator and a metric in the cell with these labels."""
        found = [row for row in self.summary
                 if row["estimator"] == estimator and row["metric"] == metric
                 and all(same(row[axis], label) for axis, label in cell.items())]
        if len(found) != 1:
            raise LookupError(f"{self.folder}: {len(found)} rows of {estimator}, {metric}, {cell}")
        return {key: _number(value) if key in _NUMBERS else value
                for key, value in found[0].items()}

    def mean(self, estimator, metric, **cell):
        """Its mean; None without a run that has it."""
        return self.row(estimator, metric, **cell)["mean"]

    def mean_over(self, estimators, metric, **cell):
        """The mean of several estimators' means."""
        means = [self.mean(e, metric, **cell) for e in estimators]
        means = [m for m in means if m is not None]
        return sum(means) / len(means) if means else None

    def values(self, estimator, metric, **cell):
        """Of every run, None where it has none."""
        return [_number(row[metric]) for row in self.runs_of(estimator, **cell)]

    def bounds(self, estimator, **cell):
        """Its 2σ over all keyframes: a dict of `empirical_m` and `estimated_m` (docs/report.md)."""
        page = (self.folder / "report.html").read_text("utf-8")
        data = json.loads(re.search(r'id="data">(.*?)</script>', page, re.DOTALL).group(1))
        axes = [(axis["name"], axis["labels"]) for axis in data["axes"]]
        for one in data["cells"]:
            labels = {name: values[place] for (name, values), place in zip(axes, one["places"])}
            if all(same(labels[axis], label) for axis, label in cell.items()):
                return next(e["bounds"] for e in one["estimators"] if e["name"] == estimator)
        raise LookupError(f"{self.folder}: no cell {cell}")

    def runs_of(self, estimator, **cell):
        """Rows of runs.csv."""
        return [row for row in self.runs if row["estimator"] == estimator
                and all(same(row[axis], label) for axis, label in cell.items())]


_NUMBERS = {"n", "failures", "mean", "sd", "median", "low_95", "high_95"}


def same(text, label):
    """Labels are the same as text, or as numbers: 0.10 is 0.1."""
    try:
        return float(text) == float(label)
    except ValueError:
        return text == str(label)
