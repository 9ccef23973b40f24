"""docs/paper.md: the paper's studies and the one on real pictures."""

from layout import code, interval, significant, table
from maker import maker

ESTIMATORS = ("trajectory_iekf", "ekf", "ceres_pose_graph")
OF_THE_SWEEP = ("trajectory_iekf", "iekf_1", "ekf", "ceres_pose_graph")
ERROR = "mean_position_error_m"
HONESTY = {"anees": "ANEES", "mean_nis_truth": "NIS against truth",
           "picture_error_correlation": "correlation in a picture",
           "chi2_per_dof": "F per degree of freedom"}
SWEEP = "`fathom compare configs/studies/paper_simulated.yaml`"


def _errors(study, unit_scale, digits, estimators=ESTIMATORS, **cell):
    return [interval(study.row(e, ERROR, **cell), digits, unit_scale) for e in estimators]


def _loops(study, **cell):
    return f"{study.mean_over(ESTIMATORS, 'loop_closures', **cell):.0f}"


def _sweep(work):
    return work.study("paper-simulated", "configs/studies/paper_simulated.yaml", jobs=2)


# The paper's figures 5, 6 and 8: pictures of the docs by figures of the studies.
SWEEP_PICTURES = {
    **{f"docs/images/paper_noise_{s}.svg": f"error_by_noise_level_separation_{s}.svg"
       for s in (5, 10)},
    **{f"docs/images/paper_sweep_{s}.svg": f"trajectories_separation_{s}_noise_level_5.svg"
       for s in (5, 10)}}
POOL_PICTURES = {
    f"docs/images/pool_{mission}.svg": f"trajectories_mission_{mission}_separation_30.svg"
    for mission in ("single_loop", "sweep")}


def _take_pictures(work, study, pictures):
    for target, source in pictures.items():
        work.picture(target, study.folder / "figures" / source)


@maker("docs/paper.md", "paper-sweep", "slow", SWEEP, 30, pictures=tuple(SWEEP_PICTURES))
def paper_sweep(work):
    study = _sweep(work)
    _take_pictures(work, study, SWEEP_PICTURES)
    rows = []
    for separation in (5, 10):
        for level in range(1, 6):
            cell = {"separation": separation, "noise level": level}
            rows.append([separation, level, interval(study.row("dead_reckoning", ERROR, **cell)),
                         *_errors(study, 1e3, 3, OF_THE_SWEEP, **cell), _loops(study, **cell)])
    return table(["separation", "level", "dead reckoning (m)",
                  *(f"`{e}` (mm)" for e in OF_THE_SWEEP), "loops"], rows)


@maker("docs/paper.md", "paper-consistency", "slow", SWEEP, 1)
def paper_consistency(work):
    study = _sweep(work)
    rows = []
    for separation in (5, 10):
        for level in (1, 5):
            for estimator in OF_THE_SWEEP:
                cell = {"separation": separation, "noise level": level}
                row = [study.row(estimator, metric, **cell)
                       for metric in ("anees", "share_inside_2_sigma", "chi2_gap")]
                rows.append([separation, level, f"`{estimator}`",
                             *(interval(one) for one in row)])
    return table(["separation", "level", "estimator", "ANEES", "inside 2σ", "F above the optimum"],
                 rows)


@maker("docs/paper.md", "paper-bounds", "slow", SWEEP, 1)
def paper_bounds(work):
    study = _sweep(work)
    rows = []
    for separation in (5, 10):
        for level in range(1, 6):
            cell = {"separation": separation, "noise level": level}
            bounds = [study.bounds(e, **cell) for e in ("dead_reckoning", "trajectory_iekf")]
            rows.append([separation, level,
                         *(significant(scale * one[key]) for one, scale in
                           zip(bounds, (1, 1e3)) for key in ("empirical_m", "estimated_m"))])
    return table(["separation", "level", "dead reckoning, empirical (m)", "estimated (m)",
                  "`trajectory_iekf`, empirical (mm)", "estimated (mm)"], rows)


@maker("docs/paper.md", "paper-cost", "time",
       "`fathom compare configs/studies/paper_separation.yaml`", 15)
def paper_cost(work):
    study = work.study("paper-separation", "configs/studies/paper_separation.yaml", jobs=1)
    rows = []
    for separation in (2, 3, 5, 10):
        cell = {"separation": separation}
        for estimator in OF_THE_SWEEP:
            mean = {m: study.mean(estimator, m, **cell) for m in
                    ("keyframes", "registrations", ERROR, "total_ms", "total_with_covariance_ms")}
            rows.append([separation, f"{mean['keyframes']:.0f}", f"{mean['registrations']:.0f}",
                         f"`{estimator}`", f"{1e3 * mean[ERROR]:.1f}",
                         significant(mean["total_ms"], 2),
                         significant(mean["total_with_covariance_ms"], 2)])
    return table(["separation", "keyframes", "registrations", "estimator", "error (mm)",
                  "estimate (ms)", "estimate and covariance (ms)"], rows)


@maker("docs/paper.md", "paper-pool", "slow",
       "`fathom compare configs/studies/paper_pool.yaml`", 40, pictures=tuple(POOL_PICTURES))
def paper_pool(work):
    study = work.study("paper-pool", "configs/studies/paper_pool.yaml")
    _take_pictures(work, study, POOL_PICTURES)
    rows = []
    for mission in ("single_loop", "sweep"):
        for separation in (10, 20, 30, 90):
            cell = {"mission": mission, "separation": separation}
            rows.append([mission.replace("_", " "), separation,
                         interval(study.row("dead_reckoning", ERROR, **cell)),
                         *_errors(study, 1, 2, **cell), _loops(study, **cell)])
    return table(["mission", "separation", "dead reckoning", *code(ESTIMATORS), "loops"], rows)


@maker("docs/paper.md", "paper-pool-consistency", "slow",
       "`fathom compare configs/studies/paper_pool.yaml`", 1)
def paper_pool_consistency(work):
    study = work.study("paper-pool", "configs/studies/paper_pool.yaml")
    rows = []
    for mission in ("single_loop", "sweep"):
        for separation in (10, 20, 30, 90):
            cell = {"mission": mission, "separation": separation}
            of = {m: study.row("trajectory_iekf", m, **cell) for m in
                  ("registrations", "keyframes", *HONESTY)}
            rows.append([mission.replace("_", " "), separation,
                         significant(of["registrations"]["mean"] / of["keyframes"]["mean"], 2),
                         *(interval(of[m], 2) for m in HONESTY)])
    return table(["mission", "separation", "loops a keyframe", *HONESTY.values()], rows)


@maker("docs/paper.md", "paper-real", "slow",
       "`fathom compare configs/studies/real_pictures.yaml`", 15, needs=("copr",))
def paper_real(work):
    study = work.study("real-pictures", "configs/studies/real_pictures.yaml",
                       [f"dataset.path={work.data / 'copr'}"])
    shown = {"none": "none", "0.1 m 1 deg": "0.1 m, 1°", "0.2 m 2 deg": "0.2 m, 2°",
             "0.4 m 4 deg": "0.4 m, 4°"}
    rows = [[text, interval(study.row("dead_reckoning", ERROR, **{"added noise": label})),
             *_errors(study, 1, 2, **{"added noise": label})] for label, text in shown.items()]
    return table(["added noise a frame", "dead reckoning", *code(ESTIMATORS)], rows)
