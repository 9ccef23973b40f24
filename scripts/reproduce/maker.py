"""What makes a table or figure of the docs, and the list of all of them."""

import importlib
import pkgutil
from dataclasses import dataclass
from typing import Callable

KINDS = ("quick", "slow", "time")
_makers = []


@dataclass(frozen=True)
class Maker:
    """One generated part of a page.

    `kind` says what its figures are: `quick` ones take seconds and are the same each time, so that
    a test compares them with the page; `slow` ones take minutes or hours; those of `time` are times
    (or beside times) of one machine, which nothing compares.
    """

    page: str  # from the top of the repository
    name: str  # of its markers
    kind: str
    how: str  # the commands, as a reader would type them
    minutes: float  # on one core, about
    make: Callable  # Workshop -> Markdown
    needs: tuple = ()  # files or folders of the data
    programs: tuple = ("fathom",)
    pictures: tuple = ()  # files that it writes, from the top of the repository


def maker(page, name, kind, how, minutes, **rest):
    """Declares the function below it as the maker of a part of a page."""
    assert kind in KINDS, kind

    def declare(function):
        _makers.append(Maker(page, name, kind, how, minutes, function, **rest))
        return function

    return declare


def all_makers():
    """Every maker, page by page."""
    if not _makers:
        import pages

        for module in sorted(m.name for m in pkgutil.iter_modules(pages.__path__)):
            importlib.import_module(f"pages.{module}")
    return sorted(_makers, key=lambda one: one.page)
