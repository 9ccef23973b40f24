"""Fathom: comparison of SLAM back ends for robots over a flat floor.

Poses are (x, y, theta) in metres and radians, x forward, y to port, theta counter-clockwise seen
from above.
"""

from ._fathom import InputError, MeasurementLog, Solution, estimators, read_g2o, solve, write_g2o

__all__ = [
    "InputError",
    "MeasurementLog",
    "Solution",
    "estimators",
    "read_g2o",
    "solve",
    "write_g2o",
]
