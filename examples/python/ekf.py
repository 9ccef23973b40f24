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
    """delayed-state EKF in sixty lines of Python"""

    options = {"gate": fathom.Option(None, "largest normalised innovation squared", at_least=0)}

    def __init__(self, setup, gate):
        self.gate = np.inf if gate is None else gate
        self.x, self.room = [np.array(setup.start)], np.zeros((300, 300))

    P = property(lambda self: self.room[: 3 * len(self.x), : 3 * len(self.x)])

    def pose(self, k):
        return self.x[k]

    def add_keyframe(self, step):
        u, n, R = step.forward(), 3 * len(self.x), rotation(self.x[-1][2])
        F, pose = lever(R @ u.motion), self.x[-1] + R @ u.motion
        if n == len(self.room):
            self.room = np.pad(self.room, (0, n))
        self.x.append(np.append(pose[:2], wrap(pose[2])))
        self.P[n:, :n] = F @ self.P[n - 3 : n, :n]
        self.P[:n, n:] = self.P[n:, :n].T
        self.P[n:, n:] = F @ self.P[n - 3 : n, n - 3 : n] @ F.T + R @ u.covariance @ R.T

    def update(self, measurements):
        fates, H, nu, W = [], [], [], []
        for z in (z.forward() for z in measurements.registrations):
            a, b, back = 3 * z.from_, 3 * z.to, rotation(-self.x[z.from_][2])
            d = self.x[z.to] - self.x[z.from_]
            row = np.zeros((3, len(self.P)))
            row[:, a : a + 3], row[:, b : b + 3] = -back @ lever(d), back
            e = z.motion - back @ d
            e[2] = wrap(e[2])
            nis = e @ np.linalg.solve(row @ (self.P @ row.T) + z.covariance, e)
            fates.append(("used" if nis <= self.gate else "rejected", nis))
            if nis <= self.gate:
                H.append(row), nu.append(e), W.append(z.covariance)
        if H:
            self.correct(np.vstack(H), np.concatenate(nu), W)
        return fathom.UpdateReport(iterations=len(H) > 0, loops=fates)

    def correct(self, H, nu, W):
        PHt = self.P @ H.T
        S = H @ PHt
        for j, covariance in enumerate(W):
            S[3 * j : 3 * j + 3, 3 * j : 3 * j + 3] += covariance
        L = np.linalg.cholesky(S)
        V = np.linalg.solve(L, PHt.T)  # P - V'V is symmetric to the last bit
        self.P[:] -= V.T @ V
        dx = V.T @ np.linalg.solve(L, nu)
        for k, x in enumerate(self.x):
            x += dx[3 * k : 3 * k + 3]
            x[2] = wrap(x[2])

    def joint_covariance(self, keyframes):
        rows = np.concatenate([np.arange(3 * k, 3 * k + 3) for k in keyframes])
        return self.P[np.ix_(rows, rows)]
