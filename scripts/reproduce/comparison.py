"""Compares what a page says with what its maker gives."""

import re

from provenance import GENERATED

NUMBER = re.compile(r"(?<![A-Za-z_\d.])[-+−]?\d+(?:\.\d+)?(?:e[-+]?\d+)?")


def _content(text):
    """Lines without the generated one, blanks alike."""
    lines = [re.sub(r"\s+", " ", line).strip() for line in text.split("\n")]
    return [line for line in lines if line and not GENERATED.match(line)]


def _last_place(text):
    """Value of one unit in the last written place; 0 of a whole number, which is to be exact."""
    mantissa, _, exponent = text.partition("e")
    if "." not in mantissa:
        return 10.0 ** int(exponent) if exponent else 0.0
    return 10.0 ** (int(exponent or 0) - len(mantissa.split(".")[1]))


def numbers_agree(old, new):
    """Whether two written numbers are the same, but for one unit in the last place of the coarser:
    processors round otherwise. Whole numbers are counts and agree exactly or not at all."""
    slack = max(_last_place(old), _last_place(new))
    a, b = (float(text.replace("−", "-")) for text in (old, new))
    return abs(a - b) <= slack * 1.000001


def _line_agrees(old, new):
    if NUMBER.split(old) != NUMBER.split(new):
        return False
    return all(map(numbers_agree, NUMBER.findall(old), NUMBER.findall(new)))


def differences(page_text, made_text):
    """What differs between a part of a page and what its maker gives: lines of text."""
    old, new = _content(page_text), _content(made_text)
    if len(old) != len(new):
        return [f"{len(old)} lines on the page, {len(new)} made"]
    return [f"the page has '{a}', made is '{b}'" for a, b in zip(old, new)
            if not _line_agrees(a, b)]
