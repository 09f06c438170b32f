"""Figures of the last solve's report, which the panel shows."""

import math

import bpy
from bpy.props import CollectionProperty, StringProperty


class SHAPESPACE_figure(bpy.types.PropertyGroup):
    """One figure: its property `name` says what it is."""

    value: StringProperty()


class SHAPESPACE_report(bpy.types.PropertyGroup):
    """The figures of a solve; without `title` there was none."""

    title: StringProperty()
    figures: CollectionProperty(type=SHAPESPACE_figure)


def show(context, title: str, report: dict) -> None:
    """`report` is that of a solve, as --report report.json of the tools has it."""
    shown = context.window_manager.shapespace_report
    shown.title = title
    shown.figures.clear()
    for name, value in figures(report):
        figure = shown.figures.add()
        figure.name, figure.value = name, value


def hide(context) -> None:
    context.window_manager.shapespace_report.title = ""


def figures(report: dict) -> list:
    """Names of figures, and the figures as text."""
    rows = [(name, _find(report, path), form) for name, path, form in _ROWS]
    found = [(name, form(value)) for name, value, form in rows if value is not None]
    if "quality" in report and report.get("ratio") is not None:
        found.append(("Energy / bound", f"{report['ratio']:.4g}"))
    for handle in report.get("handles", []):
        found.append((f"{handle['name']} off, rms", _number(handle["residual_rms"])))
    return found


def _find(report: dict, path: str):
    """The value at a path such as "quality.edge_rms", or None."""
    value = report
    for key in path.split("."):
        value = value.get(key) if isinstance(value, dict) else None
    return None if isinstance(value, float) and not math.isfinite(value) else value


def _word(value) -> str:
    return str(value).replace("_", " ")


def _percent(value) -> str:
    return f"{100 * value:.3g} %"


def _number(value) -> str:
    return f"{value:.3g}"


def _times(value) -> str:
    return f"{value:.3g} times"


def _seconds(value) -> str:
    return f"{value:.2f} s"


_ROWS = (
    ("Ended", "termination", _word),
    ("Next map's cost", "certainty", _times),
    ("Round trip, mean", "round_trip_mean", _percent),
    ("Turned over", "turned", _percent),
    ("Not covered", "uncovered", _percent),
    ("Beyond", "ending", _word),
    ("Energy", "energy", _number),
    ("Edges off, rms", "quality.edge_rms", _percent),
    ("Edges off, max", "quality.edge_max", _percent),
    ("Folds", "quality.folds", _number),
    ("Edges off, rms", "edge_rms", _percent),
    ("Strains off, rms", "strain_rms", _percent),
    ("Edges off, rms", "error.edge_rms", _percent),
    ("Edges off, max", "error.edge_max", _percent),
    ("Volume off", "error.volume", _percent),
    ("Turned over", "error.inverted_hinges", _number),
    ("Edges before, rms", "before.edge_rms", _percent),
    ("Edges after, rms", "after.edge_rms", _percent),
    ("Volume before", "before.volume", _percent),
    ("Volume after", "after.volume", _percent),
    ("Moved, rms", "moved", _number),
    ("Bones", "skin.bones", _number),
    ("Vertices off, rms", "skin.error", _percent),
    ("Vertices off, max", "skin.max_error", _percent),
    ("Time", "total_seconds", _seconds),
    ("Time", "deformation.total_seconds", _seconds),
)
