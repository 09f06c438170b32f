"""Runs a notebook in an empty folder and stores its outputs: python3 execute.py NOTEBOOK.ipynb"""

import os
import pathlib
import sys
import tempfile

import nbclient
import nbformat

import shapespace


def execute(file, folder):
    """The notebook with outputs of its own, of which none depends on where and when it was run.

    Parameters
    ----------
    file : str or path-like
        The notebook, which is left as it is.
    folder : str or path-like
        Where its cells run, and write their files.

    Returns
    -------
    nbformat.NotebookNode

    Raises
    ------
    nbclient.exceptions.CellExecutionError
        A cell raised something; the message has the cell and the traceback.
    """
    notebook = nbformat.read(file, as_version=4)
    package = pathlib.Path(shapespace.__file__).resolve().parents[1]
    client = nbclient.NotebookClient(
        notebook, timeout=600, kernel_name="python3", resources={"metadata": {"path": str(folder)}}
    )
    with tempfile.TemporaryDirectory() as settings:
        # The package that this program has, and no settings of the user's.
        paths = {"PYTHONPATH": str(package), "IPYTHONDIR": settings}
        client.execute(env={**os.environ, **paths})
    for cell in notebook.cells:
        cell.metadata.pop("execution", None)  # times
        for output in cell.get("outputs", []):
            if "image/png" in output.get("data", {}):
                output.data.pop("text/html", None)  # the same picture again
    return notebook


def main():
    file = pathlib.Path(sys.argv[1])
    with tempfile.TemporaryDirectory() as folder:
        notebook = execute(file, folder)
    notebook.metadata.language_info = {"name": "python"}  # without its version
    nbformat.write(notebook, file)


if __name__ == "__main__":
    main()
