"""Pages for browsers and notebooks."""

import os
import pathlib
import sys
import tempfile
import webbrowser
from html import escape

from . import _core
from ._core import Error, Path, Space


def template():
    """The viewer that ./dev viewer builds, which the package contains where it was there."""
    file = os.path.join(os.path.dirname(__file__), "viewer.html")
    if not os.path.exists(file):
        raise Error(
            "this package was built without the viewer page. In the source folder, run "
            "./dev viewer, which needs npm, and then build the package again"
        )
    with open(file, encoding="utf-8") as stream:
        return stream.read()


class Page:
    """A page that shows shapes in a browser, without a server or a network; notebooks show it.

    Parameters
    ----------
    *things : Path or Space
        One path, two paths to compare, or a space.
    names : sequence of str, optional
        What the page calls each.
    height : int, optional
        In a notebook, in pixels.
    """

    def __init__(self, *things, names=(), height=480):
        for i, thing in enumerate(things):
            if not isinstance(thing, (Path, Space)):
                raise TypeError(f"things[{i}]: must be Path or Space, not {type(thing).__name__}")
        if names and len(names) != len(things):
            raise ValueError(f"names: must be {len(things)}, not {len(names)}")
        kinds = [type(thing).__name__.lower() for thing in things]
        self._html = _core.make_page(list(things), list(names) or kinds)
        self._height = height

    def write(self, file):
        """Write an .html file; it appears whole or not at all."""
        _core.write_text(file, self._html)

    def _repr_html_(self):
        return (
            f'<iframe srcdoc="{escape(self._html)}" style="width: 100%; '
            f'height: {self._height}px; border: 0" allow="fullscreen"></iframe>'
        )

    def __repr__(self):
        return f"<shapespace.Page: {len(self._html) / 1e6:.1f} MB>"


def _in_notebook():
    """Whether results of cells are shown as pages."""
    ipython = sys.modules.get("IPython")
    shell = ipython.get_ipython() if ipython else None
    return shell is not None and hasattr(shell, "kernel")


def show(self, *, height=480):
    """The `Page` that shows it. A notebook shows it if it is the last line of a cell; elsewhere it
    opens in the browser, of a file in the folder of temporary files."""
    page = Page(self, height=height)
    if not _in_notebook():
        folder = tempfile.mkdtemp(prefix="shapespace-")
        file = os.path.join(folder, f"{type(self).__name__.lower()}.html")
        page.write(file)
        webbrowser.open(pathlib.Path(file).as_uri())
    return page


def write(self, file):
    """Write a .space file, or an .html page that shows the space in a browser."""
    if os.path.splitext(os.fspath(file))[1] == ".html":
        Page(self, names=[os.path.splitext(os.path.basename(os.fspath(file)))[0]]).write(file)
    else:
        self._write(file)


Path.show = show
Space.show = show
Space.write = write
