"""A delayed-state EKF: the poses of all keyframes in the state, one linearisation an update."""

import fathom
import numpy as np


def wrap(angle):
    return np.pi - (np.pi - angle) % (2 * np.pi)


def rotation(theta):
    c, s = np.cos(theta), np.sin(theta)
    return np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])


def lever(d):
    """What a change of a pose moves at a distance d from it."""
    return np.array([[1, 0, -d[1]], [0, 1, d[0]], [0, 0, 1]])


class NumpyEkf(fathom.Estimator):
    """delayed-state EKF in sixty lines of Python; loops alone, from a start that is held"""

    options = {"gate": fathom.Option(None, "largest normalised innovation squared", at_least=0)}

    def __init__(self, setup, gate):
        if not setup.start_is_fixed:
            raise NotImplementedError("an uncertain start")
        self.gate = np.inf if gate is None else gate
        self.x, self.room = np.array([setup.start]), np.zeros((300, 300))

    P = property(lambda self: self.room[: self.x.size, : self.x.size])

    def pose(self, k):
        return self.x[k]

    def add_keyframe(self, step):
        u, n, R = step.forward(), self.x.size, rotation(self.x[-1, 2])
        F, pose = lever(R @ u.motion), self.x[-1] + R @ u.motion
        if n == len(self.room):
            self.room = np.pad(self.room, (0, n))
        self.x = np.vstack((self.x, [*pose[:2], wrap(pose[2])]))
        self.P[n:, :n] = F @ self.P[n - 3 : n, :n]
        self.P[:n, n:] = self.P[n:, :n].T
        self.P[n:, n:] = F @ self.P[n - 3 : n, n - 3 : n] @ F.T + R @ u.covariance @ R.T

    def update(self, measurements):
        if measurements.absolute:
            raise NotImplementedError("headings and fixes")
        fates, H, nu, W = [], np.zeros((0, self.x.size)), [], []
        for z in (z.forward() for z in measurements.registrations):
            a, b, back = 3 * z.from_, 3 * z.to, rotation(-self.x[z.from_, 2])
            d, row = self.x[z.to] - self.x[z.from_], np.zeros((3, self.x.size))
            row[:, a : a + 3], row[:, b : b + 3] = -back @ lever(d), back
            e = z.motion - back @ d
            e[2] = wrap(e[2])
            nis = e @ np.linalg.solve(row @ (self.P @ row.T) + z.covariance, e)
            fates.append(("used" if nis <= self.gate else "rejected", nis))
            if nis <= self.gate:
                H, nu, W = np.vstack((H, row)), [*nu, *e], [*W, z.covariance]
        if not np.isfinite([nis for _, nis in fates]).all():
            return fathom.UpdateReport("numerical_failure")
        PHt = self.P @ H.T
        S = H @ PHt
        for j, covariance in enumerate(W):
            S[3 * j : 3 * j + 3, 3 * j : 3 * j + 3] += covariance
        L = np.linalg.cholesky(S)
        V = np.linalg.solve(L, PHt.T)
        self.P[:] -= V.T @ V  # symmetric to the last bit
        self.x += (V.T @ np.linalg.solve(L, np.array(nu))).reshape(-1, 3)
        self.x[:, 2] = wrap(self.x[:, 2])
        return fathom.UpdateReport(iterations=1, loops=fates)

    def joint_covariance(self, keyframes):
        i = np.ix_(*2 * [[3 * k + j for k in keyframes for j in range(3)]])
        return (self.P[i] + self.P.T[i]) / 2
