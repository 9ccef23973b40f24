"""docs/reliability.md: what scripts/check.sh ran, when, at which commit, and how it ended."""

from layout import table
from maker import maker
from workshop import CommandFailed

RECORD = "build/check/record.tsv"


@maker("docs/reliability.md", "checks", "time", "`scripts/check.sh`", 600, programs=())
def checks(work):
    file = work.top / RECORD
    if not file.is_file():
        raise CommandFailed(f"there is no {RECORD}: scripts/check.sh writes it")
    rows = [line.split("\t") for line in file.read_text(encoding="utf-8").splitlines()]
    return table(["stage", "result", "counted", "minutes", "commit", "date"],
                 [[stage, result, counted, f"{int(seconds) / 60:.0f}", commit, date]
                  for stage, result, counted, seconds, commit, date in rows])
