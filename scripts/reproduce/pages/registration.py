"""docs/registration_benchmark.md, docs/registration.md; docs/water.md: keypoints of floors."""

import json
import math
import re

from layout import fixed, significant, table
from maker import maker

PAGE = "docs/registration_benchmark.md"
FLOORS = ("ripples", "mud", "pebbles", "patches")
DUNES = "worlds/dunes.jpg"
CONDITIONS = {"clean": "clean", "contrast": "contrast × 0.4", "haze": "haze",
              "light_cone": "light cone", "motion_blur": "motion blur 5 px",
              "noise": "noise 8/255", "particles": "200 particles", "colour_cast": "colour cast",
              "caustics": "caustics 20 %", "relief": "relief 5 %", "tilt_2deg": "tilt 2°",
              "tilt_5deg": "tilt 5°"}
BENCH = dict(needs=(DUNES,), programs=("registration_benchmark",))


def _figures(work, name, arguments):
    """The JSON of a run over the four floors and dunes."""
    if work.is_small:
        arguments = re.sub(r"(--pairs-per-cell) [1-9]\d*", r"\1 1", arguments)
        arguments = re.sub(r"--floors \S+ ", "", arguments)
        arguments += " --floors mud,ripples --conditions clean,noise"
    else:
        arguments += f" --world {work.data / DUNES}:0.004"
    folder = work.run(name, "registration_benchmark", *arguments.split(), "--jobs", work.jobs,
                      "--json", "{out}/figures.json", jobs=work.jobs)
    return json.loads((folder / "figures.json").read_text("utf-8"))


def _by_condition(figures):
    """Cells by condition, floor by floor."""
    found = {}
    for cell in figures["cells"]:
        found.setdefault(cell["condition"], []).append(cell)
    return found


def _listed(cells, text):
    return ", ".join(text(cell) for cell in cells)


# The shared error was calibrated on four of these floors, with another seed; on `mixed` and dunes
# nothing was.
CONDITIONS_RUN = ("--floors mixed,ripples,mud,pebbles,patches --buckets 3,4,6,8 "
                  "--pairs-per-cell 16 --skip-opencv --seed 31 --negatives 0")


def _mean_nis(cells):
    nis = [cell["ours"]["nis"] for cell in cells]
    return sum(one["mean"] * one["count"] for one in nis) / sum(one["count"] for one in nis)


@maker(PAGE, "conditions", "slow",
       f"`registration_benchmark {CONDITIONS_RUN} --world dunes.jpg:0.004`", 25, **BENCH)
def conditions(work):
    rows = []
    for name, cells in _by_condition(_figures(work, "conditions", CONDITIONS_RUN)).items():
        ours = [cell["ours"] for cell in cells]
        accepted = [one["recall"]["successes"] for one in ours]
        seen, unseen = ([c for c in cells if (c["floor"] in FLOORS) == of] for of in (True, False))
        rows.append([CONDITIONS[name], ", ".join(map(str, accepted)), sum(accepted),
                     sum(one["wrong_motions"]["successes"] for one in ours),
                     _listed(ours, lambda c: fixed(c["translation_px"]["median"], 2)),
                     _listed(ours, lambda c: fixed(c["nis"]["mean"], 1)),
                     *(fixed(_mean_nis(part), 1) if part else "" for part in (unseen, seen))])
    return table(["condition", "right of 64", "of 384", "wrong", "median error, px", "mean NIS",
                  "mixed, dunes", "the other four"], rows)


NEGATIVES_RUN = "--negatives 25500 --pool 245 --pairs-per-cell 0 --skip-opencv --seed 51"
NEGATIVES_HOW = f"`registration_benchmark {NEGATIVES_RUN} --world dunes.jpg:0.004`"


def _negatives(work):
    arguments = work.size(NEGATIVES_RUN, NEGATIVES_RUN.replace("25500", "20").replace("245", "12"))
    return _figures(work, "negatives", arguments)["negatives"]


@maker(PAGE, "negatives", "slow", NEGATIVES_HOW, 60, **BENCH)
def negatives(work):
    found = _negatives(work)
    total = sum(one["pairs"] for one in found)
    return table(["", *(one["floor"] for one in found), "all"],
                 [["pairs", *(one["pairs"] for one in found), total],
                  ["accepted", *(one["accepted"] for one in found),
                   sum(one["accepted"] for one in found)],
                  ["95 % bound", *(f"{one['upper_bound_95']:.1e}" for one in found), ""]])


@maker(PAGE, "chance", "slow", NEGATIVES_HOW, 60, **BENCH)
def chance(work):
    return table(["pairs that do not overlap", "least probability of a support", "expected"],
                 [[f"{one['pairs']} of {one['floor']}", f"{one['least_false_alarms']:.0e}",
                   f"{1 / one['pairs']:.0e}"] for one in _negatives(work)])


def _chance_of(places, mean):
    """P(X ≥ places), X of Poisson's distribution with this mean."""
    term = total = math.exp(-mean)
    for k in range(1, places):
        term *= mean / k
        total += term
    return 1.0 - total


@maker("docs/registration.md", "places-needed", "quick",
       "P(X ≥ k) ≤ 10⁻⁷ and r ≤ 0.2 k, the formulas above", 0, programs=())
def places_needed(work):
    rivals = (2, 4, 6, 10, 20)
    needed = [next(k for k in range(1, 1000) if _chance_of(k, r) <= 1e-7 and 5 * r <= k)
              for r in rivals]
    return table(["rival places", *map(str, rivals)], [["places needed", *needed]])


CONTENDERS_RUN = "--buckets 1,3,5,8 --pairs-per-cell 6 --seed 8 --negatives 0"


@maker(PAGE, "contenders", "slow",
       f"`registration_benchmark {CONTENDERS_RUN} --world dunes.jpg:0.004`, and with `--plain`", 60,
       **BENCH)
def contenders(work):
    both = _by_condition(_figures(work, "contenders", CONTENDERS_RUN))
    plain = _by_condition(_figures(work, "plain", CONTENDERS_RUN + " --plain --skip-opencv"))

    def text(cells, who):
        right = sum(cell[who]["recall"]["successes"] for cell in cells)
        wrong = sum(cell[who]["wrong_motions"]["successes"] for cell in cells)
        return f"{right} ({wrong})" if wrong else str(right)

    return table(["", "Fathom", "OpenCV", "`decision.method: inliers`"],
                 [[CONDITIONS[name], text(cells, "ours"), text(cells, "opencv"),
                   text(plain[name], "ours")] for name, cells in both.items()])


@maker(PAGE, "matching-speed", "time", "`registration_benchmark --speed --pairs-per-cell 0 "
       "--negatives 0`", 1, programs=("registration_benchmark",))
def matching_speed(work):
    folder = work.run("speed", "registration_benchmark", "--speed", "--pairs-per-cell", 0,
                      "--negatives", 0, "--jobs", 1, "--json", "{out}/figures.json")
    found = json.loads((folder / "figures.json").read_text("utf-8"))["speed"]
    return table(["floor", "features", "Fathom, ms",
                  "OpenCV: brute-force matcher and `estimateAffinePartial2D`, ms", "ratio"],
                 [[one["floor"], f"{one['from_features']} × {one['to_features']}",
                   fixed(one["ours_ms"], 1), fixed(one["opencv_ms"], 0),
                   significant(one["opencv_ms"] / one["ours_ms"], 2)] for one in found])


@maker(PAGE, "hazy-survey", "slow", "`fathom run configs/run.yaml`, and with `--set "
       "dataset.water.attenuation_per_m=0.255 --set dataset.water.backscatter=128 --set "
       "dataset.water.particles=200`", 2)
def hazy_survey(work):
    haze = ("attenuation_per_m=0.255", "backscatter=128", "particles=200")
    rows = []
    for text, settings in (("clear water", ()),
                           ("haze of transmission 0.6 from 2 m, 200 particles", haze)):
        pairs = [part for s in settings for part in ("--set", f"dataset.water.{s}")]
        folder = work.run("water", "fathom", "run", "configs/run.yaml", *pairs, "--quiet",
                          "--no-mosaic", "--out", "{out}/run", statuses=(0, 1))
        metrics = json.loads((folder / "run" / "metrics.json").read_text("utf-8"))
        rows.append([text, metrics["registrations"],
                     f"{1e3 * metrics['mean_position_error_m']:.2g} mm",
                     f"{1e3 * metrics['final_position_error_m']:.2g} mm"])
    return table(["`configs/run.yaml`", "registrations", "mean error", "at the end"], rows)


@maker("docs/water.md", "floor-keypoints", "slow", "`fathom register` on two pictures of `fathom "
       "simulate configs/run.yaml --set dataset.world.floor=KIND`, `--set "
       "front_end.features.max_features=1000000`, and `flatten=false`", 2)
def floor_keypoints(work):
    rows = []
    for floor in ("mixed", *FLOORS):
        folder = work.run(f"floor-{floor}", "fathom", "simulate", "configs/run.yaml", "--set",
                          f"dataset.world.floor={floor}", "--set", "dataset.altitude.base_m=2",
                          "--set", "dataset.mission.loop_length_m=1", "--set",
                          "dataset.mission.loop_width_m=1", "--set",
                          "dataset.mission.loop_overrun_m=0", "--quiet", "--out", "{out}/survey")
        pictures = sorted((folder / "survey/mav0/cam0/data").iterdir())
        counts = []
        for flatten in ("true", "false"):
            text = work.output(f"keypoints-{floor}", "fathom", "register", pictures[0],
                               pictures[len(pictures) // 2], "--altitude-a", 2, "--altitude-b", 2,
                               "--out", "{out}/run", "--set",
                               f"front_end.features.flatten={flatten}", "--set",
                               "front_end.features.max_features=1000000", statuses=(0, 1))
            a, b = (int(n) for n in re.search(r"(\d+) in A, (\d+) in B", text).groups())
            counts.append(f"{min(a, b)} to {max(a, b)}")
        rows.append([f"`{floor}`", *counts])
    return table(["kind", "keypoints", "without `flatten`"], rows)
