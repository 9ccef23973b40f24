"""docs/front_end_results.md, docs/water.md, and the table of the README."""

import json

from layout import fenced, significant, table
from maker import maker

ERROR = "mean_position_error_m"


def _metrics(folder, name):
    return json.loads((folder / "run" / name).read_text("utf-8"))


@maker("docs/front_end_results.md", "sift-contrast", "slow",
       "`fathom compare configs/dunes.yaml --set front_end.features.sift_contrast=C "
       "--set front_end.features.flatten=false --set front_end.decision.method=inliers`", 10,
       needs=("worlds/dunes.jpg",))
def sift_contrast(work):
    rows = []
    for contrast in (0.04, 0.02, 0.01):
        study = work.study(f"dunes-{contrast}", "configs/dunes.yaml", [
            f"dataset.world.picture={work.data / 'worlds/dunes.jpg'}",
            f"front_end.features.sift_contrast={contrast}",
            "front_end.features.flatten=false", "front_end.decision.method=inliers",
            *work.size([], ["dataset.mission.legs=2"])])
        rows.append([contrast, f"{study.mean('trajectory_iekf', 'loop_closures'):.0f}",
                     *(f"{study.mean(name, ERROR):.3f} m"
                       for name in ("dead_reckoning", "trajectory_iekf"))])
    return table(["`sift_contrast`", "loops", "dead reckoning by visual odometry",
                  "`trajectory_iekf`"], rows)


SETTINGS = (("tilt 10 mrad", 0.01, 1e-5, 1e-5), ("floor 60 mm, 12 mrad", 0, 0.06, 0.012),
            ("floor 80 mm, 8 mrad", 0, 0.08, 0.008), ("floor 80 mm, 12 mrad", 0, 0.08, 0.012),
            ("tilt 5 mrad, floor 12 mrad", 0.005, 1e-5, 0.012))


@maker("docs/front_end_results.md", "real-covariance", "slow",
       "`fathom run configs/image_folder.yaml --set front_end.covariance.…`", 15, needs=("copr",))
def real_covariance(work):
    rows = []
    for text, tilt, floor_m, floor_rad in work.size(SETTINGS, SETTINGS[-1:]):
        key = "front_end.covariance"
        folder = work.run("copr", "fathom", "run", "configs/image_folder.yaml",
                          "--set", f"dataset.path={work.data / 'copr'}",
                          "--set", f"{key}.tilt_sigma_rad={tilt}",
                          "--set", f"{key}.floor_sigma_m={floor_m}",
                          "--set", f"{key}.floor_sigma_rad={floor_rad}",
                          "--quiet", "--no-mosaic", "--out", "{out}/run", statuses=(0, 1))
        metrics = _metrics(folder, "metrics.json")
        rows.append([text, f"{metrics[ERROR]:.3f} m",
                     f"{1e3 * metrics['heading_rmse_rad']:.1f} mrad", significant(metrics["anees"]),
                     metrics["loop_closures"]])
    return table(["setting", "`trajectory_iekf`", "its heading RMSE", "ANEES", "loops"], rows)


@maker("README.md", "quickstart", "slow", "`fathom compare configs/quickstart.yaml`", 2,
       pictures=("docs/images/quickstart.png",))
def quickstart(work):
    study = work.study("quickstart", "configs/quickstart.yaml", jobs=2)
    work.picture("docs/images/quickstart.png", study.folder / "trajectories.png")
    lines = (study.folder / "table.txt").read_text("utf-8").split("\n")
    # Of the blocks of columns the first, and the verdict without its rule.
    first = next(i for i, line in enumerate(lines) if line.startswith("----"))
    end = next(i for i in range(first, len(lines)) if not lines[i].strip())
    verdict = lines.index("Verdict")
    shown = [*lines[:end], "",
             *(line for line in lines[verdict:] if not line.startswith("Worse: p of"))]
    return fenced("\n".join(line.rstrip() for line in shown).rstrip())
