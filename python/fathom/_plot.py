"""Pictures by matplotlib: maps, errors, NEES, the regimes of a sweep."""

import numpy

from . import _fathom
from ._fathom import InputError
from ._names import DEAD_RECKONING, known, unknown

OF_SOLUTION = ("trajectory", "error", "nees")
OF_RESULTS = (*OF_SOLUTION, "regimes")
AGAINST_TIME = {
    "error": ("position_error_m", "position error (m)", 1.0),
    "nees": ("pose_nees", "pose NEES / 3, 1 is expected", 3.0),
}
USED = 0  # of `loop_fate` (docs/outputs.md)
TRUTH = {"color": "0.6", "linewidth": 3.0, "label": "ground truth"}
ODOMETRY = {"color": "0.3", "linestyle": ":", "linewidth": 1.0, "label": "dead reckoning"}


def of_log(log, ax=None):
    """Draws dead reckoning and the registrations by matplotlib, with x up and y to the left, into
    `ax`, or into a new figure. Returns the axes."""
    ax = _map_axes(ax)
    poses = log.dead_reckoning
    _draw_loops(ax, poses, [(z.from_, z.to) for z in log.registrations])
    _draw_way(ax, poses, ODOMETRY)
    return _with_legend(ax)


def of_solution(solution, what="trajectory", ax=None):
    """Draws by matplotlib, into `ax` or into a new figure: 'trajectory', with truth, dead reckoning
    and the loops used; 'error', of positions against time; 'nees', of poses against time, with the
    95 % interval of one draw. Returns the axes."""
    known("plot of a solution", what, OF_SOLUTION)
    series = solution._series()
    if what != "trajectory":
        return _draw_against_time(_axes(ax), what, {solution.estimator: series})
    ax = _map_axes(ax)
    poses = _poses_of(series)
    _draw_loops(ax, poses, _used(series))
    if solution.ground_truth is not None:
        _draw_way(ax, solution.ground_truth, TRUTH)
    odometry = solution.log.dead_reckoning
    if len(poses) and numpy.isfinite(poses[0]).all():
        # As the estimate is moved to the truth.
        odometry = _moved(odometry, solution.trajectory[0], poses[0])
    _draw_way(ax, odometry, ODOMETRY)
    _draw_way(ax, poses, {"label": solution.estimator, "linewidth": 1.2})
    return _with_legend(ax)


def of_results(results, what, ax, cell, survey, trial, metric, estimator):
    known("plot of results", what, OF_RESULTS)
    if what == "regimes":
        return _draw_regimes(ax, results, metric, estimator)
    cell = results.cell(cell)
    if what == "nees":
        return _draw_mean_nees(_axes(ax), results, cell)
    series = {
        one: results._series_of(one, cell, survey, trial)
        for one in (DEAD_RECKONING, *results.estimators)
    }
    if what == "error":
        return _draw_against_time(_axes(ax), what, series)
    ax = _map_axes(ax)
    odometry = series.pop(DEAD_RECKONING)
    if "truth_x_m" in odometry:
        _draw_way(ax, _poses_of(odometry, "truth_"), TRUTH)
    _draw_way(ax, _poses_of(odometry), ODOMETRY)
    for place, (one, drawn) in enumerate(series.items()):
        if place == 0:
            _draw_loops(ax, _poses_of(drawn), _used(drawn))
        _draw_way(ax, _poses_of(drawn), {"label": one, "linewidth": 1.2})
    return _with_legend(ax)


def _axes(ax):
    if ax is not None:
        return ax
    try:
        # Without a display it draws into memory.
        import matplotlib.pyplot
    except ImportError:
        raise ImportError("plot needs matplotlib: install python3-matplotlib") from None
    return matplotlib.pyplot.subplots(layout="constrained")[1]


def _map_axes(ax):
    ax = _axes(ax)
    ax.set_xlabel("y (m)")
    ax.set_ylabel("x (m)")
    ax.set_aspect("equal", adjustable="datalim")
    if not ax.xaxis_inverted():
        ax.invert_xaxis()  # y is to the left
    return ax


def _with_legend(ax):
    ax.grid(True, linewidth=0.3)
    ax.legend(fontsize="small")
    return ax


def _poses_of(series, of=""):
    return numpy.column_stack([series.get(of + name, []) for name in ("x_m", "y_m", "theta_rad")])


def _moved(poses, from_, to):
    """The poses after the motion of the plane that takes one pose to another."""
    cosine, sine = numpy.cos(to[2] - from_[2]), numpy.sin(to[2] - from_[2])
    rotation = numpy.array([[cosine, -sine], [sine, cosine]])
    return (poses[:, :2] - from_[:2]) @ rotation.T + to[:2]


def _draw_way(ax, poses, style):
    ax.plot(poses[:, 1], poses[:, 0], **style)


def _used(series):
    """Ends of the loops that an estimator used."""
    if "loop_from" not in series:
        return []
    ends = numpy.column_stack([series["loop_from"], series["loop_to"]]).astype(int)
    return ends[series["loop_fate"] == USED]


def _draw_loops(ax, poses, loops):
    gap = numpy.full(2, numpy.nan)  # ends a line
    # Of a run that failed there may be poses of the first keyframes alone.
    there = [ends for ends in loops if max(ends) < len(poses)]
    points = [point for from_, to in there for point in (poses[from_, :2], poses[to, :2], gap)]
    if points:
        _draw_way(ax, numpy.array(points), {"color": "0.8", "linewidth": 0.5, "label": "loops"})


def _draw_against_time(ax, what, series):
    """Of estimators by name, whose series are given."""
    name, label, over = AGAINST_TIME[what]
    if not any(name in one for one in series.values()):
        raise _lacks(what)
    for estimator, one in series.items():
        if name not in one:
            continue
        times = one["time_s"][-len(one[name]):]  # the NEES begins with keyframe 1
        ax.plot(times, one[name] / over, label=estimator)
    if what == "nees":
        _draw_interval(ax, times, [1] * len(times))
    ax.set_xlabel("time (s)")
    ax.set_ylabel(label)
    return _with_legend(ax)


def _lacks(what):
    needs = "ground truth" if what == "error" else "ground truth, covariances"
    return InputError(f"plot '{what}': needs {needs} and a run that was done")


def _draw_interval(ax, places, draws):
    """Of the mean of so many independent draws at each place."""
    low, high = zip(*map(_fathom.anees_interval, draws))
    most = max(draws)
    label = f"95 % interval of {most} {'draw' if most == 1 else 'draws'}"
    ax.fill_between(places, low, high, color="0.9", label=label)
    ax.set_yscale("log")


def _draw_mean_nees(ax, results, cell):
    """The mean over the trials of a cell that were done at every keyframe that all of them have."""
    draws = 0
    for estimator in results.estimators:
        runs = []
        for row in results._done_by_place.get((estimator, cell), []):
            series = results._series_of(estimator, cell, row["survey"], row["trial"])
            if "pose_nees" in series:
                runs.append((row["survey"], series["pose_nees"]))
        if not runs:
            continue
        count = min(len(nees) for _, nees in runs)
        values = numpy.ma.masked_invalid([nees[:count] for _, nees in runs])
        mean = values.mean(axis=0).filled(numpy.nan)
        ax.plot(numpy.arange(1, count + 1), mean / 3.0, label=estimator)
        surveys = {survey for survey, _ in runs}
        here = results._open().independent_draws(cell, len(surveys), len(runs))
        if here > draws:
            draws, keyframes = here, numpy.arange(1, count + 1)
    if draws == 0:
        raise _lacks("nees")
    _draw_interval(ax, keyframes, [draws] * len(keyframes))
    ax.set_xlabel("keyframe")
    ax.set_ylabel("mean " + AGAINST_TIME["nees"][1])
    return _with_legend(ax)


def _draw_regimes(ax, results, metric, estimator):
    """A mean over that of the best estimator of the cell, over the first two axes that have several
    values; of further ones at their first."""
    swept = [axis for axis, values in results.axes.items() if len(values) > 1]
    if len(swept) < 2:
        raise InputError("plot 'regimes': needs a sweep over two axes of several values")
    known("estimator", estimator, results.estimators)
    label = _lower_is_better(metric)
    if reason := results._open().not_ranked(metric):
        raise InputError(f"plot 'regimes': {metric} does not rank: {reason}")
    across, up = (results.axes[axis] for axis in swept[:2])
    squares = numpy.full((len(up), len(across)), numpy.nan)
    over_best = results._open().means_over_best(metric)
    for number, cell in enumerate(results.cells):
        if any(cell[axis] != results.axes[axis][0] for axis in swept[2:]):
            continue
        place = up.index(cell[swept[1]]), across.index(cell[swept[0]])
        squares[place] = over_best.get(number, {}).get(estimator, numpy.nan)
    ax = _axes(ax)
    image = ax.imshow(squares, origin="lower", cmap="Blues", vmin=1.0, vmax=10.0)
    for (row, column), value in numpy.ndenumerate(squares):
        text = "-" if numpy.isnan(value) else f"{value:.3g}"
        ax.text(column, row, text, ha="center", va="center", color="w" if value > 5 else "k")
    ax.set_xticks(range(len(across)), across)
    ax.set_yticks(range(len(up)), up)
    titles = results._open().axis_titles()
    ax.set_xlabel(titles[swept[0]])
    ax.set_ylabel(titles[swept[1]])
    ax.set_title(estimator)
    ax.figure.colorbar(image, ax=ax, label=f"{label} over the best estimator's")
    return ax


def _lower_is_better(metric):
    """The label of a metric that has a best estimator."""
    about = _fathom._metric(metric)
    if about is None:
        raise unknown("metric", metric, _fathom._metric_names())
    if not about["lower_is_better"]:
        raise InputError(f"plot 'regimes': of {metric} the least is not the best")
    return about["label"]
