"""From what, on what and when figures were made, and the line that says so."""

import datetime
import hashlib
import os
import platform
import re
import subprocess
from pathlib import Path

# What figures depend on: programs and configurations. Pages and makers are no part of it.
SOURCES = ("CMakeLists.txt", "CMakePresets.json", "adapters", "apps", "benchmarks", "cmake",
           "configs", "estimators", "include", "src")
GENERATED = re.compile(r"^\*(Made by |Recorded figures, |Not made yet\. )")


def program_sources():
    """The sources less the configurations: those that a command takes are part of its own key."""
    return [name for name in SOURCES if name != "configs"]


def sources_key(top):
    """A hash of what programs are made of: results of other sources are never taken for these."""
    digest = hashlib.sha256()
    for name in program_sources():
        path = Path(top) / name
        files = sorted(path.rglob("*")) if path.is_dir() else [path]
        for file in filter(Path.is_file, files):
            digest.update(str(file.relative_to(top)).encode() + b"\0" + file.read_bytes() + b"\0")
    return digest.hexdigest()[:12]


def _git(top, *arguments):
    try:
        done = subprocess.run(["git", "-C", str(top), *arguments], capture_output=True, text=True,
                              check=True)
    except (OSError, subprocess.CalledProcessError):
        return None
    return done.stdout.strip()


def commit(top):
    """The short hash of the last commit that changed the sources, "+ changes" where they differ
    from it, "unknown" outside of git. Later commits, of pages alone, do not make figures older."""
    head = _git(top, "log", "-1", "--format=%h", "--", *SOURCES)
    if not head:
        return "unknown"
    changes = _git(top, "status", "--porcelain", "--", *SOURCES)
    return head + (" + changes" if changes else "")


def processor():
    """The model of the processor, as the system names it."""
    try:
        for line in Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines():
            if line.startswith("model name"):
                return " ".join(line.split(":", 1)[1].split())
    except OSError:
        pass
    return platform.processor() or platform.machine() or "unknown processor"


def record(top, jobs):
    """What is kept beside a result."""
    return {"commit": commit(top), "processor": processor(), "jobs": jobs,
            "load": round(os.getloadavg()[0], 1), "date": datetime.date.today().isoformat()}


def _joined(values):
    return ", ".join(sorted(set(values)))


def made_line(how, records, is_time=False):
    """The line under a part that its maker gave; `records` are those of the results it took. Of
    times it says how many processes the machine had at work besides, on the average of a minute."""
    if not records:
        return f"*Made by {how}.*"
    jobs = _joined(str(r["jobs"]) for r in records)
    load = f"load before {max(r['load'] for r in records):g}, " if is_time else ""
    return (f"*Made by {how}; commit {_joined(r['commit'] for r in records)}, "
            f"{_joined(r['processor'] for r in records)}, {load}"
            f"{jobs} job{'' if jobs == '1' else 's'} at a time, "
            f"{_joined(r['date'] for r in records)}.*")


def recorded_line(how):
    """The line under a part whose figures are older than its maker."""
    return f"*Recorded figures, not made again at this commit. To make them: {how}.*"


def missing_line(how):
    """The line in a part that has no figures yet, as those of other settings are none."""
    return f"*Not made yet. To make it: {how}.*"


def is_line_of(line, how):
    """Whether a generated line names these commands."""
    return (line in (recorded_line(how), missing_line(how), made_line(how, []))
            or line.startswith(f"*Made by {how};"))


def state(lines):
    """Of the lines of a part: "commit C, date D", "recorded", or "no line"."""
    for line in lines:
        if not GENERATED.match(line):
            continue
        found = re.search(r"; commit ([^,]+), .*, (\d{4}-\d\d-\d\d)\.\*$", line)
        if found:
            return f"{found[1]}, {found[2]}"
        if line.startswith("*Not"):
            return "not made"
        return "recorded" if line.startswith("*Recorded") else "made"
    return "no line"
