"""F of the estimators on recorded graphs: docs/estimators/*.md."""

import json

from layout import significant, table
from maker import maker

# Least F that independent solvers (g2o, GTSAM, Ceres) found; tests/estimators/real_log_test.cpp.
OPTIMA = {"intel": 45.0047, "CSAIL": 40.5551, "manhattan": 3549.0368, "M3500": 137.913,
          "ring": 11.1631}


def _graphs(*names):
    return tuple(f"pose_graphs/{name}.g2o" for name in names)


def _text(f):
    return f"{f:.5g}"


@maker("docs/estimators/ceres_pose_graph.md", "ceres-iterations", "quick",
       "`fathom solve GRAPH.g2o --estimator ceres_pose_graph --mode batch`, without and with "
       "`--set estimator.initial_trust_region=1e4`", 0.2, needs=_graphs(*OPTIMA))
def ceres_iterations(work):
    def row(name, *more):
        return [name, *(work.solve(g, "--estimator", "ceres_pose_graph", *more,
                                   mode="batch")["iterations"] for g in OPTIMA)]

    return table(["iterations, batch", *OPTIMA],
                 [row("10¹⁶ (default)"),
                  row("10⁴", "--set", "estimator.initial_trust_region=1e4")])


@maker("docs/estimators/ceres_pose_graph.md", "ceres-optima", "quick",
       "`fathom solve GRAPH.g2o --estimator ceres_pose_graph --mode batch`", 0.2,
       needs=_graphs(*OPTIMA))
def ceres_optima(work):
    rows = []
    for graph, optimum in OPTIMA.items():
        done = work.solve(graph, "--estimator", "ceres_pose_graph", mode="batch")
        rows.append([graph, done["keyframes"], done["keyframes"] - 1 + done["registrations"],
                     f"{done['chi2_initial']:.7g}", f"{optimum:.8g}",
                     f"{done['chi2']:.8g}"])
    return table(["graph", "poses", "edges", "F at odometry", "optimum", "F reached"], rows)


TOLERANCES = ("1e-5", "1e-6", "1e-7")


@maker("docs/estimators/incremental_smoother.md", "smoother-tolerance", "quick",
       "`fathom solve GRAPH.g2o --estimator incremental_smoother --set estimator.tolerance=T`, "
       "over F of `--estimator sparse_gauss_newton`", 0.3,
       needs=_graphs("manhattan", "M3500", "intel"))
def smoother_tolerance(work):
    rows = []
    for graph in ("manhattan", "M3500", "intel"):
        least = work.solve(graph, "--estimator", "sparse_gauss_newton", mode="batch")["chi2"]
        over = (work.solve(graph, "--estimator", "incremental_smoother", "--set",
                           f"estimator.tolerance={tolerance}")["chi2"] - least
                for tolerance in TOLERANCES)
        rows.append([graph, f"{least:.6g}", *(significant(one, 2) for one in over)])
    return table(["graph", "F at the optimum", *TOLERANCES], rows)


@maker("docs/estimators/ekf.md", "ekf-graphs", "quick",
       "`fathom solve GRAPH.g2o --estimator ekf`", 0.2, needs=_graphs("CSAIL", "ring", "intel"))
def ekf_graphs(work):
    return table(["graph", "F", "optimum"],
                 [[g, _text(work.solve(g, "--estimator", "ekf")["chi2"]), f"{OPTIMA[g]:.8g}"]
                  for g in ("CSAIL", "ring", "intel")])


def _beside_the_ekf(estimator, name):
    @maker(f"docs/estimators/{estimator}.md", name, "quick",
           f"`fathom solve GRAPH.g2o --estimator {estimator}`, last column `--estimator ekf`", 0.4,
           needs=_graphs("CSAIL", "ring", "intel"))
    def graphs(work):
        return table(["graph", "F", "optimum", "[EKF](ekf.md)"],
                     [[g, _text(work.solve(g, "--estimator", estimator)["chi2"]),
                       f"{OPTIMA[g]:.8g}", _text(work.solve(g, "--estimator", "ekf")["chi2"])]
                      for g in ("CSAIL", "ring", "intel")])


_beside_the_ekf("invariant_ekf", "invariant-graphs")
_beside_the_ekf("first_estimates_ekf", "first-estimates-graphs")


@maker("docs/adapters.md", "mrpt-graphs", "slow",
       "`fathom solve GRAPH.g2o --estimator mrpt --mode batch`", 0.5, needs=_graphs(*OPTIMA))
def mrpt_graphs(work):
    plugin = str((work.build / "adapters/mrpt.so").absolute())
    rows = []
    for graph, optimum in OPTIMA.items():
        done = work.solve(graph, "--estimator", "mrpt", "--plugin", plugin, mode="batch")
        rows.append([graph, done["keyframes"], f"{optimum:.8g}", f"{done['chi2']:.8g}"])
    return table(["graph", "poses", "optimum", "F reached"], rows)


@maker("docs/estimators/trajectory_iekf.md", "iekf-graphs", "quick",
       "`fathom solve GRAPH.g2o --estimator trajectory_iekf`, the heads being options of "
       "`--set estimator.`; last column `--estimator ekf`", 0.5,
       needs=_graphs("CSAIL", "ring", "intel"))
def iekf_graphs(work):
    def f(graph, *settings, estimator="trajectory_iekf"):
        pairs = [part for s in settings for part in ("--set", f"estimator.{s}")]
        return _text(work.solve(graph, "--estimator", estimator, *pairs)["chi2"])

    rows = [[g, f"{OPTIMA[g]:.8g}", f(g, "max_iterations=1"), f(g, "max_iterations=3"), f(g),
             f(g, "max_iterations=10"), f(g, "max_iterations=10", "safeguard=true"),
             f(g, estimator="ekf")] for g in ("CSAIL", "ring", "intel")]
    return table(["graph", "optimum", "`max_iterations=1`", "`max_iterations=3`", "default, 5",
                  "`max_iterations=10`", "that, `safeguard=true`", "[EKF](ekf.md)"], rows)


def _without_loop(lines, index):
    return "\n".join(lines[:index] + lines[index + 1:]) + "\n"


def _quantile(values, share):
    values = sorted(values)
    place = share * (len(values) - 1)
    low = int(place)
    high = min(low + 1, len(values) - 1)
    return values[low] + (place - low) * (values[high] - values[low])


def _rises(work, graph):
    """Of each loop, by how much the optimum's F falls without it."""
    def optimum(file, name):
        folder = work.run(name, "fathom", "solve", file, "--mode", "batch", "--estimator",
                          "sparse_gauss_newton", "--quiet", "--out", "{out}/run")
        return json.loads((folder / "run" / "metrics.json").read_text("utf-8"))["chi2"]

    whole = optimum(work.graph(graph), f"left-out-{graph}")
    with open(work.graph(graph), encoding="utf-8") as file:
        lines = file.read().split("\n")
    loops = [i for i, line in enumerate(lines) if line.startswith("EDGE_SE2 ")
             and abs(int(line.split()[1]) - int(line.split()[2])) != 1]
    for i in loops[:work.size(len(loops), 2)]:
        reduced = work.folder / f"{graph}-left-out.g2o"
        reduced.write_text(_without_loop(lines, i), encoding="utf-8")
        yield whole - optimum(str(reduced), f"left-out-{graph}-{i}")


# 1 to 3 of these are χ²; `default` is the 99.98 % quantile, and the shares are the defaults of
# estimator.truncated.scale_factor, reject_at and least_scale_share.
_DEFAULT_SCALE, _FACTOR, _LEAST = 19.7, 10 / 1.5, 0.01


@maker("docs/robustness.md", "left-out", "slow",
       "`fathom solve GRAPH.g2o --mode batch --estimator sparse_gauss_newton`, with each loop left "
       "out in turn", 15, needs=_graphs("ring", "intel", "CSAIL", "manhattan", "MIT", "M3500"))
def left_out(work):
    rows = [["χ²₃", "2.37", "6.25", "11.3", "", "", significant(_DEFAULT_SCALE)]]
    for graph in ("ring", "intel", "CSAIL", "manhattan", "MIT", "M3500"):
        rises = list(_rises(work, graph))
        ninth, largest = _quantile(rises, 0.9), max(rises)
        scale = min(_DEFAULT_SCALE, max(_LEAST * _DEFAULT_SCALE, _FACTOR * ninth))
        rows.append([f"{graph} ({len(rises)})", significant(_quantile(rises, 0.5), 2),
                     significant(ninth, 2),
                     significant(_quantile(rises, 0.99), 2) if len(rises) >= 100 else "",
                     significant(largest, 2), significant(largest / ninth, 2),
                     significant(scale, 2)])
    return table(["", "median", "90 %", "99 %", "largest", "largest / 90 %", "c²"], rows)
