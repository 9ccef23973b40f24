"""How objects show themselves at a prompt and in a notebook."""

import base64
import html
import pathlib

import numpy

from . import _fathom
from ._fathom import (
    AbsolutePose,
    MeasurementLog,
    Measurements,
    PictureErrors,
    Registration,
    RelativePose,
    Setup,
    Solution,
)
from ._names import DEAD_RECKONING

MOST_DRAWN = 20000  # keyframes: the picture of more would be larger than a page
MOST_ROWS = 40  # of a table
MOST_METRICS = 6
OF_SOLUTION = (
    "chi2", "mean_position_error_m", "ate_rmse_m", "heading_rmse_rad", "anees", "total_ms"
)


def _of(count, noun) -> str:
    return f"{count} {noun}" if count == 1 else f"{count} {noun}s"


def _pose(values) -> str:
    x, y, theta = values
    return f"x {x:.4g} m, y {y:.4g} m, theta {theta:.4g} rad"


def _numbers(values) -> list:
    return [f"{value:.4g}" for value in values]


def _text(thing) -> str:
    if isinstance(thing, MeasurementLog):
        return f"of {_of(len(thing), 'keyframe')}, {_of(thing.registration_count, 'registration')}"
    if isinstance(thing, Solution):
        count = _of(len(thing.trajectory), "keyframe")
        return f"of {thing.estimator}: {thing.outcome}, {count}, F {thing.chi2:.4g}"
    if isinstance(thing, RelativePose):
        return f"{thing.from_} -> {thing.to}: {_pose(thing.motion)}"
    if isinstance(thing, AbsolutePose):
        return f"of keyframe {thing.keyframe}: {_pose(thing.pose)}"
    if isinstance(thing, Measurements):
        return f"of {_of(len(thing.registrations), 'registration')}, {len(thing.absolute)} absolute"
    if isinstance(thing, Registration):
        if not thing.found:
            return f"not found: {thing.reason}"
        return f"of {_of(thing.inliers, 'inlier')}: {_pose(thing.motion)}"
    if isinstance(thing, Setup):
        return f"{thing.mode}, start {_pose(thing.start)}"
    if isinstance(thing, PictureErrors):
        return f"sigma {', '.join(_numbers(thing.sigma))}"
    return f"own {', '.join(_numbers(numpy.sqrt(thing.own.diagonal())))} (1 sigma)"


def text_of(thing) -> str:
    return f"<fathom.{type(thing).__name__} {_text(thing)}>"


def _table(rows, head=()) -> str:
    """Rows of texts, which are escaped."""

    def line(cells, tag):
        texts = [html.escape(str(one)) for one in cells]
        return "<tr>" + "".join(f"<{tag}>{text}</{tag}>" for text in texts) + "</tr>"

    shown = [line(row, "td") for row in rows[:MOST_ROWS]]
    if len(rows) > MOST_ROWS:
        shown.append(line([f"… {len(rows) - MOST_ROWS} more"], "td"))
    return f"<table>{line(head, 'th') if head else ''}{''.join(shown)}</table>"


def _picture(svg, name) -> str:
    """As a picture of its own: scripts in it would not run, and ids are no other picture's."""
    data = base64.b64encode(svg.encode()).decode()
    return f'<img alt="{html.escape(name)}" src="data:image/svg+xml;base64,{data}">'


def _drawn(thing, count, name) -> str:
    if count > MOST_DRAWN:
        return f"<p>No picture of more than {MOST_DRAWN} keyframes.</p>"
    return _picture(thing._svg(name), name)


def _motions(measurements) -> str:
    rows = [(z.from_, z.to, *_numbers(z.motion)) for z in measurements]
    return _table(rows, ("from", "to", "x (m)", "y (m)", "theta (rad)"))


def html_of_relative(measurement) -> str:
    return _motions([measurement])


def html_of_measurements(measurements) -> str:
    absolute = [(z.keyframe, *_numbers(z.pose)) for z in measurements.absolute]
    of_world = _table(absolute, ("keyframe", "x (m)", "y (m)", "theta (rad)")) if absolute else ""
    return _motions(measurements.registrations) + of_world


def html_of_log(log) -> str:
    rows = [
        ("keyframes", len(log)),
        ("registrations", log.registration_count),
        ("way (m)", f"{sum(numpy.hypot(*z.motion[:2]) for z in log.steps):.4g}"),
    ]
    return _table(rows) + _drawn(log, len(log), "measurement log")


def html_of_solution(solution) -> str:
    rows = [("estimator", solution.estimator), ("outcome", solution.outcome)]
    rows += [("fault", solution.fault)] if solution.fault else []
    rows += [("remark", remark) for remark in solution.remarks]
    rows += [("keyframes", len(solution.trajectory)), ("loops", len(solution.loops))]
    metrics = solution.metrics
    rows += [(_label(name), f"{metrics[name]:.4g}") for name in OF_SOLUTION if name in metrics]
    return _table(rows) + _drawn(solution, len(solution.log), solution.estimator)


def html_of_registration(registration) -> str:
    rows = [("found", registration.found)]
    rows += [] if registration.found else [("reason", registration.reason)]
    rows += [("motion", _pose(registration.motion))] if registration.found else []
    return _table([*rows, ("inliers", f"{registration.inliers} of {registration.putative}")])


def text_of_results(results) -> str:
    return f"<fathom.Results of {_of(len(results.rows), 'run')}, {', '.join(results.estimators)}>"


def html_of_results(results) -> str:
    there = dict.fromkeys(key for row in results.rows for key in row)
    metrics = [one for one in results._tabled if one in there][:MOST_METRICS]
    rows = []
    for number, cell in enumerate(results.cells):
        label = ", ".join(f"{axis} {value}" for axis, value in cell.items()) or "all"
        for estimator in (DEAD_RECKONING, *results.estimators):
            runs, done, means = results._means_of(estimator, number)
            texts = [f"{means[one]:.4g}" if one in means else "-" for one in metrics]
            rows.append((label, estimator, f"{done}/{runs}", *texts))
    table = _table(rows, ("cell", "estimator", "done", *map(_label, metrics)))
    # Of the first cell: the example.
    figures = sorted(pathlib.Path(results.folder, "figures").glob("trajectories*.svg"))[:1]
    pictures = [_picture(figure.read_text(encoding="utf-8"), figure.stem) for figure in figures]
    words = filter(None, (results.title, "means over the runs that were done"))
    title = html.escape(": ".join(words))
    return f"<p>{title}</p>{table}{''.join(pictures)}"


def _label(metric) -> str:
    of = _fathom._metric(metric) or {"label": metric, "unit": ""}
    return f"{of['label']} ({of['unit']})" if of["unit"] else of["label"]
