"""The stub says what the module has: names, parameters, and what mypy makes of them."""

import ast
import inspect
import pathlib
import re
import subprocess
import sys

import pytest

import shapespace

FOLDER = pathlib.Path(shapespace.__file__).parent
STUB = ast.parse((FOLDER / "__init__.pyi").read_text())
CLASSES = {node.name: node for node in STUB.body if isinstance(node, ast.ClassDef)}
FUNCTIONS = {node.name: node for node in STUB.body if isinstance(node, ast.FunctionDef)}


def parameters_of(node):
    """Names, kinds and whether there is a default, as the stub has them, but for self."""
    arguments = node.args
    plain = arguments.posonlyargs + arguments.args
    defaults = [None] * (len(plain) - len(arguments.defaults)) + arguments.defaults
    rows = [(a.arg, "positional", d is not None) for a, d in zip(plain, defaults)]
    if arguments.vararg:
        rows.append((arguments.vararg.arg, "any", False))
    rows += [
        (a.arg, "keyword", d is not None)
        for a, d in zip(arguments.kwonlyargs, arguments.kw_defaults)
    ]
    if arguments.kwarg:
        rows.append((arguments.kwarg.arg, "keywords", False))
    return [row for row in rows if row[0] != "self"]


def parameters_in(signature):
    kinds = {
        inspect.Parameter.POSITIONAL_OR_KEYWORD: "positional",
        inspect.Parameter.VAR_POSITIONAL: "any",
        inspect.Parameter.KEYWORD_ONLY: "keyword",
        inspect.Parameter.VAR_KEYWORD: "keywords",
    }
    return [
        (p.name, kinds[p.kind], p.default is not p.empty)
        for p in signature.parameters.values()
        if p.name != "self"
    ]


def names_in(docstring):
    """The parameters that the first line of a compiled function's docstring has."""
    inside = re.match(r"\w+\((.*)\) -> ", docstring, re.S).group(1)
    names = re.findall(r"(?:^|, )\*{0,2}(\w+)(?:: |$|(?=,))", inside)
    return ["options" if name == "kwargs" else name for name in names if name != "self"]


def test_the_stub_has_every_public_name_and_no_other():
    public = {
        name for name in shapespace.__all__ if not inspect.ismodule(getattr(shapespace, name))
    } - {"__version__"}
    assert set(CLASSES) | set(FUNCTIONS) == public
    assigned = [target.id for node in STUB.body if isinstance(node, ast.Assign)
                for target in node.targets]  # fmt: skip
    assert assigned and all(name.startswith("_") for name in assigned)


@pytest.mark.parametrize("name", FUNCTIONS)
def test_functions_have_the_stub_s_parameters(name):
    signature = inspect.signature(getattr(shapespace, name))
    assert parameters_in(signature) == parameters_of(FUNCTIONS[name])


@pytest.mark.parametrize("name", CLASSES)
def test_classes_have_the_stub_s_members(name):
    thing = getattr(shapespace, name)
    members = [node for node in CLASSES[name].body if isinstance(node, ast.FunctionDef)]
    if not members and not hasattr(thing, "_fields"):
        for node in CLASSES[name].body:  # a TypedDict's keys
            if isinstance(node, ast.AnnAssign):
                assert node.target.id in thing.__annotations__
        return
    fields = {node.target.id for node in CLASSES[name].body if isinstance(node, ast.AnnAssign)}
    have = {n for n in vars(thing) if not n.startswith("_")} - {"index", "count"}
    if hasattr(thing, "_fields") and issubclass(thing, tuple):
        assert set(thing._fields) == fields
        return
    listed = {node.name for node in members if not node.name.startswith("_")} | fields
    assert listed == have
    for node in members:
        if any(isinstance(d, ast.Name) and d.id == "property" for d in node.decorator_list):
            assert not callable(inspect.getattr_static(thing, node.name))
            continue
        if node.name == "__iter__":
            continue  # by __len__ and __getitem__
        member = getattr(thing, node.name)
        said = [row[0] for row in parameters_of(node)]
        by_options = node.name == "__init__" and "__signature__" in vars(thing)
        if inspect.isfunction(member) and not by_options:
            assert parameters_in(inspect.signature(member)) == parameters_of(node)
        elif by_options:
            assert parameters_in(inspect.signature(thing)) == parameters_of(node)
        elif not node.name.startswith("__") or node.name == "__init__":
            assert names_in(member.__doc__) == said


def test_mypy_takes_the_stub_and_programs_that_are_right(tmp_path):
    mypy = pytest.importorskip("mypy.api")
    right = tmp_path / "right.py"
    right.write_text(
        "import numpy as np\n"
        "from numpy.typing import NDArray\n"
        "import shapespace as ss\n"
        "poses = ss.read('a.obj', 'b.obj')\n"
        "path, summary = ss.interpolate(poses, shapes=3, metric=ss.MetricOptions(bending=1e-4))\n"
        "middle: NDArray[np.float64] = path[8]\n"
        "energy: float = summary.energy\n"
        "ss.interpolate([np.zeros((4, 3)), [[0, 0, 0]] * 4], [[0, 1, 2]], solver='lbfgs')\n"
        "path.anchor(path[0][:, 1] < 0.1).write('walk.png')\n"
        "for shape in path:\n"
        "    print(shape.shape, path.at([0.5]).parameters)\n"
    )
    wrong = tmp_path / "wrong.py"
    wrong.write_text(
        "import shapespace as ss\n"
        "ss.interpolate(ss.read('a.obj'), shapes='3')\n"
        "ss.interpolate(ss.read('a.obj'), solver='newton')\n"
        "ss.interpolate(ss.read('a.obj'), shpes=3)\n"
        "ss.interpolate(ss.read('a.obj'), metric=ss.MetricOptions(bend=1))\n"
    )

    installed = "site-packages" in FOLDER.parts
    environment = {"PATH": ""} if installed else {"PATH": "", "MYPYPATH": str(FOLDER.parent)}

    def check(*files):
        result = subprocess.run(
            [sys.executable, "-m", "mypy", "--strict", "--cache-dir", tmp_path, *files],
            cwd=tmp_path,
            env=environment,
            stdout=subprocess.PIPE,
            text=True,
        )
        return result.stdout

    assert mypy  # importable, so that the interpreter has it
    assert "Success" in check(FOLDER / "__init__.pyi"), check(FOLDER / "__init__.pyi")
    assert "Success" in check(right), check(right)
    errors = check(wrong)
    for line in range(2, 6):
        assert f"wrong.py:{line}: error" in errors, errors
