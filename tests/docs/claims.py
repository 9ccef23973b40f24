"""What pages of results say of their tables with "no", "all", "any" and the like, held by tests.

A module of claims_of/ has the claims of a page:

    from claims import claim

    PAGE = "docs/cost.md"

    @claim(PAGE, "end at the least F on all nine")
    def all_at_the_least(t):
        return all(row.number("F") < 1.000001 for row in t("cost-all-batch"))

The fragment stands once on the page and holds the words to be shown; `t(NAME)` gives the rows of
the table between the markers NAME, `t(NAME, 1)` of the second one there, and `t.recorded(HEADER)`
those of a recorded table by how its first row begins. What such a word says of anything but a table
stands in claims_of/other.txt:
PAGE: FRAGMENT => what shows it.
"""

import importlib
import re
from dataclasses import dataclass
from pathlib import Path
from typing import Callable

import markdown

WORDS = re.compile(r"\b(?:no|none|nothing|never|all|any|every|always)\b", re.IGNORECASE)
FOLDER = Path(__file__).with_name("claims_of")
OTHER = FOLDER / "other.txt"
_VALUE = re.compile(r"[-+−]?(?:\d+\.?\d*|\.\d+)(?:(?:e|·10)[-+−⁻]?[\d⁰¹²³⁴⁵⁶⁷⁸⁹]+)?")
_RAISED = str.maketrans("⁰¹²³⁴⁵⁶⁷⁸⁹⁻−", "0123456789--")
_claims = []


@dataclass(frozen=True)
class Claim:
    page: str
    fragment: str
    holds: Callable  # Tables -> bool


def claim(page, fragment):
    """Declares the function below it as what shows `fragment` of `page`."""
    def declare(function):
        _claims.append(Claim(page, fragment, function))
        return function

    return declare


def all_claims():
    """The claims of every module of claims_of/."""
    if not _claims:
        for module in sorted(FOLDER.glob("*.py")):
            importlib.import_module(f"claims_of.{module.stem}")
    return list(_claims)


def numbers_of(cell):
    """All numbers of a cell, in order: the value first, then the ends of its interval."""
    text = cell.replace("*", "").replace("`", "")
    return [float(found.translate(_RAISED).replace("·10", "e")) for found in _VALUE.findall(text)]


class Row:
    """A row of a table by the names of its columns, emphasis and code marks aside."""

    def __init__(self, columns, cells):
        self._cells = dict(zip(columns, cells))

    def __getitem__(self, column):
        return self._cells[column]

    def __contains__(self, column):
        return column in self._cells

    def columns(self):
        return list(self._cells)

    def numbers(self, column):
        return numbers_of(self[column])

    def number(self, column):
        """The first number of the cell; nan where there is none, which no comparison holds."""
        return next(iter(self.numbers(column)), float("nan"))


def plain(cell):
    return cell.replace("*", "").replace("`", "").strip()


class Tables:
    """The tables of a page; `change` is done to each cell first."""

    def __init__(self, page, change=lambda cell: cell):
        self._page, self._change = page, change

    def _rows(self, found, what, index):
        if index >= len(found):
            raise LookupError(f"no table {what} on {self._page.path}")
        table = found[index]
        columns = [plain(cell) for cell in markdown.cells_of(table.header)]
        if len(set(columns)) != len(columns):
            columns = [f"{name}" if columns.index(name) == at else f"{name} {at}"
                       for at, name in enumerate(columns)]
        return [Row(columns, [self._change(plain(cell)) for cell in row]) for row in table.rows]

    def __call__(self, maker, index=0):
        found = [table for table in self._page.tables if table.maker == maker]
        return self._rows(found, f"made by '{maker}'", index)

    def recorded(self, header, index=0):
        found = [t for t in self._page.tables if not t.maker and t.header.startswith(header)]
        return self._rows(found, f"with the first row '{header}'", index)


def _is_measured(table, page, exceptions):
    if not markdown.is_of_numbers(table):
        return False
    reason = exceptions.get((page, table.header.strip()), "")
    return bool(table.maker) or "figures" in reason


def result_lines(name, page, exceptions):
    """Indices of the lines of text in sections of level 2 that have a table of measured figures,
    and of those named "In short"."""
    heads = [0]
    fenced = set()
    is_fenced = False
    for index, line in enumerate(page.lines):
        if line.startswith("```"):
            is_fenced = not is_fenced
            fenced.add(index)
        elif is_fenced:
            fenced.add(index)
        elif re.match(r"^##? ", line):
            heads.append(index)
    measured = [t.line for t in page.tables if _is_measured(t, name, exceptions)]
    for first, last in zip(heads, heads[1:] + [len(page.lines)]):
        is_short = page.lines[first].lower().endswith("in short")
        if is_short or any(first < line <= last for line in measured):
            for index in range(first, last):
                line = page.lines[index]
                if index not in fenced and not re.match(r"[|#!]|<!--|\*Made ", line):
                    yield index


def uncovered(line, fragments):
    """Words of the line that no fragment covers, each with some text about it. Targets of links do
    not count."""
    covered = [link.span() for link in re.finditer(r"\]\([^)]*\)", line)]
    for fragment in fragments:
        at = line.find(fragment)
        if at >= 0:
            covered.append((at, at + len(fragment)))
    for word in WORDS.finditer(line):
        if not any(first <= word.start() and word.end() <= last for first, last in covered):
            yield line[max(0, word.start() - 40):word.end() + 40]
