"""Data frames of pandas, with an index and, in `attrs["units"]`, the unit of every column."""

from . import _fathom
from ._names import known, number_or_text

COVARIANCE = {
    "cov_xx": (0, 0),
    "cov_xy": (0, 1),
    "cov_xt": (0, 2),
    "cov_yy": (1, 1),
    "cov_yt": (1, 2),
    "cov_tt": (2, 2),
}
COVARIANCE_UNITS = dict.fromkeys(("xx", "xy", "yy"), "m^2") | {"tt": "rad^2"}
COVARIANCE_UNITS |= dict.fromkeys(("xt", "yt"), "m rad")
OF_KEYFRAMES = (
    *("time_s", "x_m", "y_m", "theta_rad"), *COVARIANCE,
    *("position_error_m", "heading_error_rad", "pose_nees", "position_nees")
)
OF_LOOPS = ("from_", "to", "fate", "nis")
UNITS = ("m", "rad", "s", "ms", "bytes")  # that end a name


def unit_of(name) -> str:
    """The unit of a metric, series or column; empty where it has none."""
    metric = _fathom._metric(name)
    if metric is not None:
        return metric["unit"]
    *first, last = name.split("_")
    if "cov" in first:
        return COVARIANCE_UNITS.get(last, "")
    return last if first and last in UNITS else ""


def _framed(columns, index):
    try:
        import pandas
    except ImportError:
        raise ImportError("to_frame needs pandas: install python3-pandas") from None
    frame = pandas.DataFrame(columns)
    if isinstance(index, str):
        frame.index.name = index
    else:
        frame = frame.set_index(index)
    units = {column: unit_of(column) for column in frame.columns}
    frame.attrs["units"] = {column: unit for column, unit in units.items() if unit}
    return frame


def _motions(measurements):
    columns = {"from_": [z.from_ for z in measurements], "to": [z.to for z in measurements]}
    for i, name in enumerate(("x_m", "y_m", "theta_rad")):
        columns[name] = [z.motion[i] for z in measurements]
    covariances = [z.covariance for z in measurements]
    for name, place in COVARIANCE.items():
        columns[name] = [covariance[place] for covariance in covariances]
    return columns


def of_log(log, what="steps"):
    """'steps': dead reckoning, by the keyframe that a step leads to; 'registrations': all of them,
    in order of arrival. A data frame of pandas, its units in `attrs["units"]`."""
    known("frame of a log", what, ("steps", "registrations"))
    measurements = getattr(log, what)
    columns = _motions(measurements)
    if what == "steps":
        columns["is_hole"] = [z.is_hole for z in measurements]
        columns["keyframe"] = columns.pop("to")
        return _framed(columns, ["keyframe"])
    columns["inliers"] = [z.inliers for z in measurements]
    return _framed(columns, "registration")


def of_solution(solution, what="keyframes"):
    """'keyframes': the series of docs/outputs.md that have a value a keyframe, poses aligned as
    their errors are, and the ground truth; 'loops': the decision on every registration. A data
    frame of pandas, its units in `attrs["units"]`."""
    known("frame of a solution", what, ("keyframes", "loops"))
    if what == "loops":
        loops = solution.loops
        return _framed({name: [one[name] for one in loops] for name in OF_LOOPS}, "registration")
    count = len(solution.trajectory)
    series = solution._series()
    columns = {}
    for name in OF_KEYFRAMES:
        values = series.get(name, [])
        # That of keyframe 0, which is given, does not count.
        first = [float("nan")] if name.endswith("_nees") else []
        if len(values) + len(first) == count:
            columns[name] = [*first, *values]
    if solution.ground_truth is not None:
        for i, name in enumerate(("truth_x_m", "truth_y_m", "truth_theta_rad")):
            columns[name] = solution.ground_truth[:, i]
    return _framed(columns, "keyframe")


def of_results(results, failed):
    index = list(dict.fromkeys(["cell", *results.axes, "survey", "trial", "estimator"]))
    said = [*index, "outcome", "fault"]
    rows = []
    for row, has_failed in zip(results.rows, results._failed):
        names = said if has_failed and not failed else row
        rows.append({key: _of_axis(results, key, row[key]) for key in names})
    return _framed(rows, index)


def _of_axis(results, key, value):
    return number_or_text(value) if key in results.axes else value
