"""docs/absolute_measurements.md: compass, fixes and holes in drawn measurements."""

from layout import interval, significant, table
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
        cases += [(every, sigma, "0°") for sigma in ("5°", "1°", "0.1°") for every in ("10 s", "1 s")]
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
