#!/usr/bin/env python3
"""Runs the shipped configurations, made small, and every command with two programs, and compares
all that they print and write, bit by bit.

    scripts/same_results.py BEFORE AFTER              # paths of two builds of `fathom`
    scripts/same_results.py BEFORE AFTER --only solve # cases whose name has this in it
    scripts/same_results.py BEFORE AFTER --keep DIR   # leaves the outputs in DIR/before, DIR/after

Costs cannot differ: the programs run with a clock that stands and an allocator that counts nothing.
A store is compared as its SQL. Exit status 1 where anything differs, each difference on a line.
"""

import argparse
import concurrent.futures
import os
import pathlib
import re
import shutil
import sqlite3
import subprocess
import sys
import tempfile

TOP = pathlib.Path(__file__).resolve().parent.parent
DATA = TOP.parent / "shared" / "data"

# Durations are 0; the date is the same; what malloc gave has no size.
STANDING_CLOCK = r"""
#define _GNU_SOURCE
#include <dlfcn.h>
#include <sys/resource.h>
#include <sys/time.h>
#include <time.h>
#include <stddef.h>
static struct timespec first[16];
int clock_gettime(clockid_t id, struct timespec* now) {
  static int (*real)(clockid_t, struct timespec*);
  if (!real) real = (int (*)(clockid_t, struct timespec*))dlsym(RTLD_NEXT, "clock_gettime");
  if (id == CLOCK_REALTIME || id == CLOCK_REALTIME_COARSE) {
    now->tv_sec = 1767225600;
    now->tv_nsec = 0;
    return 0;
  }
  if (id < 0 || id > 15) return real(id, now);
  if (first[id].tv_sec == 0 && first[id].tv_nsec == 0) real(id, &first[id]);
  *now = first[id];
  return 0;
}
time_t time(time_t* out) { if (out) *out = 1767225600; return 1767225600; }
int gettimeofday(struct timeval* now, void* zone) {
  (void)zone;
  now->tv_sec = 1767225600;
  now->tv_usec = 0;
  return 0;
}
size_t malloc_usable_size(void* block) { (void)block; return 0; }
"""

# What says which program it was, on which machine.
WHO = re.compile(
    rb'("(?:host|pid|commit|flags|version|fathom|program|code|cpu)": ?)(?:"[^"]*"|\d+)'
    rb"|('(?:fathom|checksum)',)'[^']*'"
    rb'|("Fathom )[0-9.]+"')


def small(text):
    """Settings that make a shipped configuration a matter of seconds."""
    has_pictures = "type: simulated\n" in text
    length = "3" if has_pictures else "8"
    settings = ["surveys=1", "trials=1", "jobs=1"] if "estimators:" in text else []
    if has_pictures:
        settings += ["dataset.camera.width=200", "dataset.camera.height=150",
                     "dataset.camera.fx=150", "dataset.camera.fy=150",
                     "front_end.ransac.max_error_m=0.05"]
    if "legs:" in text:
        settings += ["dataset.mission.legs=2", "dataset.mission.leg_length_m=" + length]
    if "loop_length_m:" in text:
        settings += ["dataset.mission.loop_length_m=" + length, "dataset.mission.loop_width_m=2",
                     "dataset.mission.loop_overrun_m=1"]
    if "../shared/data/worlds" in text:
        settings += [f"dataset.world.picture={DATA / 'worlds/dunes.jpg'}"]
    if "../shared/data/copr" in text:
        settings += [f"dataset.path={DATA / 'copr'}", "front_end.features.max_features=500"]
    settings = [one for one in settings if f"key: {one.split('=')[0]}," not in text]
    return [word for setting in settings for word in ("--set", setting)]


def configurations():
    for path in sorted((TOP / "configs").rglob("*.yaml")):
        text = path.read_text()
        if "../shared/data" in text and not DATA.is_dir():
            print(f"skipped, no {DATA}: {path.name}")
            continue
        command = "compare" if "estimators:" in text else "run"
        yield "config " + path.stem, [[command, str(path), "--out", "out", *small(text)]]


def graphs(program):
    listed = subprocess.run([program, "list", "estimators"], capture_output=True, text=True,
                            check=True).stdout
    names = re.findall(r"^(\w+): ", listed, re.MULTILINE)
    for graph in ("ring", "intel", "manhattan"):
        path = DATA / "pose_graphs" / (graph + ".g2o")
        if not path.exists():
            continue
        for name in names:
            for mode in ("incremental", "batch"):
                if graph == "manhattan" and mode == "incremental":
                    continue
                yield f"solve {graph} {name} {mode}", [
                    ["solve", str(path), "--estimator", name, "--mode", mode, "--out", "out"]]


def commands():
    run = TOP / "configs/run.yaml"
    study = TOP / "configs/quickstart.yaml"
    small_run, small_study = small(run.read_text()), small(study.read_text())
    small_data = small(study.read_text().replace("estimators:", ""))
    yield "run and after", [
        ["run", str(run), "--out", "run", *small_run],
        ["evaluate", "run/trajectory.tum", "run/ground_truth.tum"],
        ["evaluate", "run/trajectory.tum", "run/ground_truth.tum", "--align", "se2"],
        ["mosaic", "run", "--trajectory", "run/ground_truth.tum", "--out", "truth"],
        ["convert", "run/trajectory.tum", "--to", "kitti", "--out", "trajectory.txt"],
        ["solve", "run/measurements.g2o", "--ground-truth", "run/ground_truth.tum",
         "--out", "again"],
        ["spoil", "run/measurements.g2o", "--share", "0.3", "--out", "spoilt.g2o"],
        ["check", "run/measurements.g2o"], ["check", "run/trajectory.tum"],
        ["run", str(run), "--out", "batch", "--set", "estimator.type=ceres_pose_graph", *small_run],
    ]
    yield "study and after", [
        ["compare", str(study), "--out", "study", *small_study, "--set", "trials=3"],
        ["compare", str(study), "--out", "study", *small_study, "--set", "trials=3"],
        ["status", "study"], ["report", "study", "--out", "report"],
        ["select", "study", "--require", "mean_position_error_m<=0.5", "--minimise", "anees"],
        ["select", "study", "--require", "mean_position_error_m<=0", "--minimise", "anees"],
    ]
    yield "shards", [
        *(["compare", str(study), "--shard", f"{k}/2", "--out", f"shard-{k}", *small_study,
           "--set", "trials=3"] for k in (1, 2)),
        ["status", "shard-1", "shard-2"], ["merge", "shard-1", "--out", "half"],
        ["merge", "shard-1", "shard-2", "--out", "whole"],
    ]
    yield "survey", [
        ["simulate", str(study), "--out", "survey", *small_data], ["check", "survey"],
        ["init", "survey", "--out", "mine"], ["run", "survey", "--out", "run"],
        ["compare", "mine/study.yaml", "--out", "study", "--trials", "1"],
        ["import", "survey", "--out", "imported"],
    ]
    yield "said", [
        *(["list", what] for what in ("estimators", "detectors", "datasets", "metrics")),
        ["--help"], *([name, "--help"] for name in ("run", "compare", "solve", "report", "select")),
        ["conformance", "ekf"], ["pages", "--out", "pages"],
        ["estimate", str(study), *small_study],
    ]
    yield "refused", [
        ["run", "nothing.yaml"], ["run", str(run), "--set", "estimator.typ=ekf"],
        ["compare", str(study), "--set", "trials=0"], ["solve", "no.g2o"], ["comparee"],
        ["compare", str(study), "--shard", "3/2"], ["report", "nothing"], ["merge", "a", "b"],
        ["run", str(run), "--set", "front_end.ransac.max_error_m=-1"], ["mosaic", "nothing"],
    ]


def run_case(program, steps, folder, clock):
    """Runs the steps in an empty folder; what they say goes into `said` there."""
    folder.mkdir(parents=True)
    environment = dict(os.environ, LD_PRELOAD=str(clock), FATHOM_CACHE=str(folder / "cache"))
    with open(folder / "said", "wb") as said:
        for step in steps:
            done = subprocess.run([program, *step], cwd=folder, env=environment,
                                  capture_output=True, check=False)
            said.write(b"$ fathom " + " ".join(step).encode() + b"\n" + done.stdout + done.stderr +
                       b"status %d\n" % done.returncode)
    shutil.rmtree(folder / "cache", ignore_errors=True)


def content(path):
    if path.suffix == ".sqlite":
        with sqlite3.connect(path) as store:
            text = "\n".join(store.iterdump()).encode()
    else:
        text = path.read_bytes()
    return WHO.sub(rb"\1\2\3-", text)


def first_difference(a, b):
    at = next((i for i, (x, y) in enumerate(zip(a, b)) if x != y), min(len(a), len(b)))
    return f"…{a[max(0, at - 60):at + 60]!r} → {b[max(0, at - 60):at + 60]!r}"


def differences(name, before, after):
    files = [{p.relative_to(top) for p in top.rglob("*") if p.is_file()} for top in (before, after)]
    for path in sorted(files[0] ^ files[1]):
        yield f"{name}: {path}: only {'before' if path in files[0] else 'after'}"
    for path in sorted(files[0] & files[1]):
        a, b = content(before / path), content(after / path)
        if a != b:
            yield f"{name}: {path}: {first_difference(a, b)}"


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("before")
    parser.add_argument("after")
    parser.add_argument("--only", default="")
    parser.add_argument("--keep", type=pathlib.Path)
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    arguments = parser.parse_args()
    programs = {"before": os.path.abspath(arguments.before),
                "after": os.path.abspath(arguments.after)}
    cases = [case for case in (*configurations(), *graphs(programs["before"]), *commands())
             if arguments.only in case[0]]
    top = arguments.keep or pathlib.Path(tempfile.mkdtemp())
    top = top.resolve()
    top.mkdir(exist_ok=True)
    clock = top / "standing_clock.so"
    subprocess.run(["cc", "-shared", "-fPIC", "-O1", "-x", "c", "-", "-o", clock, "-ldl"],
                   input=STANDING_CLOCK.encode(), check=True)

    def compare(case):
        name, steps = case
        for which, program in programs.items():
            # Both in a folder of the same name, as what they write has paths in it.
            work = top / "work" / name.replace(" ", "_")
            run_case(program, steps, work, clock)
            done = top / which / work.name
            shutil.rmtree(done, ignore_errors=True)
            done.parent.mkdir(exist_ok=True)
            work.rename(done)
        found = list(differences(name, top / "before" / work.name, top / "after" / work.name))
        files = sum(p.is_file() for p in (top / "after" / work.name).rglob("*"))
        print("\n".join(found) or f"{name}: the same, {files} files", flush=True)
        return not found

    with concurrent.futures.ThreadPoolExecutor(arguments.jobs) as pool:
        same = list(pool.map(compare, cases))
    if not arguments.keep:
        shutil.rmtree(top)
    print(f"{sum(same)} of {len(same)} cases are the same")
    return 0 if all(same) and same else 1


if __name__ == "__main__":
    sys.exit(main())
