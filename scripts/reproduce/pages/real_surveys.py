"""docs/real_surveys.md: public photos of a floor, judged by the GPS positions in their EXIF."""

import csv
import json
import re
import sys

from layout import fixed, significant, table
from maker import maker
from positions import between_fixes, poses_of, scale_and_error

PAGE = "docs/real_surveys.md"
PHOTOS = "drone_dataset_brighton_beach/images"
SURVEY = ("--focal-px", "2340", "--reduce", "4")
START = ("dataset.start.heading_rad=-0.785", "dataset.start.sigma_rad=0.1")  # of the camera's yaw
BACK_ENDS = (("`trajectory_iekf`", ("type=trajectory_iekf",)), ("`ekf`", ("type=ekf",)),
             ("`ceres_pose_graph`", ("type=ceres_pose_graph",)),
             ("`incremental_smoother`", ("type=incremental_smoother",)),
             ("`sparse_gauss_newton`", ("type=sparse_gauss_newton",)),
             ("`sparse_gauss_newton`, `truncated`",
              ("type=sparse_gauss_newton", "loss=truncated")))
HOW = "`scripts/photo_survey.py`, `fathom run` and `fathom evaluate`, as above"


def _survey(work, *more):
    """Folder with mav0/ and the references."""
    return work.run("photos-brighton", sys.executable, "scripts/photo_survey.py",
                    str(work.data / PHOTOS), "--out", "{out}/survey", *SURVEY, *more) / "survey"


def _run(work, survey, estimator, settings=()):
    pairs = (*(f"estimator.{s}" for s in estimator), *settings)
    return work.run("run-brighton", "fathom", "run", str(survey), "--quiet", "--no-mosaic",
                    *(word for pair in pairs for word in ("--set", pair)), "--out", "{out}/run",
                    statuses=(0, 1)) / "run"


def _mean_error(work, estimate, reference, alignment):
    text = work.output("error-brighton", "fathom", "evaluate", str(estimate), str(reference),
                       "--align", alignment)
    return float(re.search(r"mean position error \(m\)\s+(\S+)", text).group(1))


def _cells(work, estimate, survey):
    scale, left = scale_and_error(poses_of(estimate), poses_of(survey / "reference.tum"))
    return [significant(_mean_error(work, estimate, survey / "reference.tum", "se2")),
            fixed(scale, 3), significant(left)]


@maker(PAGE, "photos-gps", "slow", HOW, 3, needs=(PHOTOS,))
def photos_gps(work):
    survey = _survey(work)
    rows = []
    for name, estimator in work.size(BACK_ENDS, BACK_ENDS[:1]):
        run = _run(work, survey, estimator)
        if not rows:
            rows.append(["dead reckoning", "", "",
                         *_cells(work, run / "dead_reckoning.tum", survey)])
        metrics = json.loads((run / "metrics.json").read_text("utf-8"))
        rows.append([name, metrics["loops_kept"], significant(metrics["chi2_per_dof"], 2),
                     *_cells(work, run / "trajectory.tum", survey)])
    return table(["", "loops", "F per degree of freedom", "error, rigid (m)", "scale",
                  "error, similarity (m)"], rows)


@maker(PAGE, "photos-held-out", "slow", HOW, 3, needs=(PHOTOS,))
def photos_held_out(work):
    survey = _survey(work, "--fixes", "even")
    rows = []
    for name, estimator in work.size(BACK_ENDS, BACK_ENDS[:1]):
        run = _run(work, survey, estimator, START)
        metrics = json.loads((run / "metrics.json").read_text("utf-8"))
        rows.append([name, metrics["loops_kept"], metrics["absolute_used"],
                     significant(metrics["chi2_per_dof"], 2),
                     significant(_mean_error(work, run / "trajectory.tum",
                                             survey / "held_out.tum", "none"))])
    return table(["", "loops", "fixes used", "F per degree of freedom",
                  "distance from the 9 held-out positions (m)"], rows)


# Seneca: a fixed wing without a gimbal. Its first photo has another size than the others.
SENECA = "odm_data_seneca/images"
SENECA_SURVEY = ("--focal-px", "2509", "--ground-m", "220", "--reduce", "3", "--first",
                 "IMG_0447.jpg", "--last", "IMG_0606.jpg", "--fixes", "even", "--sigma-m", "4")
SENECA_SETTINGS = ("front_end.ransac.max_error_px=25", "dataset.start.heading_rad=-1.13",
                   "dataset.start.sigma_rad=0.3")
# Over a turn without a match nothing is known of the motion; the default is a tenth of a radian.
UNKNOWN = ("front_end.visual_odometry.fallback_sigma_m=50",
           "front_end.visual_odometry.fallback_sigma_rad=1.8")
BATCH = ("--mode", "batch", "--estimator", "sparse_gauss_newton")
GATE = ("--set", "estimator.gate_probability=0.9999")
SOLVERS = (("plain, batch", BATCH),
           *((f"`{loss}`, batch", (*BATCH, "--set", f"estimator.loss={loss}"))
             for loss in ("huber", "dcs", "geman_mcclure", "truncated")),
           ("`trajectory_iekf`", ("--estimator", "trajectory_iekf")),
           ("`incremental_smoother`, gate", ("--estimator", "incremental_smoother", *GATE)))


def _distances(poses, held_out):
    return sorted(abs(poses[time] - place) for time, place in held_out.items() if time in poses)


def _middle(values):
    return (values[(len(values) - 1) // 2] + values[len(values) // 2]) / 2


def _text_of(distances):
    return (f"{significant(_middle(distances))}, "
            f"{significant(sum(distances) / len(distances))}, {significant(distances[-1])}")


def _kept(folder):
    with open(folder / "registrations.csv", newline="", encoding="utf-8") as file:
        return sum(row["fate"] == "used" and float(row["weight"]) > 0.5
                   for row in csv.DictReader(file))


@maker(PAGE, "photos-seneca", "slow", HOW + ", then `fathom solve` on its `measurements.g2o`", 10,
       needs=(SENECA,))
def photos_seneca(work):
    survey = work.run("photos-seneca", sys.executable, "scripts/photo_survey.py",
                      str(work.data / SENECA), "--out", "{out}/survey", *SENECA_SURVEY) / "survey"
    held_out, every = poses_of(survey / "held_out.tum"), poses_of(survey / "reference.tum")
    given = {time: place for time, place in every.items() if time not in held_out}
    rows = [["straight lines between the fixes", *2 * [_text_of(between_fixes(given, held_out))]]]
    rows += [[name] for name, _ in SOLVERS]
    for more in ((), UNKNOWN):
        run = _run(work, survey, ("type=sparse_gauss_newton",), (*SENECA_SETTINGS, *more))
        times = list(poses_of(run / "trajectory.tum"))  # a graph has numbers in their place
        for row, (_, arguments) in zip(rows[1:], SOLVERS):
            done = work.run("solve-seneca", "fathom", "solve", str(run / "measurements.g2o"),
                            *arguments, "--quiet", "--out", "{out}/run", statuses=(0, 1)) / "run"
            poses = dict(zip(times, poses_of(done / "trajectory.tum").values()))
            row.append(f"{_text_of(_distances(poses, held_out))}; {_kept(done)}")
    return table(["median, mean, largest distance (m); loops kept", "default",
                  "σ 50 m and 1.8 rad"], rows)
