"""Words that are looked up: a wrong one is refused with the nearest that there is."""

from ._fathom import InputError, _suggestion

DEAD_RECKONING = "dead_reckoning"  # has runs of a study beside the estimators
MOST_LISTED = 12  # names where none is near


class UnknownName(InputError, KeyError):
    """No such name; the message has the nearest one."""

    __str__ = ValueError.__str__  # that of KeyError puts the text in quotes


def unknown(kind, word, among) -> UnknownName:
    names = [str(one) for one in among]
    hint = _suggestion(str(word), names)
    if not hint:
        more = " and others" if len(names) > MOST_LISTED else ""
        hint = f"; there are {', '.join(names[:MOST_LISTED])}{more}" if names else "; there is none"
    return UnknownName(f"unknown {kind} '{word}'{hint}")


def known(kind, word, among):
    """The word, which is among these, or raises UnknownName."""
    if word not in among:
        raise unknown(kind, word, among)
    return word


class Named(dict):
    """A dict whose keys are names of a kind: one that is missing raises UnknownName."""

    __slots__ = ("_kind",)

    def __init__(self, kind, values):
        super().__init__(values)
        self._kind = kind

    def __missing__(self, name):
        raise unknown(self._kind, name, self)


def shown(value) -> str:
    """What was given in place of something else."""
    if isinstance(value, type):
        return f"the class {value.__qualname__}"
    if value is None or isinstance(value, (bool, int, float, str)):
        return repr(value)
    return f"an object of {type(value).__qualname__}"


def number_or_text(label):
    """A value of an axis as a number, where it is one."""
    try:
        return float(label)
    except ValueError:
        return label
