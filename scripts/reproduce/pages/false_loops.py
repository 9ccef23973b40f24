"""docs/robustness.md: `loss: truncated` on data that set none of its constants."""

from layout import code, fixed, share, significant, table
from maker import maker
from markdown import tables_of

PAGE = "docs/robustness.md"
KINDS = ("random", "local", "grouped")
LOSSES = ("dcs", "geman_mcclure", "truncated")
# Draws by share; with 30 % false loops one solve of M3500b or c takes minutes.
DRAWS = {"M3500a": {0.1: 5, 0.3: 5}, "M3500b": {0.1: 3}, "M3500c": {0.1: 3},
         "MIT": {0.1: 20, 0.3: 20}}
FITTED = {"ring": 20, "intel": 5, "manhattan": 5}
# From here on an estimate counts as another map: right loops alone put it within centimetres.
OFF_M = 1.0


def _needs(*graphs):
    return tuple(f"pose_graphs/{graph}.g2o" for graph in graphs)


def _solved(work, graph, of_all, draws, losses):
    """Rows of wrong_loops: dicts by column."""
    text = work.output(f"wrong-loops-{graph}", "wrong_loops", "--seeds", work.size(draws, 1),
                       "--shares", of_all, "--back-ends", ",".join(losses), work.graph(graph))
    header, rows = tables_of(text)[0]
    return [dict(zip(header, row)) for row in rows]


def _counted(row, column):
    return tuple(int(word) for word in row[column].split(" of "))


def _errors(row):
    return [float(word) for word in row["errors m"].split()]


def _metres(value):
    return significant(value, 2) if value >= 0.01 else "< 0.01"


def _cell(row):
    text = _metres(float(row["median error m"]))
    if row["worst"] != row["median error m"]:
        text += f" ({_metres(float(row['worst']))})"
    kept, false = _counted(row, "false kept")
    return f"{text}; {kept} of {false}" if false else text


def _unseen(work):
    """(graph, share of false loops, draws)"""
    for graph, draws in DRAWS.items():
        for of_all, n in ((0, 1), *draws.items()):
            if not work.is_small or (graph == "MIT" and of_all == 0.1):
                yield graph, of_all, n


HOW_UNSEEN = ("`build/release/wrong_loops --back-ends dcs,geman_mcclure,truncated --shares S "
              "--seeds N GRAPH.g2o`")


@maker(PAGE, "unseen-graphs", "slow", HOW_UNSEEN, 30, needs=_needs(*DRAWS),
       programs=("wrong_loops",))
def unseen_graphs(work):
    rows = []
    for graph, of_all, draws in _unseen(work):
        found = _solved(work, graph, of_all, draws, LOSSES)
        for kind in ("none",) if of_all == 0 else KINDS:
            cells = [next(row for row in found if row["back end"] == loss and row["kind"] == kind)
                     for loss in LOSSES]
            rows.append([graph, f"{100 * of_all:g} % {kind}" if of_all else "clean",
                         draws if of_all else "", *map(_cell, cells)])
    return table(["graph", "false loops", "draws", *code(LOSSES)], rows)


def _pooled(rows):
    """Of draws of all kinds and shares: how many are off, keep a false loop; loops kept, lost."""
    errors = [error for row in rows for error in _errors(row)]
    kept, false = (sum(column) for column in zip(*(_counted(r, "false kept") for r in rows)))
    lost, right = (sum(column) for column in zip(*(_counted(r, "right lost") for r in rows)))
    with_kept = sum(_counted(row, "draws")[0] for row in rows)
    return [share(sum(error > OFF_M for error in errors), len(errors)),
            share(with_kept, len(errors)), f"{kept} of {false}",
            f"{significant(100 * lost / right, 2)} %"]


@maker(PAGE, "unseen-counts", "slow", f"{HOW_UNSEEN}; the other graphs: `--back-ends truncated "
       "--shares 0.1` and `0.3`", 40, needs=_needs(*DRAWS, *FITTED), programs=("wrong_loops",))
def unseen_counts(work):
    rows = []
    for graph, draws in work.size(FITTED, {"ring": 1}).items():
        found = [row for of_all in (0.1, 0.3)
                 for row in _solved(work, graph, of_all, draws, ("truncated",))]
        rows.append([graph, "tried" if graph == "manhattan" else "fitted here", *_pooled(found)])
    by_graph = {}
    for graph, of_all, draws in _unseen(work):
        if of_all:
            by_graph.setdefault(graph, []).extend(
                row for row in _solved(work, graph, of_all, draws, LOSSES)
                if row["back end"] == "truncated")
    rows += [[graph, "tried" if graph == "MIT" else "unseen noise", *_pooled(found)]
             for graph, found in by_graph.items()]
    return table(["graph", "constants", "draws off by more than 1 m",
                  "draws with a false loop kept", "false loops kept", "right loops lost"], rows)


STUDY = "configs/studies/false_loops_drawn.yaml"
HOW_DRAWN = f"`fathom compare {STUDY}`"
DRAWN = (("truncated", "`truncated`"), ("dcs", "`dcs`"), ("iekf_gate", "`trajectory_iekf`, gate"),
         ("smoother_gate", "`incremental_smoother`, gate"))
MISSIONS, HEADINGS = ("single_loop", "sweep"), (0.002, 0.01)
SHARED, SHARES = (0, 0.02), (0.1, 0.3, 0.5)


def _drawn(work):
    return work.study("false-loops-drawn", STUDY)


def _done(study, name, **cell):
    return [run for run in study.runs_of(name, **cell)
            if run["outcome"] in ("converged", "iteration_limit")]


def _median(values):
    values = sorted(values)
    return (values[(len(values) - 1) // 2] + values[len(values) // 2]) / 2


def _sum(runs, column):
    return sum(float(run[column] or 0) for run in runs)


@maker(PAGE, "drawn-kept", "slow", HOW_DRAWN, 15)
def drawn_kept(work):
    study = _drawn(work)
    rows = []
    for shared in SHARED:
        for of_all in SHARES:
            texts = []
            for name, _ in DRAWN:
                cell = {"shared_m": shared, "false": of_all}
                runs = _done(study, name, **cell)
                keeping = sum(float(run["false_loops_kept"] or 0) > 0 for run in runs)
                failed = len(study.runs_of(name, **cell)) - len(runs)
                texts.append(share(keeping, len(runs)) + (f"; {failed} failed" if failed else ""))
            rows.append([f"{1e3 * shared:g} mm", f"{100 * of_all:g} %", *texts])
    return table(["shared error", "false loops", *(text for _, text in DRAWN)], rows)


def _ratio_and_lost(study, name, **cell):
    """Of the errors' medians over that of the plain estimate of the same square without false
    loops: the middle and the largest of the squares; and the share of right loops lost."""
    ratios, lost, loops = [], 0.0, 0.0
    for mission in MISSIONS:
        for heading in HEADINGS:
            square = {"mission": mission, "heading_noise_rad": heading,
                      "shared_m": cell["shared_m"]}
            clean = _median(float(run["mean_position_error_m"])
                            for run in _done(study, "plain", false=0, **square))
            for kind in KINDS:
                runs = _done(study, name, kind=kind, false=cell["false"], **square)
                ratios.append(_median(float(run["mean_position_error_m"]) for run in runs) / clean)
                lost += _sum(runs, "right_loops_lost")
                loops += _sum(runs, "right_loops_lost") + _sum(runs, "loops_kept")
                loops -= _sum(runs, "false_loops_kept")
    text = f"{fixed(_median(ratios), 2)}, {significant(max(ratios))}"
    # Without false loops the harness does not count the right ones.
    return text + (f"; {significant(100 * lost / loops, 2)} %" if cell["false"] else "")


@maker(PAGE, "drawn-errors", "slow", HOW_DRAWN, 15)
def drawn_errors(work):
    study = _drawn(work)
    return table(["shared error", "false loops", *(text for _, text in DRAWN)],
                 [[f"{1e3 * shared:g} mm", f"{100 * of_all:g} %" if of_all else "none",
                   *(_ratio_and_lost(study, name, shared_m=shared, false=of_all)
                     for name, _ in DRAWN)]
                  for shared in SHARED for of_all in (0, *SHARES)])
