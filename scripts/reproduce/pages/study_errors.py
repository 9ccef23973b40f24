"""docs/studies.md: the program `study_errors`: error rates of verdicts, coverage of intervals."""

from layout import table
from maker import maker
from markdown import tables_of

PAGE = "docs/studies.md"
REPEATS = 400
HOW = f"`build/release/study_errors --repeats {REPEATS}`"
BENCH = dict(programs=("study_errors",))


def _tables(work):
    """The program's tables: rows as dicts by column."""
    text = work.output("study-errors", "study_errors", "--repeats", work.size(REPEATS, 2))
    return [[dict(zip(header, row)) for row in rows] for header, rows in tables_of(text)]


@maker(PAGE, "errors-worse", "slow", HOW, 30, **BENCH)
def worse(work):
    rows, _, _ = _tables(work)
    surveys = sorted({int(row["surveys"]) for row in rows})
    cells = {(row["errors"], row["estimators"], int(row["surveys"])):
             row["one is called worse, %"] if row["verdict given"] == "yes" else "–"
             for row in rows}
    kinds = dict.fromkeys((row["errors"], row["estimators"]) for row in rows)
    return table(["errors", "estimators", *(f"S = {count}" for count in surveys)],
                 [[*kind, *(cells[(*kind, count)] for count in surveys)] for kind in kinds])


@maker(PAGE, "errors-equivalent", "slow", HOW, 30, **BENCH)
def equivalent(work):
    _, rows, _ = _tables(work)
    return table(["errors", "surveys", "margin, %", "off by the margin", "alike"],
                 [list(row.values()) for row in rows])


@maker(PAGE, "errors-coverage", "slow", HOW, 30, **BENCH)
def coverage(work):
    _, _, rows = _tables(work)
    sizes = dict.fromkeys((row["surveys"], row["trials of each"]) for row in rows)
    cells = {(row["errors"], row["surveys"], row["trials of each"]):
             row["the 95 % interval holds the mean, %"] for row in rows}
    shapes = dict.fromkeys(row["errors"] for row in rows)
    return table(["surveys", "trials of each", *shapes],
                 [[*size, *(cells[(shape, *size)] for shape in shapes)] for size in sizes])
