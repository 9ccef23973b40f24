"""Registration of two pictures."""

from . import _fathom
from ._settings import settings_of


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
    return _fathom._register(
        a,
        b,
        altitude_a,
        altitude_b,
        settings_of(camera, "camera"),
        settings_of(front_end or {}, "front_end"),
        tilt_a,
        tilt_b,
        seed,
    )
