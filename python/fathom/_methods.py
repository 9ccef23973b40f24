"""What classes of the extension have in Python; _fathom.pyi has it, too."""

from . import _display, _fathom, _frames, _plot


def _missing(thing, name):
    """Of an attribute that is not there."""
    near = "" if name.startswith("_") else _fathom._suggestion(name, dir(thing))
    raise AttributeError(f"'{type(thing).__name__}' has no attribute '{name}'{near}")


for _of in (
    _fathom.AbsolutePose,
    _fathom.MeasurementLog,
    _fathom.Measurements,
    _fathom.PictureErrors,
    _fathom.Registration,
    _fathom.RelativePose,
    _fathom.Setup,
    _fathom.SharedErrors,
    _fathom.Solution,
):
    _of.__repr__ = _display.text_of
    _of.__getattr__ = _missing

_fathom.MeasurementLog._repr_html_ = _display.html_of_log
_fathom.Measurements._repr_html_ = _display.html_of_measurements
_fathom.Registration._repr_html_ = _display.html_of_registration
_fathom.RelativePose._repr_html_ = _display.html_of_relative
_fathom.Solution._repr_html_ = _display.html_of_solution

_fathom.MeasurementLog.to_frame = _frames.of_log
_fathom.Solution.to_frame = _frames.of_solution

_fathom.MeasurementLog.plot = _plot.of_log
_fathom.Solution.plot = _plot.of_solution
