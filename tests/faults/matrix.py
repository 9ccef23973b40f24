#!/usr/bin/env python3
"""A machine at fault under every command that writes: the K-th call of a kind fails, for every K.

    tests/faults/matrix.py PROGRAM FAULTS             # some of the calls, as the suite does
    tests/faults/matrix.py PROGRAM FAULTS --all       # every call, every error
    tests/faults/matrix.py PROGRAM FAULTS --only merge
    tests/faults/matrix.py PROGRAM FAULTS --kills 200 # a study killed at random moments, alone

PROGRAM is `fathom`, FAULTS the library that is loaded before it (faults.cpp). With TMPDIR on a
tmpfs no fsync waits for a disk; not below /dev, where nothing fails. Whatever fails, the
command ends by itself, and either its output is whole or it says why in one line of its own with
another status than 0; no file of a final name is torn, nothing half made is left, and the same
command on a machine without faults has the content of an undisturbed one. Exit status 1 where not.
"""

import argparse
import collections
import errno
import os
import pathlib
import subprocess
import sys
import tempfile

import contents
import kills
from bench import LIMIT_S, Bench, half_made

CALLS = {
    "write": ["ENOSPC", "EIO", "EDQUOT"],
    "pwrite64": ["ENOSPC", "EIO", "EDQUOT"],
    "fsync": ["EIO", "ENOSPC", "EDQUOT"],
    "rename": ["EIO", "ENOSPC", "EDQUOT"],
    "renamed": ["EIO", "ENOENT"],
    "open": ["EMFILE", "EROFS", "EIO", "ENOMEM"],
    "mkdir": ["EROFS", "ENOSPC", "EDQUOT"],
    "mmap": ["ENOMEM"],
    "fork": ["EAGAIN", "ENOMEM"],
    "ftruncate": ["EIO", "ENOSPC"],
}
# What the suite has time for.
SAMPLED = ["write", "pwrite64", "fsync", "rename", "renamed", "open", "mkdir", "fork"]


def complaint_about_end(done, is_whole):
    """What is wrong with how a command ended that met a fault; None: nothing."""
    if done.returncode < 0:
        return f"ended by signal {-done.returncode}"
    if done.returncode == 0:
        return None if is_whole else "status 0, but its output is not that of an undisturbed one"
    errors = [line for line in done.stderr.splitlines() if line.startswith("fathom: error: ")]
    if len(errors) != 1:
        return f"{len(errors)} lines of error: {done.stderr.strip()[:300]!r}"
    if "internal: " in errors[0] or "terminate" in done.stderr:
        return f"not a clear line: {done.stderr.strip()[:300]!r}"
    return None


class Matrix:
    def __init__(self, bench, every):
        self.bench, self.every = bench, every
        self.rows = collections.defaultdict(collections.Counter)
        self.complaints = []

    def once(self, name, command, call, error, at, whole):
        """False where the command made fewer such calls."""
        bench = self.bench
        folder = bench.work()
        bench.met.unlink(missing_ok=True)
        command = [*command, "--out", "out"]
        where = f"{name}: call {at} of {call} fails with {error}"
        environment = bench.environment(
            LD_PRELOAD=bench.faults, FATHOM_FAULT_CALL=call, FATHOM_FAULT_AT=str(at),
            FATHOM_FAULT_ERROR=str(getattr(errno, error)), FATHOM_FAULT_MET=str(bench.met))
        try:
            done = subprocess.run([bench.program, *command], cwd=folder, env=environment, text=True,
                                  capture_output=True, timeout=LIMIT_S, check=False)
        except subprocess.TimeoutExpired:
            self.complain(self.rows[name, call, error], where, f"has not ended after {LIMIT_S} s")
            return True
        if not bench.met.exists():
            return False
        row = self.rows[name, call, error]
        row["refused" if done.returncode else "went on"] += 1
        out = folder / "out"
        differs = contents.differences(whole, out)
        # A claim that cannot be read is left where it is: it may be another's.
        if call == "open" and differs == ["unexpected results.owner"]:
            differs = []
        complaint = complaint_about_end(done, not differs)
        if complaint:
            self.complain(row, where, complaint + (f" ({differs[0]})" if differs else ""))
        torn = contents.torn(whole, out)
        if torn:
            self.complain(row, where, "torn: " + ", ".join(torn))
        if half_made(folder):
            self.complain(row, where, "left behind: " + ", ".join(half_made(folder)))
        again = subprocess.run([bench.program, *command], cwd=folder, env=bench.environment(),
                               text=True, capture_output=True, timeout=LIMIT_S, check=False)
        # `import` replaces nothing: what is whole already it leaves as it is, and says so.
        is_kept = not differs and again.returncode == 2 and "is there already" in again.stderr
        differs = contents.differences(whole, out)
        if (again.returncode != 0 and not is_kept) or differs:
            self.complain(row, where, f"then without faults: status {again.returncode} "
                                      f"{again.stderr.strip()[:200]} {differs[:2]}")
        return True

    def complain(self, row, where, what):
        row["wrong"] += 1
        self.complaints.append(f"{where}: {what}")
        print(self.complaints[-1], flush=True)

    def run(self, only, calls):
        for name, command in self.bench.commands():
            if only not in name:
                continue
            folder = self.bench.work()
            self.bench.done([*command, "--out", "out"], folder)
            whole = contents.of_folder(folder / "out")
            for call, errors in calls.items():
                for error in errors:
                    at = 1
                    while self.once(name, command, call, error, at, whole):
                        at += self.every
            if not any(row for (of, _, _), row in self.rows.items() if of == name):
                self.complain(self.rows[name, "", ""], name, f"no call met {self.bench.faults}")

    def print_table(self):
        print(f"{'command':9} {'call':9} {'error':7} {'faults':>6} {'refused':>7} {'went on':>7} "
              f"{'wrong':>5}")
        for (name, call, error), row in self.rows.items():
            met = row["refused"] + row["went on"]
            print(f"{name:9} {call:9} {error:7} {met:6} {row['refused']:7} {row['went on']:7} "
                  f"{row['wrong']:5}")


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", type=os.path.abspath)
    parser.add_argument("faults", type=os.path.abspath)
    parser.add_argument("--all", action="store_true", help="every call and every error")
    parser.add_argument("--only", default="", help="commands whose name has this in it")
    parser.add_argument("--kills", type=int, help="kills alone, so many")
    parser.add_argument("--seed", type=int, default=1, help="of the moments of kills")
    arguments = parser.parse_args()
    if tempfile.gettempdir().startswith("/dev/"):
        parser.error("TMPDIR is below /dev, where faults.cpp lets nothing fail; give another")
    with tempfile.TemporaryDirectory(prefix="fathom-faults-") as top:
        bench = Bench(arguments.program, arguments.faults, pathlib.Path(top))
        if arguments.kills is not None:
            return 1 if kills.kill_at_random(bench, arguments.kills, arguments.seed) else 0
        calls = CALLS if arguments.all else {call: CALLS[call][:1] for call in SAMPLED}
        matrix = Matrix(bench, 1 if arguments.all else 193)
        matrix.run(arguments.only, calls)
        matrix.print_table()
        complaints = list(matrix.complaints)
        if not arguments.only:
            complaints += kills.kill_at_random(bench, 200 if arguments.all else 10, arguments.seed)
            complaints += kills.two_at_once(bench)
            complaints += kills.clock_set_back(bench)
    print(f"{len(complaints)} complaints")
    return 1 if complaints else 0


if __name__ == "__main__":
    sys.exit(main())
