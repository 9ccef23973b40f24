"""docs/which_back_end.md: the regime studies."""

from layout import code, significant, table
from maker import maker

PAGE = "docs/which_back_end.md"
CIRCUIT, LEGS = "configs/studies/regimes.yaml", "configs/studies/regimes_survey.yaml"
HOW = f"`fathom compare {CIRCUIT}`"
CLOSED = ("dataset.mission.loop_overrun_m=0", "dataset.loops.max_distance_m=1.2")
FILTERS = ("ekf", "iekf_1", "iekf_3", "iekf_10")


# Costs are among the figures, so one trial at a time.
def _circuit(work):
    return work.study("regimes", CIRCUIT, jobs=1)


def _legs(work):
    return work.study("regimes-survey", LEGS, jobs=1)


def _cell(noise, length, loops=6):
    return {"heading_noise_rad": noise, "length_m": length, "loops": loops}


def _with_failures(study, text, estimator, cell):
    failures = int(float(study.row(estimator, "chi2", **cell)["failures"]))
    return f"{text} ({failures} failed)" if failures else text


def over_optimum(study, estimator, cell):
    """Mean F over the mean of the optimum's F, trials that are done alone."""
    sums = [0.0, 0.0]
    for run in study.runs_of(estimator, **cell):
        if run["chi2"] and run["outcome"] in ("converged", "iteration_limit"):
            sums[0] += float(run["chi2"])
            sums[1] += float(run["chi2_optimum"])
    return sums[0] / sums[1] if sums[1] else None


def _squares(work, estimators, value):
    study = _circuit(work)
    rows = []
    for length in (40, 160):
        for noise in (0.002, 0.01, 0.05):
            cell = _cell(noise, length)
            rows.append([length, noise, *(_with_failures(study, value(study, e, cell), e, cell)
                                          for e in estimators)])
    return table(["length (m)", "heading noise (rad)", *code(estimators)], rows)


@maker(PAGE, "regimes-chi2", "slow", HOW, 20,
       pictures=("docs/images/regime_map_circuit.svg", "docs/images/regime_map_legs.svg"))
def regimes_chi2(work):
    for name, study in (("circuit", _circuit(work)), ("legs", _legs(work))):
        work.picture(f"docs/images/regime_map_{name}.svg",
                     study.folder / "figures" / "regime_map_loops_6.svg")
    return _squares(work, (*FILTERS, "incremental_smoother"),
                    lambda study, e, cell: significant(over_optimum(study, e, cell)))


@maker(PAGE, "regimes-anees", "slow", HOW, 20)
def regimes_anees(work):
    return _squares(work, (*FILTERS, "incremental_smoother", "sparse_gauss_newton"),
                    lambda study, e, cell: significant(study.mean(e, "anees", **cell)))


def _filters(work, value):
    estimators = ("ekf", "invariant_ekf", "first_estimates_ekf", "iekf_3", "incremental_smoother")
    rows = []
    for name, study, lengths in (("circuit", _circuit(work), (40, 160)),
                                 ("legs", _legs(work), (10, 40))):
        for length in lengths:
            for noise in (0.002, 0.01, 0.05):
                cell = _cell(noise, length)
                rows.append([f"{name}, {length} m", noise,
                             *(_with_failures(study, significant(value(study, e, cell)), e, cell)
                               for e in estimators)])
    return table(["mission", "heading noise (rad)", *code(estimators)], rows)


@maker(PAGE, "regimes-filters-chi2", "slow", f"`fathom compare {CIRCUIT}` and `{LEGS}`", 20)
def regimes_filters_chi2(work):
    return _filters(work, over_optimum)


@maker(PAGE, "regimes-filters-anees", "slow", f"`fathom compare {CIRCUIT}` and `{LEGS}`", 20)
def regimes_filters_anees(work):
    return _filters(work, lambda study, e, cell: study.mean(e, "anees", **cell))


@maker(PAGE, "regimes-cost", "time", f"`fathom compare {CIRCUIT}` and `{LEGS}`, `--jobs 1`", 30)
def regimes_cost(work):
    estimators = (*FILTERS, "incremental_smoother", "sparse_gauss_newton", "ceres_pose_graph")
    rows = []
    for name, study, lengths in (("circuit", _circuit(work), (40, 160)),
                                 ("legs", _legs(work), (10, 40))):
        rows += [[f"{name}, {length} m", 0.01,
                  *(significant(study.mean(e, "cpu_ms", **_cell(0.01, length)))
                    for e in estimators)] for length in lengths]
    return table(["mission", "heading noise (rad)", *code(estimators)], rows)


@maker(PAGE, "regimes-closed", "slow",
       HOW[:-1] + "".join(f" --set {s}" for s in CLOSED) + "`", 20)
def regimes_closed(work):
    study = work.study("regimes-closed", CIRCUIT, CLOSED, jobs=1)
    estimators = (*FILTERS, "incremental_smoother", "sparse_gauss_newton")
    rows = []
    for noise in (0.0005, 0.002, 0.005, 0.01, 0.02, 0.05):
        cell = _cell(noise, 40, loops=1)
        rows.append([noise, *(_with_failures(study, significant(over_optimum(study, e, cell)), e,
                                             cell) for e in estimators)])
    return table(["heading noise (rad)", *code(estimators)], rows)
