"""Draws maps of a run side by side, as SVG: ways, and pairs of keyframes as lines between them."""

from dataclasses import dataclass, field

SIZE, GAP, TITLE, LEGEND = 150.0, 8.0, 12.0, 22.0  # points
MARGIN = 14.0  # of a map, for its scale
# The colours of the program's own figures.
TRUTH = ("ground truth", 'stroke="#b0b0b0" stroke-width="2.2"')
DEAD_RECKONING = ("dead reckoning", 'stroke="#666666" stroke-width="0.8" stroke-dasharray="3 2"')
ESTIMATE = ("trajectory_iekf", 'stroke="#0072b2" stroke-width="0.9"')
PAIR = ("registered pair", 'stroke="#d55e00" stroke-width="0.5"')


@dataclass
class Map:
    """One map: lines of points, and pairs of points, each with its style."""

    title: str
    ways: list = field(default_factory=list)  # (style, points)
    pairs: list = field(default_factory=list)  # (style, [(point, point)])
    dots: list = field(default_factory=list)  # points

    def points(self):
        """All that is to be in view."""
        return [p for _, way in self.ways for p in way] + list(self.dots)


def _step(extent):
    """1, 2 or 5 times a power of ten: at most nine marks an axis."""
    return next(s * 10.0**e for e in range(-3, 6) for s in (1, 2, 5) if extent / (s * 10.0**e) < 9)


def _marks(low, high, step):
    first = -int(-low // step)
    return [step * i for i in range(first, int(high // step) + 1)]


class _Frame:
    """Places of a map on the page: x is up, y to the left, both of one scale."""

    def __init__(self, points, left, top):
        xs, ys = zip(*points)
        span = 1.04 * max(max(xs) - min(xs), max(ys) - min(ys))
        self.low = ((max(xs) + min(xs) - span) / 2, (max(ys) + min(ys) - span) / 2)
        self.span, self.left, self.top = span, left, top
        self.scale = (SIZE - MARGIN) / span

    def at(self, point):
        across = (self.low[1] + self.span - point[1]) * self.scale
        down = (self.low[0] + self.span - point[0]) * self.scale
        return self.left + MARGIN + across, self.top + down

    def path(self, points, style):
        places = " ".join(f"{u:.1f},{v:.1f}" for u, v in map(self.at, points))
        return f'<polyline points="{places}" fill="none" {style}/>'

    def scale_lines(self):
        """Grid and numbers."""
        grey = 'stroke="#e4e4e4" stroke-width="0.5"'
        (low_x, low_y), span = self.low, self.span
        for mark in _marks(low_x, low_x + span, _step(span)):
            yield self.path([(mark, low_y), (mark, low_y + span)], grey)
            v = self.at((mark, low_y))[1]
            yield f'<text x="{self.left + MARGIN - 2:.1f}" y="{v + 2:.1f}" text-anchor="end">' \
                  f"{mark:g}</text>"
        for mark in _marks(low_y, low_y + span, _step(span)):
            yield self.path([(low_x, mark), (low_x + span, mark)], grey)
            u = self.at((low_x, mark))[0]
            yield f'<text x="{u:.1f}" y="{self.top + SIZE - MARGIN + 8:.1f}" ' \
                  f'text-anchor="middle">{mark:g}</text>'


def _draw(one, left, top):
    frame = _Frame(one.points(), left, top + TITLE)
    yield f'<text x="{left + MARGIN:.1f}" y="{top + 8:.1f}" font-size="7">{one.title}</text>'
    yield from frame.scale_lines()
    for (_, style), pairs in one.pairs:
        for pair in pairs:
            yield frame.path(pair, style)
    for (_, style), way in one.ways:
        yield frame.path(way, style)
    for u, v in map(frame.at, one.dots):
        yield f'<circle cx="{u:.1f}" cy="{v:.1f}" r="1"/>'


def svg_of(maps, columns):
    """All maps, row by row, with a legend below."""
    rows = -(-len(maps) // columns)
    width = columns * (SIZE + GAP)
    height = rows * (SIZE + TITLE + GAP) + LEGEND
    lines = [f'<svg xmlns="http://www.w3.org/2000/svg" width="{width:g}pt" height="{height:g}pt" '
             f'viewBox="0 0 {width:g} {height:g}" font-family="sans-serif" font-size="6">',
             f'<rect width="{width:g}" height="{height:g}" fill="#ffffff"/>']
    styles = {}
    for index, one in enumerate(maps):
        lines += _draw(one, (index % columns) * (SIZE + GAP),
                       (index // columns) * (SIZE + TITLE + GAP))
        styles |= dict(style for style, _ in one.ways + one.pairs)
    left, v = MARGIN, height - LEGEND + 4
    for name, style in styles.items():
        lines.append(f'<path d="M{left:.1f} {v:.1f}h16" fill="none" {style}/>'
                     f'<text x="{left + 19:.1f}" y="{v + 2:.1f}">{name}</text>')
        left += 30 + 3.4 * len(name)
    lines.append(f'<text x="{MARGIN:g}" y="{height - 5:g}">metres, x up, y to the left'
                 "</text></svg>")
    return "\n".join(lines) + "\n"


def ways_of(runs, title):
    """A map of ground truth, dead reckoning and the paper's filter, of the first run."""
    return Map(title, [(TRUTH, runs.way("dead_reckoning", of_truth=True)),
                       (DEAD_RECKONING, runs.way("dead_reckoning")),
                       (ESTIMATE, runs.way("trajectory_iekf"))])


def pairs_of(runs, title):
    """A map of the pairs that were registered, of the first run."""
    points = runs.way("trajectory_iekf")
    pairs = [(points[i], points[k]) for i, k in runs.pairs("trajectory_iekf")]
    return Map(f"{title}: {len(points)} keyframes, {len(pairs)} pairs", pairs=[(PAIR, pairs)],
               dots=points)
