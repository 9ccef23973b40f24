"""docs/configuration.md: what the program lists."""

from layout import fenced
from maker import maker


def _listing(what):
    @maker("docs/configuration.md", f"list-{what}", "quick", f"`fathom list {what}`", 0.1)
    def listing(work):
        return fenced(work.output(f"list-{what}", "fathom", "list", what))


for _what in ("estimators", "detectors", "datasets"):
    _listing(_what)
