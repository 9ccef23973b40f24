"""Checks that every table and figure of the docs has a maker, without running any."""

from pathlib import Path

import markdown
import provenance
from maker import all_makers

EXCEPTIONS = Path(__file__).with_name("not_measured.txt")


def pages_of(top):
    """Paths of all pages, from the top of the repository."""
    docs = sorted(p.relative_to(top).as_posix() for p in (top / "docs").rglob("*.md"))
    return ["README.md", *docs]


def read_exceptions(text):
    """Lines 'PAGE: FIRST ROW => REASON' by (page, first row)."""
    table = {}
    for number, line in enumerate(text.split("\n"), 1):
        if not line.strip() or line.startswith("#"):
            continue
        place, arrow, reason = line.partition(" => ")
        page, colon, header = place.partition(": ")
        if not arrow or not colon or not reason.strip():
            raise markdown.PageError(
                f"{EXCEPTIONS.name}:{number}: wants 'PAGE: FIRST ROW => REASON'")
        table[page, header.strip()] = reason
    return table


def _tables_without_maker(pages, exceptions, known):
    used = set()
    for name, page in pages.items():
        for table in page.tables:
            if not markdown.is_of_numbers(table):
                continue
            place = name, table.header.strip()
            if table.maker:
                if place in exceptions:
                    yield f"{name}:{table.line}: has a maker and an exception"
            elif place in exceptions:
                used.add(place)
            else:
                yield (f"{name}:{table.line}: a table of numbers without a maker: "
                       f"{table.header.strip()[:60]}")
    for place in exceptions:
        if place not in used and place[0] in pages:
            yield f"{place[0]}: no such table of numbers needs its exception: {place[1][:60]}"
        if place[0] not in pages:
            yield f"{place[0]}: an exception of a page that is not there"
    for name, page in pages.items():
        for part in page.parts:
            if (name, part) not in known:
                yield f"{name}: '{part}' is between markers, and no maker makes it"


def _parts_without_line(pages, known):
    for (name, part), one in known.items():
        if name not in pages or part not in pages[name].parts:
            continue
        first, last = pages[name].parts[part]
        lines = [line for line in pages[name].lines[first:last] if provenance.GENERATED.match(line)]
        if len(lines) != 1:
            yield f"{name}: '{part}' has {len(lines)} lines that say how it was made, not one"
        elif not provenance.is_line_of(lines[0], one.how):
            yield f"{name}: '{part}' was made otherwise than its maker says: make it again"


def _makers_without_place(pages, known, top):
    for (page, name), one in known.items():
        if page not in pages:
            yield f"{page}: the page of the maker '{name}' is not there"
        elif name not in pages[page].parts:
            yield f"{page}: no markers for the maker '{name}'"
        for picture in one.pictures:
            if not (top / picture).is_file():
                yield f"{picture}: the picture of the maker '{name}' is not there"
    made = {picture for one in known.values() for picture in one.pictures}
    for file in sorted((top / "docs/images").iterdir()):
        if file.relative_to(top).as_posix() not in made:
            yield f"{file.relative_to(top)}: a picture without a maker"


def problems(top, makers=None, exceptions=None):
    """What is wrong with the pages: lines of text. Raises markdown.PageError."""
    top = Path(top)
    makers = all_makers() if makers is None else makers
    if exceptions is None:
        exceptions = read_exceptions(EXCEPTIONS.read_text(encoding="utf-8"))
    pages = {name: markdown.read_page(top / name) for name in pages_of(top)}
    known = {(one.page, one.name): one for one in makers}
    found = [] if len(known) == len(makers) else ["two makers of one page have the same name"]
    found += _tables_without_maker(pages, exceptions, known)
    found += _parts_without_line(pages, known)
    found += _makers_without_place(pages, known, top)
    return found
