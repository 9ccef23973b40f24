"""docs/place_recognition.md: robust back ends on recorded graphs whose loops are recognised places,
right and wrong."""

import itertools
import json
import re

import place_recognition
from layout import code, significant, table
from maker import maker

PAGE = "docs/place_recognition.md"
DATA = "rrr/datasets"
GRAPHS = {"Bicocca": "B25b/B25b_0.000", "Bovisa 04": "Bovisa/Bovisa04_odometry_bow_tr",
          "Bovisa 06": "Bovisa/Bovisa06_odometry_bow_tr",
          "New College": "NewCollege/NewCollege_odometry_bow_tr"}
# The name of a Bicocca graph is the least similarity of two pictures that makes them a loop.
THRESHOLDS = ("0.000", "0.100", "0.250", "0.500", "1.000")
TIMES = "B25b/timestamps/B25b_timestamps.txt"
TRUTH = "B25b/timestamps/Bicocca_2009-02-25b-GT-extended.csv"


def _batch(loss, *more):
    settings = (f"estimator.loss={loss}", *more)
    return ("--mode", "batch", "--estimator", "sparse_gauss_newton",
            *(word for s in settings for word in ("--set", s)))


def _by_keyframe(estimator, setting):
    return ("--mode", "incremental", "--estimator", estimator, "--set", f"estimator.{setting}")


BACK_ENDS = {
    "plain": _batch("none"), "`huber`": _batch("huber"), "`cauchy`": _batch("cauchy"),
    "`dcs`": _batch("dcs"), "`geman_mcclure`": _batch("geman_mcclure"),
    "`geman_mcclure`, graduated": _batch("geman_mcclure", "estimator.graduation=convex"),
    "`truncated`": _batch("truncated"),
    "`incremental_smoother`, `dcs`": _by_keyframe("incremental_smoother", "loss=dcs"),
    "`incremental_smoother`, gate": _by_keyframe("incremental_smoother", "gate_probability=0.9999"),
    "`trajectory_iekf`, gate": _by_keyframe("trajectory_iekf", "gate_probability=0.9999")}
COMPARED = ("`dcs`", "`geman_mcclure`", "`truncated`", "`incremental_smoother`, gate")
HOW = "`fathom solve GRAPH.g2o --drop-self-edges`"


def _needs(*files):
    return tuple(f"{DATA}/{file}" for file in files)


ALL_GRAPHS = _needs(*(f"{file}.g2o" for file in GRAPHS.values()))
BICOCCA = _needs(*(f"B25b/B25b_{least}.g2o" for least in THRESHOLDS), TIMES, TRUTH)


def _solved(work, name, graph, arguments):
    """Folder of a run. Status 1, a failed solve, is a result, too."""
    return work.run(name, "fathom", "solve", str(graph), "--drop-self-edges", *arguments, "--quiet",
                    "--out", "{out}/run", statuses=(0, 1)) / "run"


def _run(work, file, back_end):
    return _solved(work, f"place-{file.replace('/', '-')}", work.data / DATA / f"{file}.g2o",
                   BACK_ENDS[back_end])


def _metrics(folder):
    return json.loads((folder / "metrics.json").read_text("utf-8"))


def _lines(work, file):
    return (work.data / DATA / f"{file}.g2o").read_text("utf-8").split("\n")


def _fit_of_kept(work, file, kept):
    """F per degree of freedom of least squares over the steps and these loops alone."""
    text = "\n".join(place_recognition.only_with(_lines(work, file), kept)) + "\n"
    reduced = work.folder / f"place-{file.replace('/', '-')}-kept.g2o"
    reduced.parent.mkdir(parents=True, exist_ok=True)
    reduced.write_text(text, encoding="utf-8")
    done = _metrics(_solved(work, "place-kept", reduced, BACK_ENDS["plain"]))
    return done.get("chi2_per_dof")


@maker(PAGE, "place-kept", "slow", f"{HOW}; F: of a plain batch solve of the loops kept", 8,
       needs=ALL_GRAPHS)
def place_kept(work):
    graphs = work.size(list(GRAPHS), ["Bovisa 06"])
    rows = []
    for back_end in BACK_ENDS:
        cells = []
        for graph in graphs:
            kept = place_recognition.kept_loops(_run(work, GRAPHS[graph], back_end))
            cells.append(f"{len(kept)}; {significant(_fit_of_kept(work, GRAPHS[graph], kept))}")
        rows.append([back_end, *cells])
    heads = [f"{graph} ({len(place_recognition.loops_of(_lines(work, GRAPHS[graph])))})"
             for graph in graphs]
    return table(["loops kept; F per degree of freedom of these", *heads], rows)


@maker(PAGE, "place-time", "time", HOW, 4, needs=ALL_GRAPHS)
def place_time(work):
    graphs = work.size(list(GRAPHS), ["Bovisa 06"])
    return table(["CPU time, ms", *graphs],
                 [[back_end, *(significant(_metrics(_run(work, GRAPHS[g], back_end))["cpu_ms"], 2)
                               for g in graphs)] for back_end in BACK_ENDS])


@maker(PAGE, "place-agree", "slow", HOW, 4, needs=ALL_GRAPHS)
def place_agree(work):
    graphs = work.size(list(GRAPHS), ["Bovisa 06"])
    rows = []
    for one, other in itertools.combinations(COMPARED, 2):
        cells = []
        for graph in graphs:
            a, b = (place_recognition.kept_loops(_run(work, GRAPHS[graph], back_end))
                    for back_end in (one, other))
            cells.append(f"{len(a & b)}, {len(a - b)}, {len(b - a)}")
        rows.append([one, other, *cells])
    return table(["one", "other", *graphs], rows)


def _reference(work):
    return place_recognition.Reference(work.data / DATA / TRUTH, work.data / DATA / TIMES)


@maker(PAGE, "place-judged", "slow", "`scripts/reproduce/place_recognition.py`, which holds each "
       "loop against the ground truth", 0.1, needs=BICOCCA, programs=())
def place_judged(work):
    reference = _reference(work)
    rows = []
    for least in THRESHOLDS:
        loops = place_recognition.loops_of(_lines(work, f"B25b/B25b_{least}"))
        said = [reference.verdict(loop) for loop in loops]
        rows.append([least, len(loops),
                     *(said.count(word) for word in ("right", "false", "open", "unknown"))])
    return table(["least similarity", "loops", "right", "false", "open", "unknown"], rows)


def _mean_error(work, folder, reference):
    """Mean distance from the reference after a rigid alignment, as `fathom evaluate` prints it."""
    truth = work.folder / "bicocca.tum"
    truth.write_text("\n".join(reference.tum()) + "\n", encoding="utf-8")
    text = work.output("place-error", "fathom", "evaluate", str(folder / "trajectory.tum"),
                       str(truth), "--align", "se2")
    return float(re.search(r"mean position error \(m\)\s+(\S+)", text).group(1))


@maker(PAGE, "place-truth", "slow", f"{HOW}; `fathom evaluate trajectory.tum TRUTH --align se2`", 6,
       needs=BICOCCA)
def place_truth(work):
    reference = _reference(work)
    thresholds = work.size(THRESHOLDS, THRESHOLDS[-1:])
    rows = []
    for back_end in BACK_ENDS:
        cells = []
        for least in thresholds:
            file = f"B25b/B25b_{least}"
            folder = _run(work, file, back_end)
            kept = place_recognition.kept_loops(folder)
            loops = place_recognition.loops_of(_lines(work, file))
            said = [reference.verdict(loop) for loop in loops
                    if (loop.first, loop.second) in kept]
            error = significant(_mean_error(work, folder, reference))
            cells.append(f"{said.count('right')}, {said.count('false')}; {error}")
        rows.append([back_end, *cells])
    return table(["right, false kept; error (m)", *code(thresholds)], rows)
