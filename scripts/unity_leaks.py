#!/usr/bin/env python3
"""Finds names that leak from one source to another where sources are compiled together.

In a unity batch the unnamed namespaces of all sources are one, so that a source may use another's
name in place of one of an outer namespace, without a word of the compiler. For scripts/lint.sh:

    cmake -G Ninja -B build/unity -DCMAKE_UNITY_BUILD=ON -DCMAKE_UNITY_BUILD_BATCH_SIZE=0
    scripts/unity_leaks.py build/unity [PATTERN]    # of the folders, such as 'src/report'
"""

import json
import os
import re
import shlex
import sys
from concurrent.futures import ProcessPoolExecutor

from clang import cindex

TOP = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
KINDS = {
    kind.value
    for kind in (cindex.CursorKind.DECL_REF_EXPR, cindex.CursorKind.TYPE_REF,
                 cindex.CursorKind.TEMPLATE_REF)
}


def arguments_of(command):
    """What clang needs of a compiler's command: paths, definitions and the standard."""
    words = shlex.split(command)
    kept = ["-fopenmp"] if "-fopenmp" in words else []
    for word, following in zip(words, words[1:] + [""]):
        if word.startswith(("-I", "-D", "-std=")):
            kept.append(word)
        elif word == "-isystem":
            kept += [word, following]
    return kept


def source_of(location):
    name = os.path.realpath(location.file.name) if location.file else ""
    inside = name.startswith(TOP + "/") and name.endswith(".cpp")
    return os.path.relpath(name, TOP) if inside else None


def leaks_of(entry):
    unit = cindex.Index.create().parse(entry["file"], arguments_of(entry["command"]))
    errors = [d.spelling for d in unit.diagnostics if d.severity >= cindex.Diagnostic.Error]
    if errors:
        return [f"{entry['file']}: cannot be read: {errors[0]}"]
    # Headers refer to no source.
    ours = [c for c in unit.cursor.get_children() if source_of(c.location)]
    found = set()
    for cursor in (inner for outer in ours for inner in outer.walk_preorder()):
        # By number: of some kinds of C++20 these bindings have no name.
        if cursor._kind_id not in KINDS:
            continue
        user = source_of(cursor.location)
        if user is None or cursor.referenced is None:
            continue
        owner = source_of(cursor.referenced.location)
        if owner is None or owner == user:
            continue
        # A function of another source that a header declares is meant; its header comes first.
        if cursor.referenced.linkage == cindex.LinkageKind.EXTERNAL:
            continue
        found.add(f"{user}:{cursor.location.line}: {cursor.spelling} is of {owner}")
    return sorted(found)


def main():
    with open(os.path.join(sys.argv[1], "compile_commands.json"), encoding="utf-8") as file:
        entries = json.load(file)
    pattern = re.compile(sys.argv[2] if len(sys.argv) > 2 else "")
    units = [e for e in entries if "/Unity/unity_" in e["file"] and pattern.search(e["file"])]
    with ProcessPoolExecutor(os.cpu_count()) as pool:
        leaks = [leak for some in pool.map(leaks_of, units) for leak in some]
    for leak in leaks:
        print(f"lint: error: {leak}; give one of the two another name", file=sys.stderr)
    print(f"lint: {len(units)} units of sources that are compiled together, {len(leaks)} leaks")
    sys.exit(1 if leaks else 0)


if __name__ == "__main__":
    main()
