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
