"""Draws which pairs of keyframes of a run were registered, as lines between them (SVG)."""

import sqlite3
import struct

SIZE, MARGIN = 252, 30  # points, as the program's figures have it
_SERIES = """SELECT data FROM series JOIN run USING (run) JOIN estimator USING (estimator)
             WHERE cell = ? AND survey = 0 AND trial = 0 AND estimator.name = ? AND series.name = ?
          """


def _cell_of(store, cell):
    """The number of the cell with these labels."""
    found = {row[0] for row in store.execute("SELECT cell FROM cell")}
    for axis, label in cell.items():
        found &= {row[0] for row in store.execute(
            "SELECT cell FROM cell_value JOIN axis USING (axis) JOIN axis_value USING (axis, place)"
            " WHERE name = ? AND label = ?", (axis, str(label)))}
    if len(found) != 1:
        raise LookupError(f"{len(found)} cells of {cell}")
    return found.pop()


def _series(store, cell, estimator, name):
    row = store.execute(_SERIES, (cell, estimator, name)).fetchone()
    if row is None:
        raise LookupError(f"no series {name} of {estimator}")
    return struct.unpack(f"<{len(row[0]) // 8}d", row[0])


def registered_pairs(study, estimator, cell):
    """Positions of the keyframes of the first run, and the pairs whose registrations it used."""
    store = sqlite3.connect(f"file:{study.folder / 'results.sqlite'}?mode=ro", uri=True)
    try:
        number = _cell_of(store, cell)
        x, y, first, last, fate = (
            _series(store, number, estimator, name)
            for name in ("x_m", "y_m", "loop_from", "loop_to", "loop_fate"))
    finally:
        store.close()
    pairs = [(int(i), int(k)) for i, k, f in zip(first, last, fate) if f == 0]
    return list(zip(x, y)), pairs


def _step(extent):
    """1, 2 or 5 times a power of ten: four to ten marks an axis."""
    return next(s * 10.0**e for e in range(-3, 6) for s in (1, 2, 5) if extent / (s * 10.0**e) < 9)


def _marks(low, high, step):
    first = int(low // step) + (low % step > 0)
    return [step * i for i in range(first, int(high // step) + 1)]


def svg_of(points, pairs):
    """The map as text: x is up, y to the left, both axes of one scale."""
    xs, ys = zip(*points)
    low_x, low_y = min(xs) - 0.5, min(ys) - 0.5
    extent = max(max(xs) - min(xs), max(ys) - min(ys)) + 1.0
    scale = (SIZE - MARGIN - 4) / extent

    def at(x, y):
        return (f"{SIZE - 4 - (y - low_y) * scale:.2f}", f"{4 + (low_x + extent - x) * scale:.2f}")

    def line(a, b, style):
        (x1, y1), (x2, y2) = at(*a), at(*b)
        return f'<path d="M{x1} {y1}L{x2} {y2}" {style}/>'

    lines = [f'<svg xmlns="http://www.w3.org/2000/svg" width="{SIZE}pt" height="{SIZE}pt" '
             f'viewBox="0 0 {SIZE} {SIZE}" font-family="sans-serif" font-size="7">',
             f'<rect width="{SIZE}" height="{SIZE}" fill="#ffffff"/>']
    grey = 'stroke="#dddddd" stroke-width="0.5"'
    step = _step(extent)
    for mark in _marks(low_x, low_x + extent, step):
        lines.append(line((mark, low_y), (mark, low_y + extent), grey))
        _, v = at(mark, 0)
        lines.append(f'<text x="{MARGIN - 3}" y="{v}" text-anchor="end" '
                     f'dominant-baseline="middle">{mark:g}</text>')
    for mark in _marks(low_y, low_y + extent, step):
        lines.append(line((low_x, mark), (low_x + extent, mark), grey))
        u, _ = at(0, mark)
        lines.append(f'<text x="{u}" y="{SIZE - MARGIN + 12}" text-anchor="middle">{mark:g}</text>')
    blue = 'stroke="#0072b2" stroke-width="0.6"'
    lines += [line(points[i], points[k], blue) for i, k in pairs]
    for point in points:
        u, v = at(*point)
        lines.append(f'<circle cx="{u}" cy="{v}" r="1.2"/>')
    lines.append(f'<text x="{SIZE / 2:g}" y="{SIZE - 4}" text-anchor="middle">y, to the left (m); '
                 f'x up; {len(points)} keyframes, {len(pairs)} registered pairs</text></svg>')
    return "\n".join(lines) + "\n"


def write_pair_map(study, estimator, cell):
    """Beside the study's own figures. Returns the file."""
    name = "_".join(f"{axis}_{label}" for axis, label in cell.items()).replace(" ", "_")
    file = study.folder / f"registered_pairs_{name}.svg"
    file.write_text(svg_of(*registered_pairs(study, estimator, cell)), encoding="utf-8")
    return file
