"""Follows a page as its reader does, in an empty folder: writes its files, runs its commands, and
holds the output that it shows against what they print.

    page_runner.py PAGE PROGRAM [--without-python]

A block with a title is a file, a block of `sh` is run, a block without a language is what the
commands before it print. There "…" stands for anything, a line of its own for any lines. Blanks and
rules do not count, and a number may differ by 30 %, as another processor rounds otherwise; all that
is no number is the same. --without-python ends at the first file in Python.
"""

import os
import re
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

_FENCE = re.compile(r'```(\w*)(?: title="([^"]*)")?$')
_NUMBER = re.compile(r"(?<![\w.])[-+−]?\d+(?:\.\d+)?(?:e[-+]?\d+)?(?!\w)")
TOLERANCE = 0.3


class PageError(Exception):
    """What on the page does not hold, and where."""


@dataclass(frozen=True)
class Block:
    line: int  # of its fence, from 1
    language: str
    title: str
    text: str


def blocks_of(text):
    blocks, opened, lines = [], None, []
    for number, line in enumerate(text.splitlines(), 1):
        if not line.startswith("```"):
            lines.append(line)
        elif opened:
            blocks.append(Block(*opened, "".join(f"{one}\n" for one in lines)))
            opened = None
        else:
            fence = _FENCE.match(line)
            if not fence:
                raise PageError(f"line {number}: not a fence: {line}")
            opened, lines = (number, fence[1], fence[2] or ""), []
    if opened:
        raise PageError(f"line {opened[0]}: a fence is left open")
    return blocks


def _same_numbers(shown, printed):
    a, b = (float(text.replace("−", "-")) for text in (shown, printed))
    return abs(a - b) <= TOLERANCE * max(abs(a), abs(b))


def is_shown_by(shown, printed):
    """Whether a line of a page stands for a line of output."""
    wanted, given = (" ".join(line.split()) for line in (shown, printed))
    words = [re.escape(text).replace("…", ".*") for text in _NUMBER.split(wanted)]
    found = re.fullmatch(r"(\S+?)".join(words), given)
    return bool(found) and all(
        bool(_NUMBER.fullmatch(value)) and _same_numbers(number, value)
        for number, value in zip(_NUMBER.findall(wanted), found.groups()))


def missing_line(shown, printed):
    """The first line of `shown` that does not follow in `printed` where it should, or None."""
    rest, may_skip = printed.splitlines(), True
    for line in shown.splitlines():
        if line.strip() == "…":
            may_skip = True
            continue
        at = next((n for n, one in enumerate(rest) if is_shown_by(line, one)), None)
        if at is None or (not may_skip and any(one.strip(" -") for one in rest[:at])):
            return line
        rest, may_skip = rest[at + 1:], False
    return None


def follow(text, folder, environment, with_python=True):
    """Does what a page says. Returns the number of blocks that were run; raises PageError."""
    printed, count = "", 0
    for block in blocks_of(text):
        if block.language == "python" and not with_python:
            break
        if block.title:
            (folder / block.title).write_text(block.text, encoding="utf-8")
        elif block.language == "sh":
            done = subprocess.run(["bash", "-e", "-u", "-c", block.text], cwd=folder, check=False,
                                  env=environment, text=True, stdout=subprocess.PIPE,
                                  stderr=subprocess.STDOUT)
            printed, count = done.stdout, count + 1
            if done.returncode != 0:
                raise PageError(f"line {block.line}: status {done.returncode}:\n{printed}")
        elif block.language:
            raise PageError(f"line {block.line}: {block.language} is neither run nor a file")
        else:
            line = missing_line(block.text, printed)
            if line is not None:
                raise PageError(f"line {block.line}: not printed: {line}\nbut:\n{printed}")
    return count


def main(page, program, *flags):
    with tempfile.TemporaryDirectory() as folder:
        work = Path(folder) / "work"
        work.mkdir()
        environment = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}
        environment.update(FATHOM_CACHE=str(Path(folder) / "cache"), LC_ALL="C.UTF-8",
                           PATH=f"{Path(program).resolve().parent}:{os.environ['PATH']}")
        try:
            count = follow(Path(page).read_text("utf-8"), work, environment,
                           "--without-python" not in flags)
        except PageError as error:
            sys.exit(f"{page}: {error}")
    print(f"{page}: {count} blocks of commands")


if __name__ == "__main__":
    main(*sys.argv[1:])
