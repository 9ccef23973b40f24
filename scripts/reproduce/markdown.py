"""Pages of the docs: what lies between markers, tables, and which of them hold numbers.

A generated part of a page is

    <!-- made: NAME -->
    ... what the maker NAME gives ...
    <!-- end: NAME -->
"""

import re
from dataclasses import dataclass, field
from pathlib import Path

OPENS = re.compile(r"^<!-- made: ([a-z0-9-]+) -->$")
ENDS = re.compile(r"^<!-- end: ([a-z0-9-]+) -->$")
IMAGE = re.compile(r"!\[[^\]]*\]\(([^)\s]+)\)")
# What may stand before the digits of a measured value.
NUMBER = re.compile(r"^(?:below|about|some|up to|at most|within|>|<|≤|≥|~|±|\(|\s)*[-+−]?\.?[0-9]")
# Text tables of the program: columns under a line of dashes, two blanks apart.
DASHES = re.compile(r"^-{4,}(?:  -{3,})+$")

# A table is one of numbers from this share of its cells on, those of the first column left out.
# Low, so that a table with words beside its figures counts; tables that only look like it are named
# with a reason in not_measured.txt.
LEAST_SHARE = 0.25


class PageError(Exception):
    """A page whose markers do not pair: FILE:LINE: what, and what would be right."""


@dataclass
class Table:
    """A Markdown table, or a fenced text table of the program."""

    line: int  # of its first row, from 1
    header: str  # the first row as it stands
    rows: list = field(default_factory=list)  # of the body: lists of cells
    maker: str = ""  # between whose markers it lies; empty: none
    is_text: bool = False  # fenced


@dataclass
class Page:
    """A page taken apart."""

    path: Path
    lines: list
    tables: list
    parts: dict  # name: (first, last) indices of the lines between the markers, last exclusive
    images: list  # (line, target, maker)


def cells_of(row):
    """The cells of a row of a Markdown table; "\\|" is no border."""
    return [cell.strip() for cell in re.split(r"(?<!\\)\|", row.strip().strip("|"))]


def is_number(cell):
    """Whether a cell begins with a number, emphasis and code marks aside."""
    return bool(NUMBER.match(cell.replace("*", "").replace("`", "").strip()))


def is_of_numbers(table):
    """Whether a table holds figures that somebody measured, by the rule of LEAST_SHARE."""
    if table.is_text:
        return True
    cells = [cell for row in table.rows for cell in (row[1:] if len(row) > 1 else row) if cell]
    return bool(cells) and sum(map(is_number, cells)) >= LEAST_SHARE * len(cells)


class _Reader:
    def __init__(self, path, text):
        self.page = Page(path, text.split("\n"), [], {}, [])
        self.maker, self.opened = "", 0
        self.is_fenced = False
        self.table = None

    def fail(self, index, what):
        raise PageError(f"{self.page.path}:{index + 1}: {what}")

    def read(self):
        for index, line in enumerate(self.page.lines):
            if line.startswith("```"):
                self.is_fenced = not self.is_fenced
                self.table = None
            elif self.is_fenced:
                self.fenced(index, line)
            else:
                self.open_text(index, line)
        if self.maker:
            self.fail(self.opened, f"'{self.maker}' has no '<!-- end: {self.maker} -->'")
        return self.page

    def fenced(self, index, line):
        # One table a fence: further rules are those of its other parts.
        if DASHES.match(line) and self.table is None:
            self.table = Table(index, self.page.lines[index - 1], [], self.maker, True)
            self.page.tables.append(self.table)

    def open_text(self, index, line):
        opens, ends = OPENS.match(line), ENDS.match(line)
        if opens:
            self.open_part(index, opens[1])
        elif ends:
            self.end_part(index, ends[1])
        elif re.match(r"^<!-- *(made|end)\b", line):
            self.fail(index, "a marker is '<!-- made: NAME -->' or '<!-- end: NAME -->', "
                      "NAME of a-z, 0-9 and '-'")
        for target in IMAGE.findall(line):
            self.page.images.append((index + 1, target, self.maker))
        self.row(index, line)

    def open_part(self, index, name):
        if self.maker:
            self.fail(index, f"'{name}' begins inside of '{self.maker}'")
        if name in self.page.parts:
            self.fail(index, f"'{name}' is there twice")
        self.maker, self.opened = name, index

    def end_part(self, index, name):
        if name != self.maker:
            self.fail(index, f"'{name}' ends here, '{self.maker or 'nothing'}' is open")
        self.page.parts[name] = (self.opened + 1, index)
        self.maker = ""

    def row(self, index, line):
        if not line.startswith("|"):
            self.table = None
        elif self.table is None:
            self.table = Table(index + 1, line, [], self.maker)
            self.page.tables.append(self.table)
        elif not re.match(r"^\|[\s:|-]+\|$", line) or "---" not in line:
            self.table.rows.append(cells_of(line))


def read_text(path, text):
    """Takes a page apart. Raises PageError."""
    return _Reader(path, text).read()


def read_page(path):
    """The same, of a file."""
    return read_text(path, Path(path).read_text(encoding="utf-8"))


def replace_part(page, name, content):
    """The text of the page with other content between the markers of `name`, blank lines about it:
    without them a comment would take the table in."""
    first, last = page.parts[name]
    content = ["", *content.strip("\n").split("\n"), ""]
    return "\n".join(page.lines[:first] + content + page.lines[last:])


def tables_of(text):
    """The tables of what a program printed, as (cells of the first row, rows)."""
    return [(cells_of(table.header), table.rows) for table in read_text("output", text).tables]
