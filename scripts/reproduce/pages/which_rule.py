"""docs/which_back_end.md: the rule, judged on recorded graphs and on drawn logs."""

import json
import math
import re

from layout import code, significant, table
from maker import maker

PAGE = "docs/which_back_end.md"
GRAPHS = ("ring", "CSAIL", "MIT", "intel", "manhattan", "M3500", "M3500a", "M3500b", "M3500c")
NEEDS = tuple(f"pose_graphs/{graph}.g2o" for graph in GRAPHS)
HOW = ("`fathom solve GRAPH.g2o --estimator NAME --mode incremental`, judged by its optimum, which "
       "is `sparse_gauss_newton` in batch")
SETTINGS = {f"iekf_{n}": ("--set", f"estimator.max_iterations={n}") for n in (3, 5, 10)}
# The others are as large as the last of these, and filters do worse there (docs/cost.md).
FOR_FILTERS = GRAPHS[:7]
RECORDED = ("incremental_smoother", "sparse_gauss_newton", "iekf_3", "iekf_5", "iekf_10", "ekf",
            "invariant_ekf")
LINE = re.compile(
    r"for this log: (?P<picked>\w+), since its loops miss by up to (?P<rad>\S+) rad \(sigma "
    r"(?P<rad_sigma>\S+)\).* and by up to (?P<m>\S+) m \(sigma (?P<m_sigma>\S+)\); (?P<loops>\d+) "
    r"loops?, (?P<per_keyframe>\S+) a keyframe, the longest over (?P<longest>\S+) m; one "
    r"linearisation leaves (?P<curvature>\S+) sigma")


def terms(work, graph):
    """What `fathom select` says of a graph, by name."""
    return LINE.match(work.output(f"terms-{graph}", "fathom", "select", work.graph(graph)))


def _solved(work, graph, name):
    """Folder of an incremental run that was judged by the graph's optimum."""
    optimum = work.run(f"optimum-{graph}", "fathom", "solve", work.graph(graph), "--mode", "batch",
                       "--estimator", "sparse_gauss_newton", "--quiet", "--out", "{out}/run")
    estimator = "trajectory_iekf" if name in SETTINGS else name
    return optimum / "run", work.run(
        f"judged-{graph}", "fathom", "solve", work.graph(graph), "--mode", "incremental",
        "--estimator", estimator, *SETTINGS.get(name, ()), "--ground-truth",
        optimum / "run/trajectory.tum", "--quiet", "--out", "{out}/run", statuses=(0, 1)) / "run"


def _metrics(folder):
    return json.loads((folder / "metrics.json").read_text("utf-8"))


def judged(work, graph, name):
    """Of an estimator on a graph: F over the least, RMS distance to the optimum with keyframe 0
    held, the same after alignment (m), and of dead reckoning the first; None where it failed."""
    optimum, own = _solved(work, graph, name)
    metrics = _metrics(own)
    if metrics["outcome"] not in ("converged", "iteration_limit"):
        return None
    text = work.output("aligned", "fathom", "evaluate", own / "trajectory.tum",
                       optimum / "trajectory.tum", "--align", "se2")
    aligned = float(re.search(r"^ATE RMSE \(m\) +(\S+)$", text, re.MULTILINE)[1])
    return {"f": metrics["chi2"] / _metrics(optimum)["chi2"], "m": metrics["ate_rmse_m"],
            "aligned_m": aligned, "reckoned_m": metrics["dead_reckoning"]["ate_rmse_m"]}


def over(ratio):
    """F over the least: a share below 2, else a factor; infinite: a run that failed."""
    if math.isinf(ratio):
        return "failed"
    if ratio < 2:
        return f"+{significant(max(100 * (ratio - 1), 0), 2)} %" if ratio > 1 + 1e-6 else "least"
    return f"× {significant(ratio, 2)}" if ratio < 1e5 else f"× {ratio:.0e}"


def metres(value):
    return significant(value, 2) if value >= 1e-4 else "< 0.0001"


def _graphs(work, graphs=GRAPHS):
    return work.size(graphs, graphs[:2])


@maker(PAGE, "rule-terms", "quick", "`fathom select GRAPH.g2o`", 0.3, needs=NEEDS)
def rule_terms(work):
    rows = []
    for graph in _graphs(work):
        found = terms(work, graph)
        rows.append([graph, found["loops"], found["per_keyframe"], found["longest"],
                     f"{found['rad']} ({found['rad_sigma']})", f"{found['m']} ({found['m_sigma']})",
                     found["curvature"], f"`{found['picked']}`"])
    return table(["graph", "loops", "a keyframe", "longest (m)", "heading misfit (rad) (σ)",
                  "position misfit (m) (σ)", "curvature (σ)", "picked"], rows)


@maker(PAGE, "rule-judged", "slow", "`fathom select GRAPH.g2o`, and " + HOW, 3, needs=NEEDS)
def rule_judged(work):
    rows = []
    for graph in _graphs(work):
        picked = terms(work, graph)["picked"]
        of = judged(work, graph, picked)
        rows.append([graph, f"`{picked}`", over(of["f"]), metres(of["m"]),
                     f"{significant(100 * of['m'] / of['reckoned_m'], 2)} %",
                     metres(of["aligned_m"])])
    return table(["graph", "picked", "F over the least", "RMS to the optimum (m)",
                  "of dead reckoning's", "RMS, aligned (m)"], rows)


@maker(PAGE, "rule-f", "slow", HOW, 15, needs=NEEDS)
def rule_f(work):
    rows = []
    for graph in _graphs(work, FOR_FILTERS):
        found = [judged(work, graph, name) for name in RECORDED]
        rows.append([graph, *(over(of["f"]) if of else "failed" for of in found)])
    return table(["F over the least", *code(RECORDED)], rows)


@maker(PAGE, "rule-position", "slow", HOW, 15, needs=NEEDS)
def rule_position(work):
    rows = []
    for graph in _graphs(work, FOR_FILTERS):
        found = [judged(work, graph, name) for name in RECORDED]
        rows.append([graph, metres(found[0]["reckoned_m"]),
                     *(f"{metres(of['m'])} ({metres(of['aligned_m'])})" if of else "failed"
                       for of in found)])
    return table(["RMS to the optimum (m)", "dead reckoning", *code(RECORDED)], rows)


# Drawn logs.
STUDY = "configs/studies/which_back_end.yaml"
LIMIT_RAD, LIMIT_SIGMA = 0.3, 1.0  # of include/fathom/harness/advice.hpp
MISSIONS = [(mission, reach) for mission in ("circuit", "legs", "streets") for reach in (1.2, 4)]
DRAWN = RECORDED
FILTERS = RECORDED[2:]


def _drawn(work):
    """By mission: a dict of estimators' rows of runs.csv for each log that has a loop."""
    study = work.study("which-back-end", STUDY, jobs=1)
    for mission, reach in MISSIONS:
        logs = {}
        for name in DRAWN:
            for run in study.runs_of(name, mission=mission, reach_m=reach):
                if run["loop_misfit_rad"]:
                    key = (run["heading_noise_rad"], run["trial"])
                    logs.setdefault(key, {})[name] = run
        yield mission, reach, list(logs.values())


def _f(run):
    """F over the optimum's; infinite where the run failed."""
    if run["outcome"] not in ("converged", "iteration_limit"):
        return float("inf")
    return float(run["chi2"]) / float(run["chi2_optimum"])


def _is_wrong(run):
    """Whether it ended in another minimum than the optimum's."""
    return _f(run) * float(run["chi2_optimum"]) > 2 * float(run["chi2_optimum"]) + 5


def _misfit(log):
    return float(log["ekf"]["loop_misfit_rad"])


def _picked(log):
    beyond = _misfit(log) > LIMIT_RAD
    return log["sparse_gauss_newton" if beyond else "incremental_smoother"]


@maker(PAGE, "rule-drawn", "slow", f"`fathom compare {STUDY}`", 15)
def rule_drawn(work):
    rows = []
    for mission, reach, logs in _drawn(work):
        wrong = [log for log in logs if _is_wrong(log["incremental_smoother"])]
        low = min((_misfit(log) for log in wrong), default=None)
        rows.append([mission, reach, len(logs), sum(_misfit(log) > LIMIT_RAD for log in logs),
                     len(wrong), significant(low), sum(_is_wrong(_picked(log)) for log in logs),
                     over(max((_f(_picked(log)) for log in logs), default=1.0))])
    return table(["mission", "reach (m)", "logs with loops", "beyond 0.3 rad",
                  "`incremental_smoother` in a wrong minimum", "their least misfit (rad)",
                  "picked one in a wrong minimum", "F of the picked, worst"], rows)


@maker(PAGE, "rule-filters", "slow", f"`fathom compare {STUDY}`", 15)
def rule_filters(work):
    rows = []
    groups = {}
    for _, _, logs in _drawn(work):
        for log in logs:
            curvature = float(log["ekf"]["loop_curvature"])
            place = sum(curvature >= limit for limit in (0.1, LIMIT_SIGMA, 10, 100))
            groups.setdefault(place, []).append(log)
    names = ("below 0.1", "0.1 to 1", "1 to 10", "10 to 100", "100 and more")
    for place, logs in sorted(groups.items()):
        cells = [f"{over(max(_f(log[e]) for log in logs))}; "
                 f"{sum(_f(log[e]) > 1.01 for log in logs)}"
                 for e in FILTERS]
        rows.append([names[place], len(logs), *cells])
    return table(["curvature (σ)", "logs", *code(FILTERS)], rows)


def _error(run):
    return float(run["ate_rmse_m"]) if _f(run) != float("inf") else float("inf")


def _wins(logs, one, other, value):
    """In how many logs each of two is better by more than 1 %."""
    first = sum(value(log[one]) < 0.99 * value(log[other]) for log in logs)
    second = sum(value(log[other]) < 0.99 * value(log[one]) for log in logs)
    return f"{first} : {second}"


def _geometric(logs, name):
    """Geometric mean of F over the optimum's, of the runs that are done."""
    ratios = [_f(log[name]) for log in logs if _f(log[name]) != float("inf")]
    mean = math.exp(sum(math.log(max(ratio, 1)) for ratio in ratios) / len(ratios))
    converged = sum(log[name]["outcome"] == "converged" for log in logs)
    return f"{significant(mean)}; {converged}"


@maker(PAGE, "rule-iterations", "slow", f"`fathom compare {STUDY}`", 15)
def rule_iterations(work):
    rows = []
    for mission, reach, logs in _drawn(work):
        logs = [log for log in logs if _misfit(log) <= LIMIT_RAD]
        rows.append([mission, reach, len(logs),
                     *(_wins(logs, one, other, value) for value in (_f, _error)
                       for one, other in (("iekf_5", "iekf_3"), ("iekf_5", "iekf_10"))),
                     *(_geometric(logs, f"iekf_{n}") for n in (3, 5, 10))])
    return table(["mission", "reach (m)", "logs", "F lower, 5 : 3", "5 : 10",
                  "RMS error lower, 5 : 3", "5 : 10", "F over the optimum: `iekf_3`", "`iekf_5`",
                  "`iekf_10`"], rows)


FEW = "configs/studies/few_loops.yaml"


@maker(PAGE, "rule-cost", "time", f"`fathom compare {FEW}`", 3)
def rule_cost(work):
    study = work.study("few-loops", FEW, jobs=1)
    names = ("trajectory_iekf", "incremental_smoother", "sparse_gauss_newton", "ekf")
    rows = []
    for noise in (0.0001, 0.002):
        for probability in (0.004, 0.02):
            cell = {"heading_noise_rad": noise, "probability": probability}
            runs = {name: study.runs_of(name, **cell)[0] for name in names}
            first = runs["trajectory_iekf"]
            rows.append([noise, f"{float(first['registrations']):.0f}",
                         significant(float(first["loop_curvature"])),
                         *(f"{significant(float(run['total_ms']) / 1000, 2)}, "
                           f"{significant(float(run['total_with_covariance_ms']) / 1000, 2)}; "
                           f"{over(_f(run))}" for run in runs.values())])
    return table(["heading noise (rad)", "loops", "curvature (σ)", *code(names)], rows)
