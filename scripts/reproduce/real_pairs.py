"""Errors of registrations of recorded pictures, and the settings of their covariance that fit them.

The covariance is linear in the squares of tilt and floor of heading (docs/registration.md):
C = C₀ + tilt² T + floor² e₃e₃ᵀ, in the axes of the later keyframe. So two runs give C₀ and T of
every pair, and any settings can be judged without registering again.
"""

import math
import random
from dataclasses import dataclass

CHI2_3_AT_95 = 7.815


@dataclass(frozen=True)
class Pair:
    """The registration of the keyframes `first` and `second`."""

    first: int
    second: int
    error: tuple  # x, y in metres, heading in radians, against the reference
    base: tuple  # C₀: xx, xy, xt, yy, yt, tt
    tilt: tuple  # T, of a tilt of 1 rad

    def covariance(self, settings):
        """C of (tilt, floor of heading), in radians."""
        tilt, floor = settings
        c = [b + tilt**2 * t for b, t in zip(self.base, self.tilt)]
        c[5] += floor**2
        return tuple(c)

    def nis(self, settings):
        """eᵀ C⁻¹ e: 3 is expected."""
        return _quadratic(inverse(self.covariance(settings)), self.error)

    def nis_of_translation(self, settings):
        """That of (x, y) alone: 2 is expected. It does not depend on the floor of heading."""
        a, b, _, d, _, _ = self.covariance(settings)
        x, y, _ = self.error
        return (d * x * x - 2 * b * x * y + a * y * y) / (a * d - b * b)

    def nis_of_heading(self, settings):
        """Likewise of the heading: 1."""
        return self.error[2] ** 2 / self.covariance(settings)[5]


def inverse(m):
    """Of a symmetric 3×3 matrix (xx, xy, xt, yy, yt, tt)."""
    a, b, c, d, e, f = m
    minors = (d * f - e * e, c * e - b * f, b * e - c * d, a * f - c * c, b * c - a * e,
              a * d - b * b)
    determinant = a * minors[0] + b * minors[1] + c * minors[2]
    return tuple(minor / determinant for minor in minors)


def _quadratic(m, v):
    a, b, c, d, e, f = m
    x, y, t = v
    return a * x * x + d * y * y + f * t * t + 2 * (b * x * y + c * x * t + e * y * t)


def _between(a, b):
    """The pose b in the frame of a."""
    dx, dy, turn = b[0] - a[0], b[1] - a[1], b[2] - a[2]
    c, s = math.cos(a[2]), math.sin(a[2])
    return c * dx + s * dy, c * dy - s * dx, math.atan2(math.sin(turn), math.cos(turn))


def _reference(folder):
    poses = []
    for line in (folder / "ground_truth.tum").read_text("utf-8").splitlines():
        if not line.startswith("#"):
            _, x, y, _, _, _, qz, qw = map(float, line.split())
            poses.append((x, y, 2 * math.atan2(qz, qw)))
    return poses


def _registrations(folder):
    """(first, second): motion and covariance. The first edge to a keyframe is its step."""
    found, reached = {}, set()
    for line in (folder / "measurements.g2o").read_text("utf-8").splitlines():
        if line.startswith("EDGE_SE2 "):
            words = line.split()
            first, second = int(words[1]), int(words[2])
            if second in reached:
                values = tuple(map(float, words[3:]))
                found[first, second] = values[:3], inverse(values[3:])
            reached.add(second)
    return found


def pairs_of(plain, tilted, tilt_rad):
    """Pairs of two run folders of the same pictures: without tilt and floor, and with this tilt."""
    poses, with_tilt = _reference(plain), _registrations(tilted)
    pairs = []
    for (first, second), (motion, base) in _registrations(plain).items():
        same_motion, covariance = with_tilt[first, second]
        if same_motion != motion:
            raise ValueError(f"{tilted}: the pair {first}, {second} has another motion")
        tilt = tuple((c - b) / tilt_rad**2 for c, b in zip(covariance, base))
        error = _between(motion, _between(poses[first], poses[second]))
        pairs.append(Pair(first, second, error, base, tilt))
    return pairs


def mean(values, weights=None):
    """Weighted."""
    values = list(values)
    weights = weights or [1] * len(values)
    return sum(v * w for v, w in zip(values, weights)) / sum(weights)


def _root(falls):
    """Where a falling function of [0, ∞) is 0, by bisection; 0 if it is negative from there on."""
    low, high = 0.0, 1e-3
    if falls(low) <= 0:
        return low
    while falls(high) > 0:
        high *= 2
    for _ in range(60):
        middle = (low + high) / 2
        low, high = (middle, high) if falls(middle) > 0 else (low, middle)
    return high


def fitted(pairs):
    """Tilt and floor of heading for which the mean NIS of translation is 2, of heading 1."""
    tilt = _root(lambda t: mean(p.nis_of_translation((t, 0.0)) for p in pairs) - 2)
    floor = _root(lambda f: mean(p.nis_of_heading((tilt, f)) for p in pairs) - 1)
    return tilt, floor


def interval(pairs, value, draws=2000, seed=1):
    """95 % percentile bootstrap of the mean of `value` of a pair. Pictures are drawn, not pairs, as
    pairs that share one are not independent: a pair counts as often as both of its pictures do."""
    values = [value(p) for p in pairs]
    pictures = sorted({k for p in pairs for k in (p.first, p.second)})
    stream = random.Random(seed)
    means = []
    while len(means) < draws:
        times = dict.fromkeys(pictures, 0)
        for picture in stream.choices(pictures, k=len(pictures)):
            times[picture] += 1
        weights = [times[p.first] * times[p.second] for p in pairs]
        if any(weights):
            means.append(mean(values, weights))
    means.sort()
    return means[int(0.025 * draws)], means[int(0.975 * draws)]
