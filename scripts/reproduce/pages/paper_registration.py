"""docs/paper.md: the paper's experiments with its own registration, beside Fathom's."""

from layout import interval, significant, table
from maker import maker
from stored_runs import StoredRuns
from trajectory_maps import pairs_of, svg_of, ways_of

ERROR = "mean_position_error_m"
# The study of Fathom's registration under the conditions of the paper's: no more than the pictures'
# features, matches and decision differ.
LEVEL = ("dataset.altitude.amplitude_m=0", "dataset.altitude.altimeter_sigma_m=0",
         "dataset.attitude.both_sigma_rad=0", "front_end.covariance.altitude_sigma_m=0",
         "front_end.covariance.tilt_sigma_rad=0", "surveys=3", "trials=4")


def _how(configuration, other, settings):
    return (f"`fathom compare configs/studies/{configuration}.yaml`; Fathom's: `fathom compare "
            f"configs/studies/{other}.yaml {' '.join(f'--set {one}' for one in settings)}`")


HOW = _how("paper_registration", "paper_simulated", LEVEL)


def _sweep(work):
    return {"the paper's": work.study("paper-registration",
                                      "configs/studies/paper_registration.yaml"),
            "Fathom's": work.study("paper-conditions", "configs/studies/paper_simulated.yaml",
                                   LEVEL)}


FIGURE_5 = {f"docs/images/paper_registration_noise_{s}.svg":
            f"error_by_noise_level_separation_{s}.svg" for s in (5, 10)}
MAP_6 = "docs/images/paper_registration_map.svg"


def _picture(work, target, study, maps, columns):
    """A picture that is drawn here, kept beside the study's own figures."""
    file = study.folder / target.rpartition("/")[2]
    file.write_text(svg_of(maps, columns), encoding="utf-8")
    work.picture(target, file)


@maker("docs/paper.md", "paper-registration", "slow", HOW, 12, pictures=(*FIGURE_5, MAP_6))
def paper_registration(work):
    studies = _sweep(work)
    paper = studies["the paper's"]
    for target, source in FIGURE_5.items():
        work.picture(target, paper.folder / "figures" / source)
    runs = StoredRuns(paper, {"separation": 10, "noise level": 2})
    _picture(work, MAP_6, paper, [ways_of(runs, "trajectories"), pairs_of(runs, "registered")], 2)
    rows = []
    for separation in (5, 10):
        for level in range(1, 6):
            for name, study in studies.items():
                cell = {"separation": separation, "noise level": level}
                rows.append([separation, level, name,
                             interval(study.row("dead_reckoning", ERROR, **cell)),
                             *(interval(study.row(e, ERROR, **cell), 3, 1e3)
                               for e in ("trajectory_iekf", "iekf_1", "ekf")),
                             _less(study, **cell)])
    return table(["separation", "level", "registration", "dead reckoning (m)",
                  "`trajectory_iekf` (mm)", "`iekf_1` (mm)", "`ekf` (mm)",
                  "`iekf_1` − `trajectory_iekf` (mm)"], rows)


def _less(study, **cell):
    return interval(study.paired("iekf_1", "trajectory_iekf", ERROR, **cell), 2, 1e3)


@maker("docs/paper.md", "paper-registration-loops", "slow", HOW, 1)
def paper_registration_loops(work):
    rows = []
    for separation in (5, 10):
        for level in (1, 2, 5):
            for name, study in _sweep(work).items():
                cell = {"separation": separation, "noise level": level}
                of = {m: study.row("trajectory_iekf", m, **cell) for m in
                      ("registrations_tried", "loop_closures", "loop_precision", "loop_recall",
                       "mean_nis_truth", "picture_error_correlation", "anees")}
                bounds = study.bounds("trajectory_iekf", **cell)
                rows.append([separation, level, name,
                             *(f"{of[m]['mean']:.0f}" for m in
                               ("registrations_tried", "loop_closures")),
                             *(significant(of[m]["mean"]) for m in
                               ("loop_precision", "loop_recall")),
                             *(interval(of[m], 2) for m in
                               ("mean_nis_truth", "picture_error_correlation", "anees")),
                             *(significant(1e3 * bounds[key]) for key in
                               ("empirical_m", "estimated_m"))])
    return table(["separation", "level", "registration", "pairs tried", "loops",
                  "precision", "recall", "NIS against truth", "correlation in a picture", "ANEES",
                  "2σ, empirical (mm)", "estimated (mm)"], rows)


DRIFT = ("dataset.odometry.sigma_x_m=0.001", "dataset.odometry.sigma_y_m=0.001",
         "dataset.odometry.sigma_theta_rad=0.0015", "dataset.odometry.correlated_share=0.0625",
         "dataset.odometry.correlation_length_m=2", "surveys=3", "trials=3")
HIGH, LOW = "dataset.altitude.base_m=2.2", "dataset.altitude.base_m=1.2"
ONLY_90 = "sweep.1.values=[90]"
HOW_POOL = _how("paper_registration_pool", "paper_pool", (HIGH, *DRIFT)) + (
    f"; at 1.2 m both with `--set {LOW} --set {ONLY_90}`")
MAP_8 = "docs/images/paper_registration_pool.svg"
MISSIONS, SEPARATIONS = ("single_loop", "sweep"), (10, 20, 30, 90)


def _pools(work):
    """(altitude, registration, its separations, study)."""
    own, fathom = ("configs/studies/paper_registration_pool.yaml",
                   "configs/studies/paper_pool.yaml")
    name, other = "paper-registration-pool", "pool-conditions"
    return (("2.2 m", "the paper's", SEPARATIONS, work.study(name, own)),
            ("2.2 m", "Fathom's", SEPARATIONS, work.study(other, fathom, (HIGH, *DRIFT))),
            ("1.2 m", "the paper's", (90,), work.study(name, own, (LOW, ONLY_90))),
            ("1.2 m", "Fathom's", (90,), work.study(other, fathom, (LOW, *DRIFT, ONLY_90))))


@maker("docs/paper.md", "paper-registration-pool", "slow", HOW_POOL, 12, pictures=(MAP_8,))
def paper_registration_pool(work):
    pools = _pools(work)
    paper = pools[0][-1]
    maps = [ways_of(StoredRuns(paper, {"mission": mission, "separation": separation}),
                    f"{mission.replace('_', ' ')}, separation {separation}")
            for mission in MISSIONS for separation in SEPARATIONS]
    _picture(work, MAP_8, paper, maps, 4)
    rows = []
    for mission in MISSIONS:
        for altitude, registration, separations, study in pools:
            for separation in separations:
                cell = {"mission": mission, "separation": separation}
                neighbours = StoredRuns(study, cell).share_of_neighbours("trajectory_iekf")
                rows.append([mission.replace("_", " "), altitude, registration, separation,
                             interval(study.row("dead_reckoning", ERROR, **cell)),
                             *(interval(study.row(e, ERROR, **cell), 2, 1e3)
                               for e in ("trajectory_iekf", "ekf")),
                             f"{study.mean('trajectory_iekf', 'loop_closures', **cell):.0f}",
                             f"{100 * neighbours:.0f} %",
                             *(interval(study.row("trajectory_iekf", m, **cell), 2)
                               for m in ("mean_nis_truth", "anees"))])
    return table(["mission", "altitude", "registration", "separation", "dead reckoning (m)",
                  "`trajectory_iekf` (mm)", "`ekf` (mm)", "loops", "neighbours registered",
                  "NIS against truth", "ANEES"], rows)
