"""docs/paper.md: the paper's studies and the one on real pictures."""

from layout import code, interval, significant, table
from maker import maker

ESTIMATORS = ("trajectory_iekf", "ekf", "ceres_pose_graph")
ERROR = "mean_position_error_m"


def _errors(study, unit_scale, digits, **cell):
    return [interval(study.row(e, ERROR, **cell), digits, unit_scale) for e in ESTIMATORS]


def _loops(study, **cell):
    return f"{study.mean_over(ESTIMATORS, 'loop_closures', **cell):.0f}"


@maker("docs/paper.md", "paper-sweep", "slow",
       "`fathom compare configs/studies/paper_simulated.yaml`, association `own`", 30)
def paper_sweep(work):
    study = work.study("paper-simulated", "configs/studies/paper_simulated.yaml")
    rows = []
    for separation in (5, 10):
        for level in range(1, 6):
            cell = {"association": "own", "separation": separation, "noise level": level}
            rows.append([separation, level, interval(study.row("dead_reckoning", ERROR, **cell)),
                         *_errors(study, 1e3, 3, **cell), _loops(study, **cell)])
    return table(["separation", "level", "dead reckoning (m)",
                  *(f"`{e}` (mm)" for e in ESTIMATORS), "loops"], rows)


@maker("docs/paper.md", "paper-pool", "slow",
       "`fathom compare configs/studies/paper_pool.yaml`", 40)
def paper_pool(work):
    study = work.study("paper-pool", "configs/studies/paper_pool.yaml")
    rows = []
    for mission in ("single_loop", "sweep"):
        for separation in (10, 20, 30, 90):
            cell = {"mission": mission, "separation": separation}
            rows.append([mission.replace("_", " "), separation,
                         interval(study.row("dead_reckoning", ERROR, **cell)),
                         *_errors(study, 1, 2, **cell), _loops(study, **cell)])
    return table(["mission", "separation", "dead reckoning", *code(ESTIMATORS), "loops"], rows)


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
