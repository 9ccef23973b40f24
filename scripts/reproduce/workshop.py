"""Where makers run the programs: each command once, its results kept and shared."""

import hashlib
import json
import os
import shlex
import shutil
import subprocess
from pathlib import Path

import provenance
from results import Study


class CommandFailed(Exception):
    """A program that ended with another status than it may."""


class Workshop:
    """Runs programs of one build on one data folder into one scratch folder.

    Results lie in OUT/SOURCES/NAME-ARGUMENTS, hashes of the sources, and of the arguments with the
    files that they name: a command that has ended is not run again, one that was interrupted goes
    on where `fathom compare` can, and no result of other sources is ever taken.

    `is_small` asks for the least that shows that a maker works: one trial of a study.
    """

    def __init__(self, top, out, build, data, jobs=1, is_small=False, again=False):
        self.top, self.build, self.data = Path(top), Path(build), Path(data)
        self.jobs, self.is_small, self.again = jobs, is_small, again
        self.folder = Path(out) / provenance.sources_key(top)
        self.records = []  # of the results taken since begin()
        self.pictures = {}  # target: source, likewise
        self._done = set()  # in this process

    def begin(self):
        """Forgets what the last maker took."""
        self.records, self.pictures = [], {}

    def size(self, full, small):
        """`full`, or `small` where the least will do."""
        return small if self.is_small else full

    def graph(self, name):
        """Path of a pose graph of the data."""
        return str(self.data / "pose_graphs" / f"{name}.g2o")

    def run(self, name, program, *arguments, statuses=(0,), env=None, jobs=1):
        """Runs a program, "{out}" in its arguments being its folder. Returns the folder, which has
        its output as stdout.txt."""
        # Paths of the machine are no part of the name.
        shown = [program, *(str(a).replace(str(self.data), "DATA") for a in arguments)]
        read = [hashlib.sha256(path.read_bytes()).hexdigest()
                for path in (self.top / str(a) for a in arguments) if path.is_file()]
        token = hashlib.sha256(json.dumps([shown, read, jobs]).encode()).hexdigest()[:10]
        folder = (self.folder / f"{name}-{token}").absolute()
        record = folder / "made.json"
        if self.again and folder not in self._done and folder.exists():
            shutil.rmtree(folder)
        if not record.exists():
            folder.mkdir(parents=True, exist_ok=True)
            made = provenance.record(self.top, jobs)
            self._call(folder, program, [str(a).replace("{out}", str(folder)) for a in arguments],
                       statuses, env or {})
            made["command"] = shlex.join(shown)
            record.write_text(json.dumps(made, indent=1) + "\n", encoding="utf-8")
        self._done.add(folder)
        self.records.append(json.loads(record.read_text(encoding="utf-8")))
        return folder

    def _call(self, folder, program, arguments, statuses, env):
        # A cache of its own: another build may register pictures otherwise.
        environment = dict(os.environ, FATHOM_CACHE=str((self.folder / "cache").absolute()),
                           LC_ALL="C", **env)
        with open(folder / "stdout.txt", "w", encoding="utf-8") as out, \
                open(folder / "stderr.txt", "w", encoding="utf-8") as err:
            command = [str((self.build / program).absolute()), *arguments]
            done = subprocess.run(command, cwd=self.top, stdout=out, stderr=err, env=environment,
                                  check=False)
        if done.returncode not in statuses:
            said = (folder / "stderr.txt").read_text(encoding="utf-8").strip().splitlines()
            raise CommandFailed(f"{shlex.join([program, *arguments])} ended with status "
                                f"{done.returncode}: {said[-1] if said else 'no word'}")

    def output(self, name, program, *arguments, **rest):
        """Standard output of a program."""
        return (self.run(name, program, *arguments, **rest) / "stdout.txt").read_text("utf-8")

    def study(self, name, configuration, settings=(), trials=None, jobs=None):
        """Runs a study, `settings` being KEY=VALUE, and reads its tables."""
        surveys = "surveys:" in (self.top / configuration).read_text("utf-8")
        jobs = jobs or self.jobs
        arguments = ["compare", configuration, "--out", "{out}/study", "--quiet", "--no-mosaic",
                     "--jobs", jobs]
        for setting in settings:
            arguments += ["--set", setting]
        trials = 1 if self.is_small else trials
        if trials:
            arguments += ["--trials", trials]
        if self.is_small and surveys:
            arguments += ["--surveys", 1]
        # Status 1: an estimator of which no run could be used, which is a result, too.
        folder = self.run(name, "fathom", *arguments, statuses=(0, 1), jobs=jobs)
        return Study(folder / "study")

    def solve(self, graph, *arguments, mode="incremental"):
        """metrics.json of `fathom solve` on a pose graph of the data."""
        folder = self.run(f"solve-{graph}", "fathom", "solve", self.graph(graph), "--mode", mode,
                          *arguments, "--quiet", "--out", "{out}/run", statuses=(0, 1))
        return json.loads((folder / "run" / "metrics.json").read_text("utf-8"))

    def benchmark(self, name, program, *arguments, env=None):
        """Rows of a program of Google Benchmark by their names: dicts of its JSON."""
        text = self.output(name, program, "--benchmark_format=json", *arguments, env=env)
        rows = json.loads(text)["benchmarks"]
        return {row["name"]: row for row in rows}

    def picture(self, target, source):
        """Says that a file of the docs is to be a copy of `source`."""
        self.pictures[target] = Path(source)
