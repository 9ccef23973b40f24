"""docs/shared_errors_results.md: by how much the registrations of a picture are not independent,
and what estimators gain that model it."""

from layout import interval, significant, table
from maker import maker

PAGE = "docs/shared_errors_results.md"
ESTIMATOR = "incremental_smoother"


def _of_states(study, **cell):
    return [interval(study.row("states", "mean_position_error_m", **cell), 2, 1e3),
            interval(study.row("states", "anees", **cell), 2),
            significant(study.mean("states", "chi2_per_dof", **cell), 2)]


STATES_HEADER = ["states: error (mm)", "states: ANEES", "states: F per degree of freedom"]


def _rows(study, axis, values, told):
    rows = []
    for value, text in values:
        for reach in (1.3, 1.6, 2.5):
            for label, said in told:
                cell = {axis: value, "reach_m": reach, told_axis(axis): label}
                loops = study.mean(ESTIMATOR, "registrations", **cell)
                keyframes = study.mean(ESTIMATOR, "keyframes", **cell)
                figures = [study.row(ESTIMATOR, metric, **cell) for metric in
                           ("anees", "anchored_anees", "picture_error_correlation")]
                error = study.row(ESTIMATOR, "mean_position_error_m", **cell)
                rows.append([text, significant(loops / keyframes, 2), said, interval(error, 2, 1e3),
                             *(interval(one, 2) for one in figures),
                             significant(study.mean(ESTIMATOR, "mean_nis_truth", **cell)),
                             significant(study.mean(ESTIMATOR, "chi2_per_dof", **cell), 2),
                             *_of_states(study, **cell)])
    return rows


def told_axis(axis):
    return "told_m" if axis == "altimeter_m" else "told"


HEADER = ["loops a keyframe", "stated σ", "error (mm)", "ANEES", "anchored ANEES",
          "correlation in a picture", "NIS against truth", "F per degree of freedom",
          *STATES_HEADER]


@maker(PAGE, "shared-altimeter", "slow",
       "`fathom compare configs/studies/shared_errors_altimeter.yaml`", 60)
def shared_altimeter(work):
    study = work.study("shared-altimeter", "configs/studies/shared_errors_altimeter.yaml", jobs=2)
    values = [(v, f"{100 * v:g} cm") for v in (0, 0.005, 0.01, 0.02)]
    return table(["altimeter", *HEADER],
                 _rows(study, "altimeter_m", values, ((0, "no"), (0.01, "1 cm"))))


@maker(PAGE, "shared-tilt", "slow", "`fathom compare configs/studies/shared_errors_tilt.yaml`", 60)
def shared_tilt(work):
    study = work.study("shared-tilt", "configs/studies/shared_errors_tilt.yaml", jobs=2)
    values = [(v, v) for v in ("0°", "0.5°", "1°", "2°")]
    return table(["roll, pitch", *HEADER],
                 _rows(study, "tilt", values, (("no", "no"), ("1°", "1°"))))


def _attitude_row(study, cell, *first):
    figures = [interval(study.row(ESTIMATOR, metric, **cell), 2)
               for metric in ("anees", "anchored_anees")]
    return [*first, interval(study.row(ESTIMATOR, "mean_position_error_m", **cell), 2, 1e3),
            *figures, significant(study.mean(ESTIMATOR, "mean_nis_truth", **cell)),
            *_of_states(study, **cell)]


ATTITUDE_HEADER = ["error (mm)", "ANEES", "anchored ANEES", "NIS against truth",
                   *STATES_HEADER]


@maker(PAGE, "attitude", "slow", "`fathom compare configs/studies/attitude.yaml`", 15)
def attitude(work):
    study = work.study("attitude", "configs/studies/attitude.yaml", jobs=2)
    rows = []
    for label in ("no", "to 0.5°", "to 0.1°"):
        for reach in (1.3, 2.5):
            cell = {"measured": label, "reach_m": reach}
            loops = study.mean(ESTIMATOR, "registrations", **cell)
            loops /= study.mean(ESTIMATOR, "keyframes", **cell)
            rows.append(_attitude_row(study, cell, label, significant(loops, 2)))
    return table(["measured", "loops a keyframe", *ATTITUDE_HEADER], rows)


@maker(PAGE, "attitude-mounting", "slow",
       "`fathom compare configs/studies/attitude_mounting.yaml`", 10)
def attitude_mounting(work):
    study = work.study("attitude-mounting", "configs/studies/attitude_mounting.yaml", jobs=2)
    rows = [_attitude_row(study, {"mounting": label}, label) for label in ("0°", "0.1°", "0.5°")]
    return table(["error of pitch", *ATTITUDE_HEADER], rows)


def _difference(study, one, other, **cell):
    return interval(study.paired(one, other, "mean_position_error_m", **cell), 2, 1e3)


GRAPHS = ["sparse_gauss_newton", "ceres_pose_graph", "incremental_smoother"]
DRAWN = [(GRAPHS, "graphs, their default", "states"),
         (["iekf_states"], "`trajectory_iekf`", "states"),
         (["ekf_states"], "`ekf`", "states"),
         (["ekf"], "`ekf`, its default", "consider"),
         (["invariant_ekf"], "`invariant_ekf`, its default", "consider"),
         (["first_estimates_ekf"], "`first_estimates_ekf`, its default", "consider"),
         (["sgn_independent"], "graphs", "independent"),
         (["trajectory_iekf"], "`trajectory_iekf`, its default", "independent"),
         (["ekf_independent"], "`ekf`", "independent")]
OF_PICTURES = [("sparse_gauss_newton", "graphs, their default", "states"),
               ("iekf_states", "`trajectory_iekf`", "states"),
               ("ekf_states", "`ekf`", "states"),
               ("invariant_states", "`invariant_ekf`", "states"),
               ("first_estimates_states", "`first_estimates_ekf`", "states"),
               ("iekf_consider", "`trajectory_iekf`", "consider"),
               ("ekf", "`ekf`, its default", "consider"),
               ("invariant_ekf", "`invariant_ekf`, its default", "consider"),
               ("first_estimates_ekf", "`first_estimates_ekf`, its default", "consider"),
               ("sgn_independent", "graphs", "independent"),
               ("trajectory_iekf", "`trajectory_iekf`, its default", "independent"),
               ("ekf_independent", "`ekf`", "independent")]
MODEL_HEADER = ["estimator", "`shared_errors`", "ANEES", "F per degree of freedom", "error (mm)",
                "less graphs, independent (mm)"]


def _model_row(study, name, **cell):
    return [interval(study.row(name, "anees", **cell), 2),
            interval(study.row(name, "chi2_per_dof", **cell), 2),
            interval(study.row(name, "mean_position_error_m", **cell), 2, 1e3),
            "–" if name == "sgn_independent"
            else _difference(study, name, "sgn_independent", **cell)]


@maker(PAGE, "shared-models", "slow",
       "`fathom compare configs/studies/shared_errors_models.yaml`", 20)
def shared_models(work):
    study = work.study("shared-models", "configs/studies/shared_errors_models.yaml", jobs=2)
    rows = [[level, estimator, model, *_model_row(study, name, **{"noise level": level})]
            for level in (2, 5) for name, estimator, model in OF_PICTURES]
    return table(["noise level", *MODEL_HEADER], rows)


@maker(PAGE, "shared-drawn", "slow",
       "`fathom compare configs/studies/shared_errors_drawn.yaml`", 5)
def shared_drawn(work):
    study = work.study("shared-drawn", "configs/studies/shared_errors_drawn.yaml", jobs=2)
    rows = []
    for loops in (1, 6):
        for heading in (0.01, 0.02):
            cell = {"heading": heading, "loops": loops}
            for names, estimator, model in DRAWN:
                figures = [_model_row(study, name, **cell) for name in names]
                assert all(row[:3] == figures[0][:3] for row in figures), (names, cell)
                rows.append([loops, f"{1e3 * heading:g}", estimator, model, *figures[0]])
    return table(["loops at most", "σ of heading (mrad)", *MODEL_HEADER], rows)
