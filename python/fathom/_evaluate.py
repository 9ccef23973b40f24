"""Trajectories against a reference."""

import os

from . import _fathom
from ._names import Named


def evaluate(estimate, reference, *, alignment="origin", covariances=None) -> dict:
    """How far an estimate is from its reference, and how honest it is.

    estimate, reference: N x 3 poses that belong together one by one, m and rad.
    alignment: 'none', 'origin' or 'se2'; never scale.
    covariances: N x 3 x 3 of the estimate's poses, world axes; with them the ANEES is told, of
        'none' or 'origin': in place of 'se2', which would take away errors that the covariances
        speak of, it is of 'origin', as in studies.
    Returns a dict; what is not known is absent. Raises InputError, also on a pose that is not
    finite and on a covariance that is not positive definite; the first one may be zero.
    """
    return Named("metric", _fathom._evaluate(estimate, reference, alignment, covariances))


def read_tum(path):
    """Times (N,), int64 ns, and poses, N x 3, of a trajectory in TUM format."""
    return _fathom._read_tum(os.fspath(path))


def write_tum(path, times_ns, trajectory):
    """Writes a trajectory in TUM format."""
    _fathom._write_tum(os.fspath(path), times_ns, trajectory)
