"""docs/paper.md: the paper's experiments with its own registration, beside Fathom's."""

from layout import interval, significant, table
from maker import maker
from pair_map import write_pair_map

ERROR = "mean_position_error_m"
# The study of Fathom's registration under the conditions of the paper's: no more than the pictures'
# features, matches and decision differ.
LEVEL = ("dataset.altitude.amplitude_m=0", "dataset.altitude.altimeter_sigma_m=0",
         "dataset.attitude.both_sigma_rad=0", "front_end.covariance.altitude_sigma_m=0",
         "front_end.covariance.tilt_sigma_rad=0", "surveys=5", "trials=4")


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
TRAJECTORIES = "docs/images/paper_registration_sweep.svg"
PAIRS = "docs/images/paper_registration_pairs.svg"
FIGURE_6 = {"separation": 10, "noise level": 2}


@maker("docs/paper.md", "paper-registration", "slow", HOW, 25,
       pictures=(*FIGURE_5, TRAJECTORIES, PAIRS))
def paper_registration(work):
    studies = _sweep(work)
    paper = studies["the paper's"]
    for target, source in FIGURE_5.items():
        work.picture(target, paper.folder / "figures" / source)
    work.picture(TRAJECTORIES,
                 paper.folder / "figures" / "trajectories_separation_10_noise_level_2.svg")
    work.picture(PAIRS, write_pair_map(paper, "trajectory_iekf", FIGURE_6))
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
