"""Features of one's own: what a metric measures, as functions on numpy's arrays."""

import operator

import numpy as np

from . import _core
from ._core import InvalidOptions

# Features with one element for each of these, which weighs what it covers of the surface.
_ELEMENTS = {
    "vertices": (1, lambda basis: (np.arange(len(basis.vertex_area))[:, None], basis.vertex_area)),
    "edges": (2, lambda basis: (basis.edges, basis.edge_area)),
    "triangles": (3, lambda basis: (basis.faces, basis.triangle_area)),
    "hinges": (4, lambda basis: (basis.hinges, basis.hinge_area)),
}


def define_feature(
    name,
    function,
    elements,
    *,
    vertices=None,
    values=1,
    constants=(),
    rigid_invariant=True,
    is_sum=False,
):
    """Define a feature: a quantity of which a metric measures the change.

    From now on it can be named in the option `features` of metrics, as in
    ``MetricOptions(features={"log area": 1.0})``, and files whose metric has it can be read. A
    definition of the same name is replaced; metrics that are frozen keep the one they have.

    Solvers call Python from all of their threads, one at a time: a solve takes some three times as
    long as with a feature in C++ on one core, and does not get faster with more
    (docs/guide/features.md).

    Parameters
    ----------
    name : str
        In options, files and messages.
    function : callable
        ``function(x, **constants)`` returns the values of k elements, k x d, and their derivatives
        by the vertices, k x d x v x 3. `x` has the positions of their vertices, k x v x 3, in the
        metric's unit of length, of shapes that are aligned with the first pose. Where d is 1, both
        may lack that dimension. It must depend on its arguments alone, and be finite and
        differentiable twice wherever a body can go.
    elements : {'vertices', 'edges', 'triangles', 'hinges'} or callable
        Of what there are values; the weights are shares of the area. Or ``elements(basis)``, which
        is called with a `MetricBasis` for every level of every solver, and returns the vertices of
        each element, m x v, and their weights, m (one for a sum), and, if there are any, a dict of
        the constants.
    vertices : int, optional
        v, of an element: up to 8. Where `elements` is a word, it says it.
    values : int, optional
        d, of an element: up to 8.
    constants : sequence of str, optional
        Names of numbers that `elements` returns, `function` takes and files hold.
    rigid_invariant : bool, optional
        Whether rigid motion of the whole body leaves the values alone. Solvers then take it out of
        paths.
    is_sum : bool, optional
        Whether the values of all elements are added up before they are squared, as for a volume.
        `values` is 1 then.

    Raises
    ------
    InvalidOptions
        A feature of the library has that name. Later, from solvers: the function returns something
        else than it should, or derivatives that are not those of its values. What the function
        raises itself, solvers raise too.
    """
    if not isinstance(name, str) or not name:
        raise TypeError(f"name: must be a str that is not empty, not {name!r}")
    if not callable(function):
        raise TypeError(f"function: must be callable, not {function!r}")
    values = _count(values, "values", _core._MAX_VALUES)
    if isinstance(constants, str) or not all(isinstance(one, str) for one in constants):
        raise TypeError(f"constants: must be names, each a str, not {constants!r}")
    if is_sum and values != 1:
        raise ValueError(f"values: a sum has one value, not {values}")
    if callable(elements):
        vertices = _count(vertices, "vertices", _core._MAX_VERTICES)
    elif isinstance(elements, str) and elements in _ELEMENTS:
        own, elements = _ELEMENTS[elements]
        if vertices not in (None, own):
            raise ValueError(f"vertices: these elements have {own}, not {vertices!r}")
        vertices = own
    else:
        words = ", ".join(repr(word) for word in _ELEMENTS)
        raise ValueError(f"elements: must be {words} or callable, not {elements!r}")
    definition = _Definition(
        f"feature {name}", function, elements, vertices, values, tuple(constants), bool(is_sum)
    )
    _core.define_feature(
        name,
        vertices,
        values,
        bool(rigid_invariant),
        bool(is_sum),
        list(definition.constants),
        definition.evaluate,
        definition.freeze,
    )


def _count(value, name, most):
    try:
        count = operator.index(value)
    except TypeError:
        raise TypeError(f"{name}: must be an int, not {value!r}") from None
    if not 1 <= count <= most:
        raise ValueError(f"{name}: must be 1 to {most}, not {count}")
    return count


class _Definition:
    """What the compiled module calls: the functions, whose results are checked."""

    # Sites of the mesh at which derivatives are compared with differences, and their step, as a
    # share of the element's size. They must agree to a hundredth at half of the sites at least:
    # more would refuse functions in single precision, or with kinks or poles at some elements.
    SITES, STEP, AGREE = 16, 1e-4, 1e-2

    def __init__(self, title, function, elements, vertices, values, constants, is_sum):
        self.title, self.function, self.elements = title, function, elements
        self.vertices, self.values, self.constants = vertices, values, constants
        self.is_sum = is_sum

    def refuse(self, text):
        raise InvalidOptions(f"{self.title}: {text}")

    def evaluate(self, x, constants):
        """Values, k x d, and derivatives, k x v x d x 3."""
        values, derivatives = self.pair(self.function(x.copy(), **constants), "the function")
        shape = (len(x), self.values)
        values = self.numbers(values, "values", shape, x)
        derivatives = self.numbers(derivatives, "derivatives", (*shape, self.vertices, 3), x)
        return values, np.ascontiguousarray(derivatives.transpose(0, 2, 1, 3))

    def pair(self, result, who):
        if not isinstance(result, (tuple, list)) or len(result) != 2:
            self.refuse(f"{who} must return two arrays, not {type(result).__name__}")
        return result

    def array(self, given, what, kinds, kind):
        try:
            array = np.asarray(given)
        except Exception as error:
            raise InvalidOptions(f"{self.title}: {what} are no array: {error}") from error
        if array.dtype.kind not in kinds:
            self.refuse(f"{what} must be numbers, not {array.dtype}")
        return np.ascontiguousarray(array, dtype=kind)

    def numbers(self, given, what, shape, x):
        array = self.array(given, what, "fiu", np.float64)
        if array.shape != shape and not (
            self.values == 1 and array.shape == (*shape[:1], *shape[2:])
        ):
            self.refuse(
                f"the function returned {what} of shape {array.shape} where {shape} is needed, for "
                f"{shape[0]} elements of {self.vertices} vertices with {self.values} values"
            )
        array = array.reshape(shape)
        finite = np.isfinite(array).reshape(len(x), -1).all(axis=1)
        if not finite.all():
            site = int(np.argmin(finite))
            self.refuse(
                f"the function returned {what} {array[site].tolist()}, which are not finite, at "
                f"x[{site}] = {x[site].tolist()}"
            )
        return array

    def freeze(self, basis):
        """Elements, weights and constants on a mesh."""
        result = self.elements(basis)
        if self.constants:
            if not isinstance(result, (tuple, list)) or len(result) != 3:
                self.refuse("`elements` must return elements, weights and a dict of constants")
            *result, constants = result
        else:
            constants = {}
        stencils, weights = self.pair(result, "`elements`")
        stencils = self.array(stencils, "elements", "iu", np.int32)
        if stencils.size == 0:
            stencils = stencils.reshape(0, self.vertices)
        if stencils.ndim != 2 or stencils.shape[1] != self.vertices:
            self.refuse(f"elements have shape {stencils.shape} instead of m x {self.vertices}")
        weights = self.array(weights, "weights", "fiu", np.float64)
        wanted = (1,) if self.is_sum else (len(stencils),)
        if weights.shape != wanted:
            self.refuse(f"weights have shape {weights.shape} instead of {wanted}")
        if not isinstance(constants, dict) or set(constants) != set(self.constants):
            self.refuse(f"the constants must be {', '.join(self.constants)}, not {constants!r}")
        constants = {name: float(constants[name]) for name in self.constants}
        points = basis.poses[0]
        if len(stencils) and 0 <= stencils.min() and stencils.max() < len(points):
            chosen = np.unique(np.linspace(0, len(stencils) - 1, self.SITES).astype(int))
            self.compare(points[stencils[chosen]], constants)
        return stencils, weights, list(constants.values())

    def compare(self, x, constants):
        """Refuses derivatives that differences contradict at most of the sites."""
        extent = np.linalg.norm(x - x[:, :1], axis=(1, 2))
        steps = self.STEP * np.where(extent > 0, extent, 1)
        ways = np.eye(3 * self.vertices).reshape(-1, 1, self.vertices, 3) * steps[:, None, None]
        ends = np.concatenate([x - ways, x + ways]).reshape(-1, self.vertices, 3)
        values, _ = self.evaluate(ends, constants)
        before, after = values.reshape(2, len(ways), len(x), self.values)
        found = (after - before) / (2 * steps[:, None])  # coordinates x sites x values
        _, derivatives = self.evaluate(x, constants)
        said = derivatives.transpose(1, 3, 0, 2).reshape(found.shape)
        off = np.abs(said - found).max(axis=0)
        wrong = off > self.AGREE * np.maximum(np.abs(said), np.abs(found)).max(axis=0)
        bad = wrong.any(axis=1)
        if bad.mean() <= 0.5:
            return
        site = int(np.argmax(bad))
        value = int(np.argmax(wrong[site]))
        at = int(np.argmax(np.abs(said - found)[:, site, value]))
        self.refuse(
            f"the derivatives are not those of the values: of value {value} by coordinate "
            f"{'xyz'[at % 3]} of vertex {at // 3} it is {said[at, site, value]:.6g}, where "
            f"differences of values say {found[at, site, value]:.6g}, at x = {x[site].tolist()}"
        )
