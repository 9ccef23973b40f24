"""Small inputs for every command that writes, and a folder to write into."""

import os
import shutil
import subprocess

LIMIT_S = 60
PICTURES = """dataset:
  type: simulated
  world: {metres_per_pixel: 0.01}
  mission: {type: sweep, legs: 2, leg_length_m: 2, leg_spacing_m: 1}
  camera: {width: 160, height: 120, fx: 120, fy: 120}
front_end:
  keyframes: {separation_frames: 3}
  ransac: {max_error_m: 0.05}
"""
LOG = """dataset:
  type: simulated_log
  mission: {type: sweep, legs: 3, leg_length_m: 8, leg_spacing_m: 1.0}
  loops: {max_distance_m: 1.4}
trials: 2
"""
# Says again what it is told, and so ends well.
SOLVER = """#!/bin/sh
grep '^VERTEX_SE2' "$1" > "$2"
"""


class Bench:
    """Inputs that are made once, and the content of undisturbed outputs."""

    def __init__(self, program, faults, top):
        self.program, self.faults, self.top = program, faults, top
        self.inputs = top / "inputs"
        self.inputs.mkdir()
        self.met = top / "met"
        solver = self.inputs / "solver"
        solver.write_text(SOLVER)
        solver.chmod(0o755)
        (self.inputs / "pictures.yaml").write_text(PICTURES)
        (self.inputs / "study.yaml").write_text(
            LOG + f"estimators: [{{type: ekf}}, {{type: command, "
                  f"command: '{solver} {{input}} {{output}}'}}]\n")
        for command in (
                ["run", "pictures.yaml", "--out", "run"],
                ["convert", "run/trajectory.tum", "--to", "kitti", "--out", "poses.txt",
                 "--times-out", "times.txt"],
                ["compare", "study.yaml", "--out", "study"],
                *(["compare", "study.yaml", "--shard", f"{k}/2", "--out", f"shard-{k}"]
                  for k in (1, 2))):
            self.done(command, self.inputs)

    def environment(self, **more):
        return dict(os.environ, FATHOM_CACHE=str(self.top / "cache"), LC_ALL="C", **more)

    def done(self, command, folder):
        subprocess.run([self.program, *command], cwd=folder, env=self.environment(), check=True,
                       stdout=subprocess.DEVNULL, timeout=LIMIT_S)

    def work(self):
        """An empty folder beside which the inputs are, the same at every time."""
        folder = self.top / "work"
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir()
        return folder

    def commands(self):
        there = "../inputs/"
        yield "run", ["run", there + "pictures.yaml"]
        yield "compare", ["compare", there + "study.yaml"]
        yield "shard", ["compare", there + "study.yaml", "--shard", "1/2"]
        yield "merge", ["merge", there + "shard-1", there + "shard-2"]
        yield "import", ["import", there + "poses.txt", "--times", there + "times.txt"]
        yield "simulate", ["simulate", there + "pictures.yaml"]
        yield "report", ["report", there + "study"]
        yield "mosaic", ["mosaic", there + "run"]
        yield "convert", ["convert", there + "run/trajectory.tum", "--to", "kitti"]


def half_made(folder):
    return [str(path.relative_to(folder)) for path in folder.rglob("*") if ".partial" in path.name]
