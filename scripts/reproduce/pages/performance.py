"""docs/performance.md and the costs in estimators/*.md: programs of Google Benchmark, solves."""

import json

from layout import code, fixed, significant, table
from maker import maker
from markdown import tables_of

PAGE = "docs/performance.md"
ESTIMATORS = ("trajectory_iekf", "ekf", "ceres_pose_graph", "sparse_gauss_newton",
              "incremental_smoother")
BRIEF = "--benchmark_min_time=0.01"


def row_of(rows, name):
    """The row of a case, whatever Google Benchmark adds to its name."""
    found = [row for key, row in rows.items() if key == name or key.startswith(name + "/")]
    if len(found) != 1:
        raise LookupError(f"{len(found)} cases '{name}' in {', '.join(rows)}")
    return found[0]


@maker(PAGE, "survey-speed", "time", "`build/release/survey_benchmark`", 4,
       programs=("survey_benchmark",))
def survey_speed(work):
    rows = work.benchmark("survey", "survey_benchmark")
    cells = []
    for separation, features in ((10, 2000), (3, 2000), (10, 1000)):
        one, two = (row_of(rows, f"Survey/separation_frames:{separation}/max_features:{features}/"
                                 f"threads:{threads}") for threads in (1, 2))
        cells.append([separation, features, f"{one['registrations']:.0f}",
                      significant(one["items_per_second"], 2),
                      significant(two["items_per_second"], 2),
                      significant(two["items_per_second"] / one["items_per_second"], 2)])
    return table(["separation_frames", "max_features", "registrations of keyframes",
                  "frames/s, one thread", "two threads", "ratio"], cells)


@maker(PAGE, "stages", "time", "`build/release/front_end_benchmark`", 2,
       programs=("front_end_benchmark",))
def stages(work):
    rows = work.benchmark("front-end", "front_end_benchmark", *work.size([], [BRIEF]))
    by_label = {(key.split("/")[0], row.get("label")): row for key, row in rows.items()}
    ransac = row_of(rows, "Ransac/matches:500/one_right_in:1")

    def ms(stage, detector):
        row = by_label[stage, detector]
        return f"{row['features']:.0f}", f"{significant(row['real_time'], 2)} ms"

    cells = [[f"extraction, {name}, flattening included", *ms("Extraction", name)]
             for name in ("sift", "orb", "akaze", "brisk")]
    part = {label: by_label["SiftParts", label]["real_time"]
            for label in ("all", "unflattened", "detection")}
    for what, time in (("flattening", part["all"] - part["unflattened"]),
                       ("detection, orientations included", part["detection"]),
                       ("description", part["unflattened"] - part["detection"])):
        cells.append([f"sift, of it {what}", "1000", f"{significant(time, 2)} ms"])
    cells.append(["matching, sift", *ms("Matching", "sift")])
    cells.append(["RANSAC, 500 matches, all right", "",
                  f"{significant(ransac['real_time'], 2)} ms"])
    return table(["stage", "features", "time"], cells)


@maker(PAGE, "long-survey", "time", "`build/release/long_survey_benchmark "
       "--benchmark_filter=LongSurvey/feature_MB:N`", 60, programs=("long_survey_benchmark",))
def long_survey(work):
    cells = []
    for bound in work.size((64, 512), (64,)):
        case = f"LongSurvey/feature_MB:{bound}"
        row = row_of(work.benchmark(f"long-survey-{bound}", "long_survey_benchmark",
                                    f"--benchmark_filter={case}"), case)
        cells.append([f"{bound} MiB" + (", the default" if bound == 512 else ""),
                      *(f"{row[key]:.0f} MiB" for key in ("peak_MB_at_100", "peak_MB",
                                                          "features_MB"))])
    return table(["bound on features held", "peak at keyframe 100", "peak at 10 000",
                  "of it features"], cells)


@maker(PAGE, "survey-growth", "time",
       "`build/release/survey_growth configs/studies/long_survey.yaml --out DIR --svg FILE.svg`",
       120, programs=("survey_growth", "fathom"), pictures=("docs/images/survey_growth.svg",))
def survey_growth(work):
    legs = work.size((10, 32, 100, 316, 995), (2, 4))
    folder = work.run("survey-growth", "survey_growth", "configs/studies/long_survey.yaml",
                      "--out", "{out}/runs", "--svg", "{out}/growth.svg", "--legs", *legs)
    work.picture("docs/images/survey_growth.svg", folder / "growth.svg")
    (header, rows), = tables_of((folder / "stdout.txt").read_text("utf-8"))
    return table(header, rows)


@maker(PAGE, "candidates", "time", "`build/release/long_survey_benchmark "
       "--benchmark_filter=Candidates`", 0.5, programs=("long_survey_benchmark",))
def candidates(work):
    rows = work.benchmark("candidates", "long_survey_benchmark", "--benchmark_filter=Candidates")
    return table(["`candidates.method`", "distance", "mahalanobis", "overlap"],
                 [["ms, of 10 000 keyframes",
                   *(significant(row_of(rows, f"Candidates/method:{i}")["cpu_time"], 1)
                     for i in range(3))]])


def _by_keyframes(work, names, suffix):
    rows = work.benchmark("back-ends-benchmark", "back_ends_benchmark", *work.size([], [BRIEF]))
    counts = (100, 300, 1000)
    times = [[significant(row_of(rows, f"{name}{suffix}/keyframes:{n}")["real_time"], 2)
              for n in counts] for name in names]
    return [str(n) for n in counts], times


BACK_ENDS = dict(kind="time", how="`build/release/back_ends_benchmark`", minutes=3,
                 programs=("back_ends_benchmark",))


@maker(PAGE, "motions", **BACK_ENDS)
def motions(work):
    names = ESTIMATORS[:3]
    counts, times = _by_keyframes(work, names, "/motions")
    return table(["keyframes", *counts], [[n, *t] for n, t in zip(code(names), times)])


@maker(PAGE, "updates", **BACK_ENDS)
def updates(work):
    counts, times = _by_keyframes(work, ESTIMATORS, "")
    return table(["keyframes", *counts], [[n, *t] for n, t in zip(code(ESTIMATORS), times)])


@maker("docs/estimators/incremental_smoother.md", "smoother-updates", **BACK_ENDS)
def smoother_updates(work):
    counts, times = _by_keyframes(work, ESTIMATORS[-1:], "")
    return table(["keyframes", *counts], [["ms", *times[0]]])


GRAPHS = ("ring", "MIT", "CSAIL", "intel", "manhattan", "M3500", "M3500a", "M3500b", "M3500c")


@maker("docs/estimators/incremental_smoother.md", "smoother-graphs", "time",
       "`FATHOM_POSE_GRAPHS=FOLDER build/release/incremental_benchmark`", 20,
       needs=tuple(f"pose_graphs/{graph}.g2o" for graph in GRAPHS),
       programs=("incremental_benchmark",))
def smoother_graphs(work):
    few = work.size([], ["--benchmark_filter=/ring"])
    rows = work.benchmark("incremental", "incremental_benchmark", *few,
                          env={"FATHOM_POSE_GRAPHS": str(work.data / "pose_graphs")})
    cells = []
    for graph in work.size(GRAPHS, GRAPHS[:1]):
        whole, smoother = (row_of(rows, f"incremental/{graph}/{name}")
                           for name in ("sparse_gauss_newton", "incremental_smoother"))
        cells.append([graph, significant(row_of(rows, f"scale/{graph}")["cpu_ms"]),
                      significant(whole["total_ms"]), significant(whole["longest_ms"], 2),
                      f"**{significant(smoother['total_ms'])}**",
                      fixed(smoother["median_ms"], 3), fixed(smoother["p95_ms"], 3),
                      significant(smoother["longest_ms"], 2), f"{smoother['worst_gap']:.1e}"])
    return table(["graph", "Ceres, once", "whole graph: all", "longest", "**smoother: all**",
                  "median", "95 %", "longest", "F over the optimum"], cells)


LOSSES = ("none", "huber", "cauchy", "geman_mcclure", "dcs")
LOSS_GRAPHS = (("CSAIL", 0), ("CSAIL", 0.1), ("intel", 0), ("intel", 0.1), ("manhattan", 0))


@maker("docs/estimators/incremental_smoother.md", "smoother-losses", "time",
       "`fathom solve GRAPH.g2o --mode incremental --estimator NAME --set estimator.loss=LOSS`, "
       "false loops by `fathom spoil --share 0.1`", 3,
       needs=tuple(f"pose_graphs/{graph}.g2o" for graph in ("CSAIL", "intel", "manhattan")),
       programs=("fathom",))
def smoother_losses(work):
    cells = []
    for graph, share in work.size(LOSS_GRAPHS, LOSS_GRAPHS[:2]):
        for loss in LOSSES[1 if share else 0:]:
            whole, smoother = (_solved(work, graph, share, name, loss)
                               for name in ("sparse_gauss_newton", "incremental_smoother"))
            over = smoother["chi2_used"] / whole["chi2_used"] - 1.0
            cells.append([graph, f"{100 * share:.0f} %", f"`{loss}`",
                          significant(whole["cpu_ms"]), f"**{significant(smoother['cpu_ms'])}**",
                          significant(smoother["update_ms.median"], 2),
                          f"{smoother['chi2_used']:.6g}", f"{over:.1e}"])
    return table(["graph", "false loops", "loss", "whole graph: all", "**smoother: all**",
                  "update, median", "F", "over that of the whole graph"], cells)


def _solved(work, graph, share, name, loss):
    """metrics.json of an incremental solve."""
    file = work.graph(graph)
    if share:
        file = str(work.run(f"spoil-{graph}", "fathom", "spoil", file, "--share", share, "--quiet",
                            "--out", "{out}/spoilt.g2o") / "spoilt.g2o")
    folder = work.run(f"loss-{graph}-{name}-{loss}", "fathom", "solve", file, "--mode",
                      "incremental", "--estimator", name, "--set", f"estimator.loss={loss}",
                      "--quiet", "--out", "{out}/run", statuses=(0, 1))
    return json.loads((folder / "run" / "metrics.json").read_text("utf-8"))


IEKF = dict(kind="time", how="`build/release/trajectory_iekf_benchmark`", minutes=2,
            programs=("trajectory_iekf_benchmark",))


@maker("docs/estimators/trajectory_iekf.md", "iekf-update", **IEKF)
def iekf_update(work):
    rows = work.benchmark("iekf", "trajectory_iekf_benchmark")
    cells = []
    for passes in (1, 2, 3):
        row = row_of(rows, f"update/keyframes:1000/linearisations:{passes}")
        small = row_of(rows, f"update/keyframes:300/linearisations:{passes}")
        cells.append([passes, significant(row["median_ms"], 2), significant(row["per_triangle"], 2),
                      significant(small["median_ms"], 2)])
    return table(["linearisations", "1000 keyframes, ms", "passes", "300 keyframes, ms"], cells)


@maker("docs/estimators/trajectory_iekf.md", "iekf-missions", **IEKF)
def iekf_missions(work):
    rows = work.benchmark("iekf", "trajectory_iekf_benchmark")
    cells = []
    for keyframes, updates_, loops in ((1000, 100, 3), (1000, 900, 1), (10000, 100, 3),
                                       (10000, 300, 1)):
        row = row_of(rows, f"mission/keyframes:{keyframes}/updates:{updates_}/loops:{loops}")
        cells.append([keyframes, f"{updates_} × {loops}",
                      f"{significant(row['updates_ms'] / 1e3, 2)} s",
                      f"{significant(row['longest_ms'], 2)} ms",
                      f"{significant(row['covariances_ms'], 2)} ms",
                      f"{significant(row['MB'], 2)} MB",
                      "dense" if 2 * row["dense_motions"] > keyframes else "few loops"])
    return table(["keyframes", "updates × loops", "all updates", "longest step", "all covariances",
                  "covariance held", "form"], cells)
