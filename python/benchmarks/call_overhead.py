"""What a call of an estimator in Python costs beside what it does: microseconds a call.

Usage: PYTHONPATH=BUILD/python python3 python/benchmarks/call_overhead.py

An estimator that does next to nothing, over a log of 20000 keyframes with a loop each; the harness
measures every call as it does in a study. Medians; quote them with the processor.
"""

import fathom
import numpy


class Nothing(fathom.Estimator):
    """does nothing"""

    def __init__(self, setup):
        self.x = [setup.start]

    def pose(self, k):
        return self.x[k]

    def add_keyframe(self, step):
        self.x.append(self.x[0])

    def update(self, measurements):
        return None


class Looks(Nothing):
    """takes every array that it is given, and reports"""

    def add_keyframe(self, step):
        self.x.append(step.motion)
        self.P = step.covariance

    def update(self, measurements):
        for z in measurements.registrations:
            self.z = (z.from_, z.to, z.motion, z.covariance)
        return fathom.UpdateReport(loops=[("used", 1.0)] * len(measurements.registrations))


def log_of(keyframes):
    log = fathom.MeasurementLog()
    identity = numpy.eye(3)
    for k in range(1, keyframes):
        log.add_keyframe((1, 0, 0), identity)
        if k > 1:
            log.add_registration(fathom.RelativePose(k, k - 2, (-2, 0, 0), identity))
    return log


def main():
    log = log_of(20000)
    print("estimator  isolation  add_keyframe (us)  update (us)")
    for kind in (Nothing, Looks):
        for isolation in ("none", "process"):
            run = fathom.replay(log, kind, isolation=isolation)
            add, update = (1e3 * numpy.median(values) for values in (run.add_ms, run.update_ms))
            print(f"{run.estimator:9}  {isolation:9}  {add:17.2f}  {update:11.2f}")


if __name__ == "__main__":
    main()
