"""Fathom: comparison of SLAM back ends for robots over a flat floor.

Poses are (x, y, theta) in metres and radians, x forward, y to port, theta counter-clockwise seen
from above. Measurements, residuals and covariances are those of docs/conventions.md.
"""

from . import _methods  # noqa: F401
from ._estimator import Estimator, Option, UpdateReport
from ._evaluate import evaluate, read_tum, write_tum
from ._fathom import (
    AbsolutePose,
    InputError,
    MeasurementLog,
    Measurements,
    PictureErrors,
    Registration,
    RelativePose,
    Setup,
    SharedErrors,
    Solution,
    anees_interval,
    bootstrap_interval,
    holm,
    moments,
    paired_difference,
    read_g2o,
    wilson_interval,
    write_g2o,
)
from ._fathom import version as __version__
from ._register import register
from ._run import estimators, options, replay, run, solve
from ._results import Results, open_results
from ._study import compare

__all__ = [
    "__version__",
    "AbsolutePose",
    "Estimator",
    "InputError",
    "MeasurementLog",
    "Measurements",
    "Option",
    "PictureErrors",
    "Registration",
    "RelativePose",
    "Results",
    "Setup",
    "SharedErrors",
    "Solution",
    "UpdateReport",
    "anees_interval",
    "bootstrap_interval",
    "compare",
    "estimators",
    "evaluate",
    "holm",
    "moments",
    "open_results",
    "options",
    "paired_difference",
    "read_g2o",
    "read_tum",
    "register",
    "replay",
    "run",
    "solve",
    "wilson_interval",
    "write_g2o",
    "write_tum",
]
