"""Registration of two pictures."""

import math
import numbers

import numpy

from . import _fathom
from ._fathom import InputError
from ._names import shown
from ._settings import settings_of


def _real(value) -> float:
    """Of any type of number, those of numpy as well; NaN of what is none."""
    try:
        return math.nan if isinstance(value, str) else float(value)
    except (TypeError, ValueError):
        return math.nan


def register(
    a, b, altitude_a, altitude_b, camera, *, front_end=None, tilt_a=None, tilt_b=None, seed=1
):
    """The motion between two pictures of the floor, as the front end finds it.

    a, b: grey pictures, H x W arrays of uint8.
    altitude_a, altitude_b: of the camera over the floor, m.
    camera: a dict of the keys of `dataset.camera` (width, height, fx, fy, ...), pixels and m.
    front_end: a dict of the keys of `front_end`.
    tilt_a, tilt_b: measured (roll, pitch, sigma), rad; None: level, with the sigma of
        front_end.registration.covariance.tilt_sigma_rad.
    Returns a Registration; raises InputError.
    """
    for of, picture, altitude in (("a", a, altitude_a), ("b", b, altitude_b)):
        if not isinstance(picture, numpy.ndarray):
            raise InputError(f"{of}: expected an array of H x W uint8, got {shown(picture)}")
        if not 0 < _real(altitude) < math.inf:
            raise InputError(
                f"altitude_{of}: expected a number of metres above 0, got {shown(altitude)}"
            )
    if not (isinstance(seed, numbers.Integral) and 0 <= seed < 2**64):
        raise InputError(f"seed: expected a whole number from 0, got {shown(seed)}")
    return _fathom._register(
        a,
        b,
        float(altitude_a),
        float(altitude_b),
        settings_of(camera, "camera"),
        settings_of(front_end or {}, "front_end"),
        tilt_a,
        tilt_b,
        seed,
    )
