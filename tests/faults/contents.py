"""What an output folder of Fathom holds, without what differs from time to time."""

import contextlib
import json
import os
import re
import shutil
import sqlite3
import tempfile

# Fields of a manifest, and of metrics, that a clock or the machine says.
TIMES = re.compile(r"(_ms(\.\w+)?|_s|_bytes|seconds|started|date|host|pid|memory|cpu)$")
# Tables and figures of costs, and what has the date in it: how each of them ends.
TIMED = {".html": b"</html>\n", ".svg": b"</svg>\n", ".pdf": b"%%EOF\n", ".tex": b"\n",
         "runs.csv": b"\n", "summary.csv": b"\n", "table.txt": b"\n"}


def without_times(value):
    if isinstance(value, dict):
        return {key: without_times(one) for key, one in value.items() if not TIMES.search(key)}
    if isinstance(value, list):
        return [without_times(one) for one in value]
    return value


def of_store(path):
    """The runs of a store, cost left out; sessions are as many as it took."""
    with tempfile.TemporaryDirectory() as folder:
        # Who opens a store that was left in the middle makes files beside it.
        for ending in ("", "-wal"):
            if os.path.exists(f"{path}{ending}"):
                shutil.copy(f"{path}{ending}", f"{folder}/store{ending}")
        return rows_of(f"{folder}/store")


def rows_of(path):
    with contextlib.closing(sqlite3.connect(path)) as store:
        if store.execute("PRAGMA integrity_check").fetchone() != ("ok",):
            raise ValueError("not whole")
        if not store.execute("SELECT 1 FROM sqlite_master").fetchone():
            return []  # made, and nothing told yet
        rows = store.execute(
            "SELECT result.* FROM result JOIN metric ON result.metric = metric.name"
            " WHERE NOT metric.is_cost").fetchall()
        series = store.execute(
            "SELECT cell, survey, trial, run.estimator, name, data FROM series JOIN run USING (run)"
            " WHERE name NOT LIKE '%\\_ms' ESCAPE '\\'").fetchall()
    return sorted(map(repr, rows + series))


def of_file(path):
    """Bytes, rows or values; of a file of times whether it is whole."""
    if path.suffix == ".sqlite":
        return of_store(path)
    if path.suffix == ".json":
        return without_times(json.loads(path.read_text()))
    data = path.read_bytes()
    end = TIMED.get(path.name, TIMED.get(path.suffix))
    return data if end is None else data.endswith(end)


def files_of(folder):
    return {str(path.relative_to(folder)): path for path in sorted(folder.rglob("*"))
            if path.is_file()}


def of_folder(folder):
    return {name: of_file(path) for name, path in files_of(folder).items()}


def differences(whole, folder):
    files = files_of(folder)
    found = [f"no {name}" for name in whole if name not in files]
    found += [f"unexpected {name}" for name in files if name not in whole]
    for name in sorted(set(whole) & set(files)):
        try:
            if of_file(files[name]) != whole[name]:
                found.append(f"{name} differs")
        except (ValueError, sqlite3.Error) as error:
            found.append(f"{name}: {error}")
    return found


def torn(whole, folder):
    """Files of a final name that are neither what they should be nor, a store, a part of it."""
    found = []
    for name, path in files_of(folder).items():
        if ".partial" in name or name not in whole:
            continue
        try:
            content = of_file(path)
        except (ValueError, sqlite3.Error) as error:
            found.append(f"{name} ({error})")
            continue
        is_part = path.suffix == ".sqlite" and set(content) <= set(whole[name])
        if content != whole[name] and not is_part:
            found.append(name)
    return found
