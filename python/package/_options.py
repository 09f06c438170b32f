"""Signatures and documentation of functions that take options, from the tables of the library."""

import inspect
import textwrap
import typing

from . import _core

_TYPES = {
    "int": int,
    "float": float,
    "bool": bool,
    "str": str,
}


def _say(row):
    """One option in numpydoc's form."""
    name, kind, default, meaning = row
    if kind == "dict":
        shown = "its own"
    elif isinstance(default, dict):
        shown = ", ".join(
            f"{key} {value!r}" for key, value in default.items() if value is not None
        )
    else:
        shown = repr(default)
    text = f"{name} : {kind}, optional\n"
    if default is None:
        return text + textwrap.indent(textwrap.fill(meaning, 92), "    ")
    return text + textwrap.indent(textwrap.fill(f"{meaning} Default: {shown}.", 92), "    ")


def describe(table, without=()):
    """The options of a table in numpydoc's form, but for some names."""
    return "\n".join(_say(row) for row in _core.options(table) if row[0] not in without)


def takes(table):
    """Gives a function that hands `**options` on the signature and documentation of a table.

    `{options}` in its docstring is where the documentation goes.
    """

    def give(function):
        signature = inspect.signature(function)
        parameters = [
            parameter
            for parameter in signature.parameters.values()
            if parameter.kind is not inspect.Parameter.VAR_KEYWORD
        ]
        own = set(signature.parameters)  # which the docstring describes itself
        for name, _kind, default, _meaning in _core.options(table):
            if name in own:
                continue
            parameters.append(
                inspect.Parameter(
                    name,
                    inspect.Parameter.KEYWORD_ONLY,
                    default=None if isinstance(default, dict) else default,
                )
            )
        function.__signature__ = signature.replace(parameters=parameters)
        function.__doc__ = inspect.cleandoc(function.__doc__).replace(
            "{options}", describe(table, own)
        )
        return function

    return give


def _dict_of(name, table, about, first=None):
    """A class for a dict with the options of a table, to call or to annotate with."""
    keys = dict(first or {})
    for key, kind, _default, _meaning in _core.options(table):
        keys[key] = _TYPES.get(kind, str if kind.startswith("{") else object)
    made = typing.TypedDict(name, keys, total=False)
    made.__doc__ = f"{about}\n\nParameters\n----------\n{describe(table)}\n"
    made.__module__ = "shapespace"
    return made


MetricOptions = _dict_of(
    "MetricOptions",
    "MetricOptions",
    "Which motions cost how much: a dict, of which what is left out has its default.\n\n"
    "`preset`, the name of a preset ('strain', 'isometric', 'rigid' or 'paper'), sets the\n"
    "defaults of all others, as --metric of the tools does.",
    {"preset": str},
)
GeodesicOptions = _dict_of(
    "GeodesicOptions",
    "GeodesicOptions",
    "How to find geodesics, where another function takes them as `geodesic`: a dict.",
)
LadderOptions = _dict_of(
    "LadderOptions", "LadderOptions", "The paper's ladder, as the `ladder` of `transfer`: a dict."
)
EmbeddingOptions = _dict_of(
    "EmbeddingOptions",
    "EmbeddingOptions",
    "How to place poses on the plane, as the `embedding` of `explore`: a dict.",
)
GltfOptions = _dict_of(
    "GltfOptions", "GltfOptions", "How `Path.write` makes a .glb file: a dict."
)
