"""Estimators that break their contract, each in one way."""

import os
import signal
import sys

import fathom
import numpy as np


class Follows(fathom.Estimator):
    """dead reckoning, without covariances"""

    def __init__(self, setup):
        self.x = [np.array(setup.start)]

    def pose(self, k):
        return self.x[k]

    def add_keyframe(self, step):
        x, u = self.x[-1], step.forward().motion
        c, s = np.cos(x[2]), np.sin(x[2])
        turned = [c * u[0] - s * u[1], s * u[0] + c * u[1], u[2]]
        theta = x[2] + turned[2]
        self.x.append(
            np.array([x[0] + turned[0], x[1] + turned[1], np.arctan2(np.sin(theta), np.cos(theta))])
        )

    def update(self, measurements):
        return None


class Raises(Follows):
    def update(self, measurements):
        raise KeyError("no such loop")


class WrongShape(Follows):
    def joint_covariance(self, keyframes):
        return np.eye(3 * len(keyframes) + 1)


class UpperTriangle(Follows):
    def joint_covariance(self, keyframes):
        return np.triu(np.ones((3 * len(keyframes), 3 * len(keyframes))))


class NegativeVariances(Follows):
    def joint_covariance(self, keyframes):
        return -np.eye(3 * len(keyframes))


class NegativeNis(Follows):
    def update(self, measurements):
        return fathom.UpdateReport(loops=[("used", -2.75)] * len(measurements.registrations))


class NegativeWeights(Follows):
    def loop_weights(self):
        return [-7.0] * 3


class NotANumber(Follows):
    def pose(self, k):
        return (np.nan, 0, 0) if k == 2 else self.x[k]


class TooFewPoses(Follows):
    def pose(self, k):
        return self.x[k][:2]


class WordForPose(Follows):
    def pose(self, k):
        return "origin"


class WrongOutcome(Follows):
    def update(self, measurements):
        return fathom.UpdateReport(outcome="convergd")


class TooManyDecisions(Follows):
    def update(self, measurements):
        return fathom.UpdateReport(loops=["used"] * 7)


class LosesWhatIsDone(Follows):
    def update(self, measurements):
        return fathom.UpdateReport(loops=["lost"] * len(measurements.registrations))


class UsesWhatFailed(Follows):
    def update(self, measurements):
        used = ["used"] * len(measurements.registrations)
        return fathom.UpdateReport("numerical_failure", loops=used)


class CountsBackwards(Follows):
    def update(self, measurements):
        return fathom.UpdateReport(iterations=-1)


class ReportsNothingKnown(Follows):
    def update(self, measurements):
        return 3


class RaisesInInit(Follows):
    def __init__(self, setup):
        raise ValueError("cannot begin")


class Exits(Follows):
    def update(self, measurements):
        sys.exit(3)


class Dies(Follows):
    def update(self, measurements):
        print("about to die", file=sys.stderr, flush=True)
        os.kill(os.getpid(), signal.SIGSEGV)


class Hangs(Follows):
    def update(self, measurements):
        while True:
            pass


class EatsMemory(Follows):
    def update(self, measurements):
        self.eaten = [np.ones(1 << 20) for _ in range(100000)]


class Prints(Follows):
    def update(self, measurements):
        print("words on standard output")


class Forks(Follows):
    def update(self, measurements):
        if os.fork() == 0:
            signal.pause()


class ForksAndExits(Follows):
    def update(self, measurements):
        child = os.fork()
        if child == 0:
            sys.exit(0)
        os.waitpid(child, 0)


class DiesInDestructor(Follows):
    def __del__(self):
        os.abort()
