"""Reads what a study wrote."""

import csv
import json
import math
import re
import statistics
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
        # The page has their titles; their names are columns of runs.csv, behind the cell's.
        names = list(self.runs[0])[1:1 + len(data["axes"])]
        axes = list(zip(names, (axis["labels"] for axis in data["axes"])))
        for one in data["cells"]:
            labels = {name: values[place] for (name, values), place in zip(axes, one["places"])}
            if all(same(labels[axis], label) for axis, label in cell.items()):
                return next(e["bounds"] for e in one["estimators"] if e["name"] == estimator)
        raise LookupError(f"{self.folder}: no cell {cell}")

    def runs_of(self, estimator, **cell):
        """Rows of runs.csv."""
        return [row for row in self.runs if row["estimator"] == estimator
                and all(same(row[axis], label) for axis, label in cell.items())]

    def paired(self, one, other, metric, **cell):
        """Mean of `one` less `other` over the same surveys, with its 95 % t interval, as a row of
        summary.csv. Trials of one survey share its pictures, so a survey is one pair; where there
        is but one survey, a trial is.
        """
        pairs = {}
        for run in self.runs_of(one, **cell):
            pairs.setdefault((run["survey"], run["trial"]), []).append(_number(run[metric]))
        for run in self.runs_of(other, **cell):
            pairs.setdefault((run["survey"], run["trial"]), []).append(_number(run[metric]))
        both = {key: of for key, of in pairs.items() if len(of) == 2 and None not in of}
        surveys = {survey for survey, _ in both}
        groups = {}
        for (survey, trial), of in both.items():
            groups.setdefault(survey if len(surveys) > 1 else trial, []).append(of[0] - of[1])
        means = [statistics.fmean(of) for of in groups.values()]
        row = {"mean": statistics.fmean(means), "low_95": None, "high_95": None}
        if len(means) > 1:
            half = t_quantile(len(means) - 1) * statistics.stdev(means) / math.sqrt(len(means))
            row |= {"low_95": row["mean"] - half, "high_95": row["mean"] + half}
        return row


def t_quantile(freedom):
    """The 97.5 % quantile of Student's t, by bisection of its integral (Simpson's rule)."""
    scale = math.exp(math.lgamma((freedom + 1) / 2) - math.lgamma(freedom / 2))
    scale /= math.sqrt(freedom * math.pi)

    def density(t):
        return scale * (1 + t * t / freedom) ** (-(freedom + 1) / 2)

    def half(t, steps=2000):
        h = t / steps
        inner = sum((4 if i % 2 else 2) * density(i * h) for i in range(1, steps))
        return h / 3 * (density(0) + inner + density(t))

    low, high = 1.0, 20.0
    for _ in range(40):
        middle = (low + high) / 2
        low, high = (low, middle) if half(middle) > 0.475 else (middle, high)
    return high


_NUMBERS = {"n", "failures", "mean", "sd", "median", "low_95", "high_95"}


def same(text, label):
    """Labels are the same as text, or as numbers: 0.10 is 0.1."""
    try:
        return float(text) == float(label)
    except ValueError:
        return text == str(label)
