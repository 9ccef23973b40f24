"""Whether two studies hold the same results, bit for bit, cost apart: same_results.py ONE OTHER."""

import pathlib
import sqlite3
import sys

COST_SERIES = "update_ms"


def content(folder):
    """All runs of a study by key: outcome, metrics and series as they are stored."""
    path = pathlib.Path(folder) / "results.sqlite"
    with sqlite3.connect(f"file:{path}?mode=ro", uri=True) as database:
        keys = {run: key for run, *key in database.execute(
            "SELECT run, cell, survey, trial, name, outcome, fault, log_hash "
            "FROM run JOIN estimator USING (estimator)")}
        found = {tuple(key): {} for key in keys.values()}
        for run, name, value in database.execute(
                "SELECT run, name, value FROM value JOIN metric USING (metric) WHERE NOT is_cost"):
            found[tuple(keys[run])][name] = value
        for run, name, data in database.execute(
                "SELECT run, name, data FROM series WHERE name <> ?", (COST_SERIES,)):
            found[tuple(keys[run])]["series " + name] = data
    return found


def main(one, other):
    first, second = content(one), content(other)
    if not first:
        sys.exit(f"{one}: no runs")
    for key in sorted(first.keys() | second.keys()):
        if first.get(key) != second.get(key):
            sys.exit(f"{key} differs")
    print(f"{len(first)} runs are the same")


if __name__ == "__main__":
    main(*sys.argv[1:])
