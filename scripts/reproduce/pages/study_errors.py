"""docs/study_statistics.md: the program `study_errors`: error rates of verdicts, coverage of
intervals."""

from layout import table
from maker import maker
from markdown import tables_of

PAGE = "docs/study_statistics.md"
REPEATS = 400
BENCH = dict(programs=("study_errors",))


def _how(name):
    return f"`build/release/study_errors --repeats {REPEATS} --table {name}`"


def _rows(work, name):
    """Rows of one table of the program, as dicts by column."""
    text = work.output(f"study-errors-{name}", "study_errors", "--table", name,
                       "--repeats", work.size(REPEATS, 2))
    [(header, rows)] = tables_of(text)
    return [dict(zip(header, row)) for row in rows]


@maker(PAGE, "errors-worse", "slow", _how("worse"), 15, **BENCH)
def worse(work):
    rows = _rows(work, "worse")
    surveys = sorted({int(row["surveys"]) for row in rows})
    cells = {(row["errors"], row["estimators"], int(row["surveys"])):
             row["one is called worse, %"] if row["verdict given"] == "yes" else "–"
             for row in rows}
    kinds = dict.fromkeys((row["errors"], row["estimators"]) for row in rows)
    return table(["errors", "estimators", *(f"S = {count}" for count in surveys)],
                 [[*kind, *(cells[(*kind, count)] for count in surveys)] for kind in kinds])


@maker(PAGE, "errors-equivalent", "slow", _how("equivalent"), 15, **BENCH)
def equivalent(work):
    rows = _rows(work, "equivalent")
    return table(["errors", "surveys", "margin, %", "off by the margin", "alike"],
                 [list(row.values()) for row in rows])


@maker(PAGE, "errors-rare", "slow", _how("rare"), 5, **BENCH)
def rare(work):
    rows = _rows(work, "rare")
    return table(["trials", "its error there, times", "true difference, %", "called equivalent, %"],
                 [[row["trials"], row["its error, times"], row["true difference, %"],
                   row["called equivalent, %"]] for row in rows])


def _held(work, name, *sizes):
    """How often an interval holds the mean: a row for each size, a column for each shape."""
    rows = _rows(work, name)
    held = {(row["errors"], *(row[size] for size in sizes)):
            row["the 95 % interval holds the mean, %"] for row in rows}
    kinds = dict.fromkeys(tuple(row[size] for size in sizes) for row in rows)
    shapes = dict.fromkeys(row["errors"] for row in rows)
    return table([*sizes, *shapes],
                 [[*kind, *(held[(shape, *kind)] for shape in shapes)] for kind in kinds])


@maker(PAGE, "errors-coverage", "slow", _how("coverage"), 15, **BENCH)
def coverage(work):
    return _held(work, "coverage", "surveys", "trials of each")


@maker(PAGE, "errors-cells", "slow", _how("cells"), 15, **BENCH)
def cells(work):
    return _held(work, "cells", "cells", "trials of each")
