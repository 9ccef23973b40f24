"""docs/robustness.md: the program `wrong_loops`, and its study on a survey."""

import re

from layout import significant, table
from maker import maker
from markdown import tables_of

PAGE = "docs/robustness.md"
GRAPHS = ("ring", "intel", "manhattan")
NEEDS = tuple(f"pose_graphs/{graph}.g2o" for graph in GRAPHS)
KINDS = ("random", "local", "grouped")
# A plain solve of manhattan with false loops takes minutes.
SEEDS = {"ring": 3, "intel": 3, "manhattan": 1}
ALL = ("plain", "huber", "cauchy", "dcs", "geman_mcclure", "truncated")
SOME = ("plain", "dcs", "geman_mcclure", "truncated")
BENCH = dict(needs=NEEDS, programs=("wrong_loops",))


def _solved(work, graph, share, names):
    """Rows of wrong_loops by (back end, kind): dicts by column."""
    text = work.output(f"wrong-loops-{graph}", "wrong_loops", "--seeds", work.size(SEEDS[graph], 1),
                       "--shares", share, "--back-ends", ",".join(names), work.graph(graph))
    header, rows = tables_of(text)[0]
    rows = [dict(zip(header, row)) for row in rows]
    return {(row["back end"], row["kind"]): row for row in rows}


def _kept(row):
    kept, total = re.match(r"(\d+) of (\d+)", row["false kept"]).groups()
    return f"{kept} of {total}"


def _cell(row):
    return f"{float(row['worst']):.3g}, {_kept(row)}"


def _spoiled(work, share, names):
    rows = []
    for graph in work.size(GRAPHS, GRAPHS[:1]):
        found = _solved(work, graph, share, names)
        rows += [[graph, kind, *(_cell(found[name, kind]) for name in names)] for kind in KINDS]
    return rows


def _head(names):
    return [name if name == "plain" else f"`{name}`" for name in names]


@maker(PAGE, "false-30", "slow", "`build/release/wrong_loops --shares 0.3 GRAPH.g2o`, `--seeds 3` "
       "(manhattan: 1)", 60, **BENCH)
def false_30(work):
    return table(["graph", "kind", *_head(ALL)], _spoiled(work, 0.3, ALL))


@maker(PAGE, "false-10-50", "slow", "`build/release/wrong_loops GRAPH.g2o`, `--shares 0.1` and "
       "`0.5`, `--seeds 3` (manhattan: 1)", 90, **BENCH)
def false_10_50(work):
    rows = []
    for share, text in ((0.1, "10 %"), (0.5, "50 %")):
        rows += [[*row[:2], text, *row[2:]] for row in _spoiled(work, share, SOME)]
    rows.sort(key=lambda row: GRAPHS.index(row[0]))
    return table(["graph", "kind", "share", *_head(SOME)], rows)


@maker(PAGE, "false-none", "quick", "`build/release/wrong_loops --shares 0 GRAPH.g2o`", 0.5,
       **BENCH)
def false_none(work):
    rows = []
    for graph in GRAPHS:
        found = _solved(work, graph, 0, SOME[1:])
        rows.append([graph, *(f"{row['median error m']}, {row['right lost']} lost"
                              for row in (found[name, "none"] for name in SOME[1:]))])
    return table(["", *_head(SOME[1:])], rows)


@maker(PAGE, "false-time", "time", "`build/release/wrong_loops --shares 0.3 GRAPH.g2o`", 60,
       **BENCH)
def false_time(work):
    texts = []
    for graph in work.size(GRAPHS, GRAPHS[:1]):
        found = _solved(work, graph, 0.3, ALL)
        times = [float(found["truncated", kind]["CPU ms"]) for kind in KINDS]
        texts.append(f"{significant(min(times), 2)} to {significant(max(times), 2)}")
    return table(["`truncated`, 30 %", *work.size(GRAPHS, GRAPHS[:1])], [["CPU time, ms", *texts]])


SURVEY = (("trajectory_iekf", "`trajectory_iekf`, no gate"),
          ("iekf_gate", "`trajectory_iekf`, gate 0.9999"),
          ("iekf_joint", "`trajectory_iekf`, joint gate 0.9999"),
          ("ekf_gate", "`ekf`, gate 0.9999"),
          ("plain", "`sparse_gauss_newton`, plain"), ("huber", "`huber`"), ("dcs", "`dcs`"),
          ("geman_mcclure", "`geman_mcclure`"), ("truncated", "`truncated`"))


def _range(values, text):
    values = [v for v in values if v is not None]
    if not values:
        return "–"
    low, high = text(min(values)), text(max(values))
    return low if low == high else f"{low} to {high}"


def _survey_cell(study, name, share, kinds):
    cells = [{"false": share, "kind": kind} for kind in kinds]
    rows = [study.row(name, "mean_position_error_m", **cell) for cell in cells]
    failed = max(int(float(row["failures"])) for row in rows)
    text = _range([row["mean"] and 1e3 * row["mean"] for row in rows], significant)
    if share:
        kept = _range([study.mean(name, "false_loops_kept", **cell) for cell in cells],
                      "{:.3g}".format)
        text += f" ({kept})"
    return text + (f"; {failed} failed" if failed else "")


@maker(PAGE, "false-survey", "slow", "`fathom compare configs/studies/wrong_loops.yaml`", 20)
def false_survey(work):
    study = work.study("wrong-loops", "configs/studies/wrong_loops.yaml")
    columns = (("0 %", 0, KINDS), ("10 %", 0.1, KINDS), ("30 % random", 0.3, ("random",)),
               ("30 % local", 0.3, ("local",)), ("30 % grouped", 0.3, ("grouped",)),
               ("50 %", 0.5, KINDS))
    return table(["", *(head for head, _, _ in columns)],
                 [[text, *(_survey_cell(study, name, share, kinds) for _, share, kinds in columns)]
                  for name, text in SURVEY])
