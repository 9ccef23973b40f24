"""How far work has come, for who looks at it."""

import contextlib
import sys
import time

SHOWN_AFTER_S = 0.5  # what is done sooner needs no bar
SHOWN_EVERY_S = 0.2


def heard_by(progress):
    """A context manager of what is called with how far the work is, or of None. `progress`: True,
    False, None (where somebody looks), or a function."""
    if callable(progress):
        return contextlib.nullcontext(progress)
    if progress or (progress is None and _somebody_looks()):
        return _Bar()
    return contextlib.nullcontext(None)


def _somebody_looks() -> bool:
    if sys.stderr is not None and sys.stderr.isatty():
        return True
    # A notebook's kernel writes to a stream that is no terminal.
    shell = getattr(sys.modules.get("IPython"), "get_ipython", lambda: None)()
    return type(shell).__name__ == "ZMQInteractiveShell"


class _Bar:
    """A bar of tqdm, or a line where that is not installed; one for each stage of a run."""

    def __init__(self):
        self._bar = None
        self._stage = None

    def __enter__(self):
        return self

    def __exit__(self, *error):
        if self._bar is not None:
            self._bar.close()

    def __call__(self, at):
        runs = "of" in at  # of a study; else steps of a stage
        stage = "runs" if runs else at["stage"]
        done, of = (at["done"], at["of"]) if runs else (at["step"], at["steps"])
        if stage != self._stage:
            self.__exit__()
            self._stage, self._bar = stage, _made(stage, of)
        self._bar.n = done
        self._bar.set_postfix_str(_details(at) if runs else "", refresh=False)
        self._bar.update(0)


def _details(at) -> str:
    failed = f"{at['failed']} failed, " if at["failed"] else ""
    return failed + (f"{at['stage']} {at['step']}/{at['steps']}" if at["stage"] else "")


def _made(stage, of):
    try:
        from tqdm.auto import tqdm
    except ImportError:
        return _Line(stage, of)

    class Bar(tqdm):
        monitor_interval = 0  # no thread of its own: runs fork

    return Bar(total=of, desc=stage, delay=SHOWN_AFTER_S, leave=False, file=sys.stderr)


class _Line:
    """What of tqdm's bar is used, as a line that is written over itself."""

    def __init__(self, stage, of):
        self.n = 0
        self._stage, self._of = stage, of
        self._details = ""
        self._next = time.monotonic() + SHOWN_AFTER_S
        self._width = 0

    def set_postfix_str(self, details, refresh):
        self._details = details

    def update(self, _):
        if time.monotonic() < self._next:
            return
        self._next = time.monotonic() + SHOWN_EVERY_S
        text = f"{self._stage} {self.n}/{self._of} {self._details}".rstrip()
        self._write(text)
        self._width = len(text)

    def close(self):
        if self._width:
            self._write("")
            sys.stderr.write("\r")

    def _write(self, text):
        sys.stderr.write("\r" + text.ljust(self._width))
        sys.stderr.flush()
