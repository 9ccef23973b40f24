"""docs/front_end_results.md: the covariance of configs/image_folder.yaml on pictures that did not
set it."""

import json

import real_pairs
from layout import fixed, significant, table
from maker import maker

CONFIG = "configs/image_folder.yaml"
KEY = "front_end.covariance"
SHIPPED = (0.005, 0.012)  # tilt and floor of heading of CONFIG, rad
PROBE_RAD = 0.01  # any tilt will do: covariances are linear in its square
# Every pair is tried, wherever dead reckoning has them.
ALL_PAIRS = "front_end.candidates.max_distance_m=1000"

# Pictures without a common one: in a row, and every other.
PARTS = {"first 19": lambda k: k < 19, "last 19": lambda k: k >= 19,
         "even": lambda k: k % 2 == 0, "odd": lambda k: k % 2 == 1, "all 38": lambda k: True}
JUDGED = (("first 19", "last 19"), ("last 19", "first 19"), ("even", "odd"), ("odd", "even"))


def _run(work, name, folder, settings, *more):
    tilt, floor = settings
    pairs = (f"dataset.path={folder}", f"{KEY}.tilt_sigma_rad={tilt:.6g}",
             f"{KEY}.floor_sigma_rad={floor:.6g}", *more)
    return work.run(name, "fathom", "run", CONFIG, *(a for p in pairs for a in ("--set", p)),
                    "--quiet", "--no-mosaic", "--out", "{out}/run", statuses=(0, 1)) / "run"


def _part(work, name):
    """An image folder with these pictures of the survey alone; its sensors are whole."""
    source = (work.data / "copr" / "mav0").absolute()
    folder = work.folder / f"copr-{name.replace(' ', '-')}"
    top = folder / "mav0"
    (top / "cam0").mkdir(parents=True, exist_ok=True)
    for one in ("altimeter0", "odometry0", "state_groundtruth_estimate0", "cam0/data",
                "cam0/sensor.yaml"):
        if not (top / one).is_symlink():
            (top / one).symlink_to(source / one)
    head, *rows = (source / "cam0" / "data.csv").read_text("utf-8").splitlines()
    kept = [row for k, row in enumerate(rows) if PARTS[name](k)]
    (top / "cam0" / "data.csv").write_text("\n".join([head, *kept]) + "\n", encoding="utf-8")
    return folder


def _anees(work, name, settings):
    folder = _run(work, "copr-part", _part(work, name), settings)
    return json.loads((folder / "metrics.json").read_text("utf-8"))["anees"]


def _with_interval(pairs, value, places=1):
    low, high = real_pairs.interval(pairs, value)
    return (f"{fixed(real_pairs.mean(map(value, pairs)), places)} "
            f"[{fixed(low, places)}, {fixed(high, places)}]")


def _row(work, fitted_on, judged_on, settings, pairs):
    inside = real_pairs.mean(p.nis(settings) < real_pairs.CHI2_3_AT_95 for p in pairs)
    return [fitted_on, f"{1e3 * settings[0]:.1f}, {1e3 * settings[1]:.1f}", judged_on, len(pairs),
            _with_interval(pairs, lambda p: p.nis(settings)),
            _with_interval(pairs, lambda p: p.nis_of_translation(settings)),
            _with_interval(pairs, lambda p: p.nis_of_heading(settings)),
            f"{100 * inside:.0f} %", significant(_anees(work, judged_on, settings), 2)]


@maker("docs/front_end_results.md", "real-covariance-judged", "slow",
       f"`fathom run {CONFIG}`, on parts of the pictures, with settings that "
       "`scripts/reproduce/real_pairs.py` fits", 3, needs=("copr",))
def real_covariance_judged(work):
    survey = work.data / "copr"
    pairs = real_pairs.pairs_of(_run(work, "copr-pairs", survey, (0, 1e-5), ALL_PAIRS),
                                _run(work, "copr-pairs", survey, (PROBE_RAD, 1e-5), ALL_PAIRS),
                                PROBE_RAD)
    within = {name: [p for p in pairs if holds(p.first) and holds(p.second)]
              for name, holds in PARTS.items()}
    fits = {name: real_pairs.fitted(within[name]) for name in PARTS}
    rows = []
    for fitted_on, judged_on in JUDGED:
        for part, text in ((fitted_on, "the same"), (judged_on, judged_on)):
            row = _row(work, fitted_on, part, fits[fitted_on], within[part])
            rows.append([*row[:2], text, *row[3:]])
    rows.append(_row(work, "all 38", "all 38", fits["all 38"], within["all 38"]))
    rows += [_row(work, "shipped", part, SHIPPED, within[part]) for part in PARTS]
    return table(["settings fitted on", "tilt, heading floor (mrad)", "judged on", "pairs",
                  "NIS (3)", "translation (2)", "heading (1)", "pairs inside 95 %",
                  "ANEES of the estimate (1)"], rows)
