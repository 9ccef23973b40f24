"""The map of docs/tutorial.md."""

import re

from maker import maker

PAGE = "docs/tutorial.md"


def _file_of(work, name):
    """A file that the page shows, as a file."""
    page = (work.top / PAGE).read_text("utf-8")
    text = re.search(rf'```yaml title="{re.escape(name)}"\n(.*?)```', page, re.DOTALL)[1]
    path = work.folder.absolute() / f"tutorial-{name}"
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text, encoding="utf-8")
    return path


@maker(PAGE, "tutorial", "slow",
       "`fathom run run.yaml --out second --set estimator.type=incremental_smoother`", 1,
       pictures=("docs/images/tutorial.png",))
def tutorial(work):
    pictures = work.run("tutorial-pictures", "fathom", "simulate", _file_of(work, "survey.yaml"),
                        "--out", "{out}/pictures")
    run = work.run("tutorial-run", "fathom", "run", _file_of(work, "run.yaml"), "--out",
                   "{out}/second", "--set", f"dataset.path={pictures / 'pictures'}",
                   "--set", "estimator.type=incremental_smoother")
    work.picture("docs/images/tutorial.png", run / "second/trajectory.png")
    return ("![Four legs of a survey: dead reckoning drifts by more than a metre, the estimate "
            "lies on the ground truth](images/tutorial.png)")
