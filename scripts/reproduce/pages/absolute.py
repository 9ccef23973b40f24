"""docs/absolute_measurements.md: compass, fixes and holes in drawn measurements."""

import math

from layout import fixed, interval, significant, table
from maker import maker

PAGE = "docs/absolute_measurements.md"
FILTERS = ("ekf", "trajectory_iekf")
GRAPH = "sparse_gauss_newton"


def _errors(study, estimators, cell):
    return [interval(study.row(one, "mean_position_error_m", **cell), 2) for one in estimators]


@maker(PAGE, "compass", "slow", "`fathom compare configs/studies/compass.yaml`", 5)
def compass(work):
    study = work.study("compass", "configs/studies/compass.yaml")
    rows = []
    for reach in (0, 2):
        cases = [("none", "1°", "0°")]
        cases += [(every, sigma, "0°")
                  for sigma in ("5°", "1°", "0.1°") for every in ("10 s", "1 s")]
        cases += [("1 s", "1°", "1°"), ("1 s", "0.1°", "1°")]
        for every, sigma, bias in cases:
            cell = {"interval": every, "sigma": sigma, "bias": bias, "reach_m": reach}
            rows.append(["yes" if reach else "no", every, "–" if every == "none" else sigma,
                         "–" if every == "none" else bias,
                         *_errors(study, (*FILTERS, GRAPH), cell),
                         *(interval(study.row(one, "anees", **cell), 2) for one in ("ekf", GRAPH))])
    return table(["loops", "every", "σ", "bias", "error (m): ekf", "trajectory_iekf", GRAPH,
                  "ANEES: ekf", GRAPH], rows)


ROBUST = ("ekf", "ekf_gate", "iekf_gate", "smoother_gm", "plain", "huber", "dcs", "truncated",
          "ceres_cauchy")


@maker(PAGE, "fixes", "slow", "`fathom compare configs/studies/fixes.yaml`", 10)
def fixes(work):
    study = work.study("fixes", "configs/studies/fixes.yaml")
    rows = []
    for reach in (0, 2):
        cases = [("none", "none"), ("60 s", "none"), ("60 s", "20 %")]
        cases += [("10 s", jumps) for jumps in ("none", "5 %", "20 %")]
        for every, jumps in cases:
            cell = {"interval": every, "jumps": jumps, "reach_m": reach}
            errors = _errors(study, ROBUST, cell)
            rows.append(["yes" if reach else "no", every, jumps,
                         significant(study.mean("ekf", "absolute_measurements", **cell)), *errors])
    return table(["loops", "every", "jumps", "measurements", *ROBUST], rows)


@maker(PAGE, "holes", "slow", "`fathom compare configs/studies/holes.yaml`", 5)
def holes(work):
    study = work.study("holes", "configs/studies/holes.yaml")
    rows = []
    for known, sensors in (("loops", ("no", "no")), ("loops, compass", ("yes", "no")),
                           ("loops, fixes", ("no", "every 30 s")),
                           ("all", ("yes", "every 30 s"))):
        for count, length in ((0, "10 s"), (1, "10 s"), (4, "10 s"), (1, "60 s"), (4, "60 s")):
            cell = {"count": count, "length": length, "compass": sensors[0], "fixes": sensors[1]}
            rows.append([known, count, length if count else "–",
                         *_errors(study, (*FILTERS, "incremental_smoother", GRAPH), cell),
                         *(interval(study.row(one, "anees", **cell), 2)
                           for one in ("ekf", "trajectory_iekf", GRAPH))])
    return table(["known by", "holes", "length", "error (m): ekf", "trajectory_iekf",
                  "incremental_smoother", GRAPH, "ANEES: ekf", "trajectory_iekf", GRAPH], rows)


# Name in the table, estimator, settings.
JUDGES = (("ekf_gate", "ekf", ("estimator.gate_probability=0.9999",)),
          ("iekf_gate", "trajectory_iekf",
           ("estimator.gate_probability=0.9999", "estimator.max_iterations=10")),
          *((loss, GRAPH, (f"estimator.loss={loss}",))
            for loss in ("truncated", "dcs", "geman_mcclure")))
JUMP_M = 20
JUMPS = ("dataset.fixes.jump_share=0.2", f"dataset.fixes.jump_m={JUMP_M}")


def _one_run(work):
    """The study's data set as a configuration of `fathom run`, without its jumps."""
    study = (work.top / "configs/studies/fixes.yaml").read_text("utf-8")
    dataset = study[study.index("dataset:"):study.index("estimators:")]
    dataset = dataset.replace(f", jump_m: {JUMP_M}", "")
    path = work.top / work.folder / "oracle.yaml"
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(dataset + f"estimator: {{type: {GRAPH}}}\nevaluation: {{alignment: none}}\n",
                    encoding="utf-8")
    return path


def _positions(path):
    """Of a trajectory in TUM's format."""
    lines = path.read_text("utf-8").splitlines()
    return [tuple(map(float, line.split()[1:3])) for line in lines if not line.startswith("#")]


def _mean_error(estimate, truth):
    return sum(map(math.dist, estimate, truth)) / len(truth)


def _without_jumps(graph, truth):
    """The lines of a g2o file less the fixes that are off, the start's among them."""
    def is_jump(line):
        words = line.split()
        if words[0] != "EDGE_PRIOR_SE2" or float(words[5]) == 0:  # a heading alone
            return False
        return math.dist(map(float, words[2:4]), truth[int(words[1])]) > JUMP_M / 2

    return "".join(line for line in graph.read_text("utf-8").splitlines(True) if not is_jump(line))


def _seed_errors(work, configuration, reach, seed):
    """By column of the table: without jumps, and of each back end and the oracle with them."""
    def run(estimator, settings):
        settings = ("dataset.fixes.interval_s=10", f"dataset.loops.max_distance_m={reach}",
                    f"estimator.type={estimator}", *settings)
        options = [word for one in settings for word in ("--set", one)]
        return work.run("oracle-run", "fathom", "run", configuration, "--seed", seed, *options,
                        "--quiet", "--out", "{out}/run") / "run"

    plain = run(GRAPH, JUMPS)
    truth = _positions(plain / "ground_truth.tum")
    kept = plain / "without_jumps.g2o"
    kept.write_text(_without_jumps(plain / "measurements.g2o", truth), encoding="utf-8")
    oracle = work.run("oracle", "fathom", "solve", kept, "--estimator", GRAPH, "--mode",
                      "incremental", "--quiet", "--out", "{out}/run") / "run"
    folders = [run(GRAPH, ()), plain, oracle,
               *(run(estimator, JUMPS + settings) for _, estimator, settings in JUDGES)]
    return [_mean_error(_positions(one / "trajectory.tum"), truth) for one in folders]


@maker(PAGE, "oracle", "slow", "`fathom run` on the data set of `configs/studies/fixes.yaml`, "
       "`--seed 1` to `40`; oracle: `fathom solve` without the fixes that jumped", 8)
def oracle(work):
    configuration = _one_run(work)
    rows = []
    for reach in (0, 2):
        seeds = [_seed_errors(work, configuration, reach, seed)
                 for seed in range(1, work.size(40, 1) + 1)]
        means = [sum(column) / len(seeds) for column in zip(*seeds)]
        rows.append(["yes" if reach else "no",
                     *(f"{significant(mean)} ({fixed(mean / means[2], 2)})" for mean in means)])
    return table(["loops", "no jumps", "plain", "oracle", *(name for name, *_ in JUDGES)], rows)
