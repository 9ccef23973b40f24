"""docs/real_surveys.md: pictures of an ROV whose cameras look ahead and down."""

import json
import re

from layout import fixed, significant, table
from maker import maker

PAGE = "docs/real_surveys.md"
DATA = "odm_data_haltbrekken_run1"
COUNT = 54
PITCHES = (0.0, -0.3, -0.6, -0.9)  # rad; the program refuses more than 1
PITCH = -0.6
ERROR = "front_end.ransac.max_error_px=20"
BACK_ENDS = (("`trajectory_iekf`", ("type=trajectory_iekf",)),
             ("`sparse_gauss_newton`", ("type=sparse_gauss_newton",)),
             ("`sparse_gauss_newton`, `truncated`", ("type=sparse_gauss_newton", "loss=truncated")))


def _survey(work, side, pitch):
    """An image folder with one pitch for all pictures, as the page makes it."""
    top = work.folder / f"rov-{side}{pitch:g}" / "mav0"
    for name in ("cam0", "altimeter0", "attitude0"):
        (top / name).mkdir(parents=True, exist_ok=True)
    if not (top / "cam0/data").is_symlink():
        (top / "cam0/data").symlink_to((work.data / DATA / side).absolute())
    times = [f"{k}000000000" for k in range(1, COUNT + 1)]
    for name, row in (("cam0", "{t},{side}CameraRun1_{k}.png"), ("altimeter0", "{t},2"),
                      ("attitude0", "{t},0,{pitch:g},0.02")):
        rows = [row.format(t=t, k=k, side=side, pitch=pitch) for k, t in enumerate(times, 1)]
        (top / name / "data.csv").write_text("\n".join(rows) + "\n", encoding="utf-8")
    (top / "cam0/sensor.yaml").write_text("resolution: [1360, 1024]\n"
                                          "intrinsics: [1240, 1240, 679.5, 511.5]\n", "utf-8")
    return top.parent


@maker(PAGE, "oblique", "slow", "`fathom calibrate rov`, as above", 3, needs=(f"{DATA}/Left",))
def oblique(work):
    rows = []
    for pitch in work.size(PITCHES, PITCHES[:1]):
        text = work.output("oblique", "fathom", "calibrate", str(_survey(work, "Left", pitch)))
        found, tried = re.search(r"(\d+) of (\d+) pairs of near pictures register", text).groups()
        rows.append([fixed(pitch, 1), f"{found} of {tried}"])
    return table(["stated pitch (rad)", "consecutive pairs that register"], rows)


def _run(work, side, estimator):
    settings = (*(f"estimator.{s}" for s in estimator), ERROR)
    return work.run(f"rov-{side}", "fathom", "run", str(_survey(work, side, PITCH)), "--quiet",
                    "--no-mosaic", "--cache", str((work.folder / "cache").absolute()),
                    *(word for s in settings for word in ("--set", s)), "--out", "{out}/run",
                    statuses=(0, 1)) / "run"


def _apart(work, one, other):
    text = work.output("rov-apart", "fathom", "evaluate", str(one), str(other), "--align", "se2")
    return float(re.search(r"mean position error \(m\)\s+(\S+)", text).group(1))


@maker(PAGE, "oblique-cameras", "slow", f"`fathom run` of either camera with `--set {ERROR}`, and "
       "`fathom evaluate LEFT/frames.tum RIGHT/frames.tum --align se2`", 4,
       needs=(f"{DATA}/Left", f"{DATA}/Right"))
def oblique_cameras(work):
    rows = []
    for name, estimator in work.size(BACK_ENDS, BACK_ENDS[:1]):
        runs = [_run(work, side, estimator) for side in ("Left", "Right")]
        if not rows:
            dead = [run / "dead_reckoning.tum" for run in runs]
            rows.append(["visual odometry alone", "", "", significant(_apart(work, *dead))])
        loops = [json.loads((run / "metrics.json").read_text("utf-8"))["loops_kept"]
                 for run in runs]
        frames = [run / "frames.tum" for run in runs]
        rows.append([name, *loops, significant(_apart(work, *frames))])
    return table(["", "loops, left", "loops, right", "left from right (units)"], rows)
