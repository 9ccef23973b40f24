"""Positions of a survey: of an estimate, of GPS, and how far they are apart."""


def poses_of(file):
    """x + iy by time stamp."""
    rows = [line.split() for line in file.read_text("utf-8").splitlines() if line[:1] != "#"]
    return {row[0]: complex(float(row[1]), float(row[2])) for row in rows}


def scale_and_error(estimate, reference):
    """Of the similarity that brings the estimate nearest to the reference: its scale, and the mean
    distance that is left."""
    pairs = [(estimate[t], reference[t]) for t in reference if t in estimate]
    a_mean, b_mean = (sum(side) / len(pairs) for side in zip(*pairs))
    pairs = [(a - a_mean, b - b_mean) for a, b in pairs]
    turn = sum(a.conjugate() * b for a, b in pairs) / sum(abs(a) ** 2 for a, _ in pairs)
    return abs(turn), sum(abs(turn * a - b) for a, b in pairs) / len(pairs)


def between_fixes(given, held_out):
    """Distances of held-out places from the straight line between the fixes around them."""
    times = sorted(given, key=float)
    found = []
    for time, place in held_out.items():
        before = max((t for t in times if float(t) < float(time)), key=float, default=None)
        after = min((t for t in times if float(t) > float(time)), key=float, default=None)
        if before is None or after is None:
            continue
        share = (float(time) - float(before)) / (float(after) - float(before))
        found.append(abs(given[before] + share * (given[after] - given[before]) - place))
    return sorted(found)
