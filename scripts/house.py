#!/usr/bin/env python3
"""Draws the modules and what each links, from the CMake files: docs/house.svg.

    scripts/house.py             # writes it
    scripts/house.py --check     # exit status 1 where it is not what the CMake files say

An arrow goes from a module to what it is built on. One that others imply is left out.
"""

import pathlib
import re
import sys

TOP = pathlib.Path(__file__).resolve().parent.parent
PICTURE = TOP / "docs" / "house.svg"
CALL = re.compile(r"(fathom_module|fathom_estimator|fathom_support|fathom_adapter|"
                  r"target_link_libraries)\s*\(\s*([\w${}]+)([^)]*)\)")
BOX_WIDTH, BOX_HEIGHT, GAP, ROW = 148, 32, 22, 72
# Nothing is built on these.
OUTER = ("apps", "python", "adapters")
# Row, counted from below, and column of each box: arrows go down and cross no box.
PLACES = {
    "apps": (11, 2.3), "python": (11, 3.5), "memory_meter": (10, 0), "workflow": (10, 1.8),
    "report": (8, 2.3), "harness": (8, 1.2), "results": (7, 1.2),
    "configuration": (6, 1.2), "estimators": (6, 3.7),
    "front_end": (5, 0), "adapters": (5, 2.3), "estimators/NAME": (5, 3.7),
    "datasets": (4, 0), "support/filter": (4, 3.2), "support/pose_graph": (4, 4.2),
    "vision": (3, 0), "evaluation": (3, 1.2), "estimation": (3, 2.2),
    "measurements": (2, 1.2), "geometry": (1, 1.2), "support/sparse": (1, 4.2), "core": (0, 1.2)}
TOP_ROW = max(row for row, column in PLACES.values())


def folder_name(folder, name):
    """The box of a target: all estimators are one, and so are the programs of a folder."""
    for outer in OUTER:
        if folder.parts[0] == outer:
            return outer
    if folder.parts[0] == "estimators":
        if "support" in folder.parts:
            return "support/" + name.removeprefix("support_")
        return "estimators" if name == "estimators" else "estimators/NAME"
    return name


def edges():
    """(module, module that it links) for every pair in the CMake files."""
    calls, boxes = [], {}
    for path in sorted(TOP.rglob("CMakeLists.txt")):
        folder = path.parent.relative_to(TOP)
        if not folder.parts or folder.parts[0] not in ("src", "estimators", *OUTER):
            continue
        text = re.sub(r"#.*", "", path.read_text())
        text = re.sub(r"function\(.*?endfunction\(\)", "", text, flags=re.DOTALL)
        for kind, name, rest in CALL.findall(text):
            name = name.removeprefix("fathom_")
            words = rest.split()
            if kind == "fathom_support":
                name = "support_" + name
            if kind == "fathom_estimator":
                words += ["fathom_estimation"]
                begin = words.index("SUPPORT") + 1 if "SUPPORT" in words else len(words)
                words += ["fathom_support_" + word for word in words[begin:]
                          if word in ("sparse", "pose_graph", "filter")]
            if kind == "fathom_adapter":
                words += ["fathom_estimation"]
            if name == "estimators" and kind == "fathom_module":
                words += ["fathom_ekf"]
            boxes[name] = folder_name(folder, name)
            calls.append((boxes[name], words))
    found = set()
    for box, words in calls:
        for word in words:
            name = re.sub(r"^fathom(_|::)", "", word)
            if name != word and name in boxes and boxes[name] != box:
                found.add((box, boxes[name]))
    return found


def without_implied(links):
    """The links that no longer way of others goes along."""
    def reaches(of, to):
        return (of, to) in links or any(reaches(mid, to) for one, mid in links if one == of)

    return {(of, to) for of, to in links
            if not any(one == of and mid != to and reaches(mid, to) for one, mid in links)}


def centre_of(name):
    row, column = PLACES[name]
    return (round(GAP + BOX_WIDTH / 2 + column * (BOX_WIDTH + GAP)),
            GAP + BOX_HEIGHT // 2 + (TOP_ROW - row) * ROW)


def drawn():
    links = without_implied(edges())
    for of, to in links:
        for name in (of, to):
            if name not in PLACES:
                sys.exit(f"house: {name} has no place in the picture; give it one in PLACES")
        if PLACES[of][0] <= PLACES[to][0]:
            sys.exit(f"house: {of} links {to}, and does not lie above it in PLACES")
    centre = {name: centre_of(name) for name in PLACES}
    width = max(x for x, y in centre.values()) + BOX_WIDTH // 2 + GAP
    height = TOP_ROW * ROW + BOX_HEIGHT + 2 * GAP
    lines = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" '
             f'width="{width}" height="{height}" font-family="sans-serif" font-size="14">',
             '<title>Modules, each with an arrow to what it is built on</title>',
             '<defs><marker id="tip" viewBox="0 0 10 10" refX="9" refY="5" markerWidth="8" '
             'markerHeight="8" orient="auto"><path d="M0,1 L9,5 L0,9 z" fill="#566"/></marker>'
             '</defs>',
             f'<rect width="{width}" height="{height}" fill="#ffffff"/>']
    for of, to in sorted(links):
        (x1, y1), (x2, y2) = centre[of], centre[to]
        y1, y2 = y1 + BOX_HEIGHT // 2, y2 - BOX_HEIGHT // 2
        bend = (y2 - y1) // 2
        lines.append(f'<path d="M{x1},{y1} C{x1},{y1 + bend} {x2},{y2 - bend} {x2},{y2}" '
                     'fill="none" stroke="#566" stroke-width="1.2" marker-end="url(#tip)"/>')
    for name, (x, y) in sorted(centre.items()):
        fill = "#e8f1f8" if name in OUTER else "#f7efe0" if "/" in name else "#ffffff"
        lines.append(f'<rect x="{x - BOX_WIDTH // 2}" y="{y - BOX_HEIGHT // 2}" '
                     f'width="{BOX_WIDTH}" height="{BOX_HEIGHT}" rx="5" fill="{fill}" '
                     'stroke="#344"/>')
        lines.append(f'<text x="{x}" y="{y + 5}" text-anchor="middle" fill="#122">{name}</text>')
    return "\n".join([*lines, "</svg>", ""])


def main():
    picture = drawn()
    if sys.argv[1:] == ["--check"]:
        if PICTURE.exists() and PICTURE.read_text() == picture:
            return 0
        print("house: docs/house.svg is not what the CMake files say; run scripts/house.py",
              file=sys.stderr)
        return 1
    PICTURE.write_text(picture)
    return 0


if __name__ == "__main__":
    sys.exit(main())
