"""Numbers and tables as the pages have them."""

import math

NOTHING = "–"


def significant(value, digits=3):
    """A number with so many significant digits, no exponent; None is a dash."""
    if value is None or math.isnan(value):
        return NOTHING
    if value == 0 or math.isinf(value):
        return f"{value:.0f}"
    places = digits - 1 - math.floor(math.log10(abs(value)))
    rounded = round(value, places)  # 9.996 has another magnitude then
    places = digits - 1 - math.floor(math.log10(abs(rounded)))
    return f"{rounded:.{max(places, 0)}f}"


def fixed(value, places):
    """A number with so many places behind the point; None is a dash."""
    return NOTHING if value is None or math.isnan(value) else f"{value:.{places}f}"


def interval(row, digits=3, scale=1.0):
    """Mean and 95 % interval of a row of summary.csv: 1.11 [1.01, 1.23]."""
    text = significant(row["mean"] and row["mean"] * scale, digits)
    if row.get("low_95") is None or row["low_95"] == row["high_95"]:
        return text
    low, high = (significant(row[key] * scale, digits) for key in ("low_95", "high_95"))
    return f"{text} [{low}, {high}]"


def _binomial_tail(k, n, p):
    """P(X ≥ k) of n draws."""
    return sum(math.comb(n, i) * p**i * (1 - p) ** (n - i) for i in range(k, n + 1))


def _bisected(rises):
    low, high = 0.0, 1.0
    for _ in range(50):
        middle = (low + high) / 2
        low, high = (low, middle) if rises(middle) > 0 else (middle, high)
    return (low + high) / 2


def share_interval(k, n):
    """The exact 95 % interval of a share of which k of n were seen (Clopper and Pearson 1934)."""
    low = _bisected(lambda p: _binomial_tail(k, n, p) - 0.025) if k else 0.0
    high = _bisected(lambda p: _binomial_tail(k + 1, n, p) - 0.975) if k < n else 1.0
    return low, high


def share(k, n):
    """A count with the interval of its share: 3 of 60 [1, 14] %."""
    if n == 0:
        return NOTHING
    low, high = (significant(100 * value, 2) for value in share_interval(k, n))
    return f"{k} of {n} [{low}, {high}] %"


def table(header, rows):
    """A Markdown table."""
    lines = ["| " + " | ".join(header) + " |", "|" + "---|" * len(header)]
    for row in rows:
        assert len(row) == len(header), (header, row)
        lines.append("| " + " | ".join(str(cell) for cell in row) + " |")
    return "\n".join(line.replace("|  |", "| |").replace("|  |", "| |") for line in lines) + "\n"


def code(names):
    """Names as code."""
    return [f"`{name}`" for name in names]


def fenced(text):
    """A fenced block."""
    return "```\n" + text.strip("\n") + "\n```\n"
