"""The functions of the package."""

import json
import operator
import os
import typing
from html import escape

import numpy as np

from . import _core
from ._core import Handle, Metric, Path, Poses, SurfaceMap
from ._options import takes
from ._progress import told
from ._warn import warn


def _shown(result):
    return f"{result.path._repr_html_()}<pre>{escape(repr(result.summary))}</pre>"


class GeodesicResult(typing.NamedTuple):
    """A path and how it was found."""

    path: Path
    summary: _core.GeodesicSummary

    _repr_html_ = _shown


class SplineResult(typing.NamedTuple):
    """A smooth path and how it was found."""

    path: Path
    summary: _core.SplineSummary

    _repr_html_ = _shown


class StandingResult(typing.NamedTuple):
    """A path whose parts stand, and how they were held."""

    path: Path
    summary: _core.StandingSummary

    _repr_html_ = _shown


class AverageResult(typing.NamedTuple):
    """The mean of poses, n x 3, and how good it is."""

    shape: np.ndarray
    summary: _core.AverageSummary


class ExponentialResult(typing.NamedTuple):
    """A path that goes on, and how it was found."""

    path: Path
    summary: _core.ExponentialSummary

    _repr_html_ = _shown


class CorrectionResult(typing.NamedTuple):
    """A corrected path, and what the correction cost."""

    path: Path
    summary: _core.CorrectionSummary

    _repr_html_ = _shown


class DeformationResult(typing.NamedTuple):
    """A path from a mesh to the deformed one, and how it was found."""

    path: Path
    summary: _core.DeformationSummary

    _repr_html_ = _shown


class RepairResult(typing.NamedTuple):
    """A path from a reference to the repaired shape, and what was restored."""

    path: Path
    summary: _core.RepairSummary

    _repr_html_ = _shown


class TransferResult(typing.NamedTuple):
    """The target's path; the hybrids', or None; and how they were found."""

    path: Path
    hybrids: typing.Optional[Path]
    summary: _core.TransferSummary

    _repr_html_ = _shown


class PoseTransferResult(typing.NamedTuple):
    """The target in every pose, as a path; hybrids, or None; and how they were found."""

    path: Path
    hybrids: typing.Optional[Path]
    summary: _core.PoseTransferSummary

    _repr_html_ = _shown


class TransportResult(typing.NamedTuple):
    """Tangents at the last shape of a path, k x n x 3, and how they were carried there."""

    tangents: np.ndarray
    summary: _core.TransportSummary


class ExploreResult(typing.NamedTuple):
    """A space of poses, and how it was made."""

    space: _core.Space
    summary: _core.ExploreSummary


class Finding(typing.NamedTuple):
    """One thing found in a mesh."""

    severity: str
    kind: str
    message: str


def _as(kind, value, name):
    """The value, which must be of a class of the package."""
    if not isinstance(value, kind):
        raise TypeError(f"{name}: must be a {kind.__name__}, not {type(value).__name__}")
    return value


def _count(value, name):
    try:
        whole = isinstance(value, (float, np.floating)) and value.is_integer()
        return operator.index(int(value) if whole else value)
    except TypeError:
        shown = repr(value) if np.ndim(value) == 0 else type(value).__name__
        raise TypeError(f"{name}: must be int, not {shown}") from None


def _is_file(value):
    return isinstance(value, (str, os.PathLike))


def _is_pair(value):
    """Whether it is (vertices, faces)."""
    return isinstance(value, tuple) and len(value) == 2 and all(np.ndim(part) == 2 for part in value)


def _has_mesh(value):
    """Whether it is one or several shapes together with their faces."""
    return isinstance(value, Poses) or _is_file(value) or _is_pair(value)


def _leave_out(faces, what_has):
    if faces is not None:
        raise TypeError(f"faces: leave them out, since {what_has} a mesh already")


def _of_pairs(pairs, name):
    """Poses of (vertices, faces) each, with the same faces."""
    first = np.asarray(pairs[0][1])
    for i, (_, faces) in enumerate(pairs):
        if not np.array_equal(np.asarray(faces), first):
            raise ValueError(
                f"{name}[{i}]: has other faces than {name}[0]; `correspond` fits a mesh"
            )
    return _core.make_poses([vertices for vertices, _ in pairs], first, name)


def _poses(poses, faces, more=(), name="poses"):
    """Poses of anything that has some: Poses, names of files, pairs of vertices and faces, or
    vertices with `faces`; all in one sequence, or one by one, the faces last."""
    if _is_file(faces) or _is_pair(faces):
        poses, faces = [poses, faces, *more], None
    elif more:
        poses, faces = [poses, faces, *more[:-1]], more[-1]
    alone = _is_file(poses) or (faces is None and _is_pair(poses))
    several = [poses] if alone else poses
    read_poses = isinstance(several, (list, tuple)) and len(several) > 0
    if isinstance(poses, Poses):
        own = poses
    elif read_poses and all(map(_is_file, several)):
        own = read(*several)
    elif read_poses and all(map(_is_pair, several)):
        own = _of_pairs(several, name)
    else:
        return _core.make_poses(poses, faces, name)
    _leave_out(faces, f"{name} have")
    return own


def _told(result):
    """The result of a solve, with a warning if it did not converge, unless `progress` ended it."""
    summary = result.summary
    reason = getattr(summary, "termination", "not_converged")
    if not summary.converged and reason != "cancelled":
        warn(f"the solve did not converge ({reason}): the summary says how far it is")
    return result


def _handles(handles):
    if len(handles) == 0:
        raise ValueError("handles: is empty; give at least one Handle")
    return [_as(Handle, handle, f"handles[{i}]") for i, handle in enumerate(handles)]


def _mesh(vertices, faces, name="vertices", name_of_faces="faces"):
    """One shape with its mesh."""
    if faces is None and _is_pair(vertices):
        return _core.make_mesh(*vertices, f"{name}[0]", f"{name}[1]")
    if _is_file(vertices):
        vertices = read(vertices)
    if isinstance(vertices, Poses):
        if faces is not None:
            raise TypeError(f"{name_of_faces}: leave them out, since {name} has a mesh already")
        if len(vertices) != 1:
            raise ValueError(f"{name}: must be one shape, and there are {len(vertices)} poses")
        return vertices
    return _core.make_mesh(vertices, faces, name, name_of_faces)


def _take_mesh(arguments, name):
    """The mesh that the first of the arguments is, or the first two, vertices and faces, are."""
    first = arguments.pop(0)
    if _has_mesh(first) or not arguments:
        return _mesh(first, None, name, f"the faces of {name}")
    return _mesh(first, arguments.pop(0), name, f"the faces of {name}")


def _without_faces(faces, last):
    """Faces, which were left out if the argument after them is missing, and that argument."""
    return (None, faces) if last is None else (faces, last)


def _pose_of(shape, mesh, name):
    """The vertices of a shape of a mesh; if the shape brings faces, they must be the mesh's."""
    if not _has_mesh(shape):
        return shape
    own = _mesh(shape, None, name)
    if len(own[0]) == len(mesh[0]) and not np.array_equal(own.faces, mesh.faces):
        raise ValueError(f"{name}: has other faces than the mesh; `correspond` fits a mesh")
    return own[0]


def read(
    *files,
    stiffeners=None,
    allow_nonmanifold=False,
    open_seams=False,
    mirror=None,
    allow_mirrored=False,
    allow_mismatch=False,
    loose_components=False,
    allow_outside_files=False,
):
    """Read poses of one mesh.

    Parameters
    ----------
    *files : str or path-like, or one list of them
        One or more OBJ, PLY, OFF, STL, glTF (.glb, .gltf) or VTK (.vtk, .vtp) files, with the same
        faces in the same order. The morph targets of a glTF file are poses too, and so are the
        frames of a point cache (.pc2, .mdd) after the mesh that it moves.
    stiffeners : str or path-like, optional
        File of further edges that the metric is to hold: two vertex numbers a line, from 1.
    allow_nonmanifold : bool, optional
        Take non-manifold or inconsistently wound meshes, with a warning.
    open_seams : bool, optional
        Leave the surface open where borders lie on each other in all poses, as lips do that never
        part. By default their vertices are one point of the surface, which `Poses.notes` says.
    mirror : {'x', 'y', 'z'}, optional
        Poses that are mirror images of the first have this coordinate's sign changed. Without it
        they are refused.
    allow_mirrored : bool, optional
        Take poses that look like mirror images of the first as they are, with a warning: domes
        that are pushed through, bodies that are turned inside out.
    allow_mismatch : bool, optional
        Take poses as they are, with a warning, whose units or order of vertices seem to be others
        than those of the first.
    loose_components : bool, optional
        Leave connected components loose, such as eyes and clothes, that stay near others in all
        poses. Otherwise they are tied to these by stiffeners, and `Poses.notes` says how many.
    allow_outside_files : bool, optional
        Read buffers of a .gltf file from outside of its folder too: for files that are trusted.

    Returns
    -------
    Poses

    Raises
    ------
    FileError
        A file cannot be read or understood.
    MeshError
        A mesh cannot serve.
    MismatchError
        The meshes are not poses of one; the message names the first difference.
    """
    if len(files) == 1 and isinstance(files[0], (list, tuple)):
        files = files[0]
    names = [os.fspath(file) for file in files]
    rest = "" if stiffeners is None else os.fspath(stiffeners)
    return _core.read(
        names,
        rest,
        allow_nonmanifold,
        open_seams,
        mirror,
        allow_mirrored,
        allow_mismatch,
        loose_components,
        allow_outside_files,
    )


def write(file, vertices, faces=None):
    """Write a mesh; the file appears whole or not at all. A path has its own `write`.

    Parameters
    ----------
    file : str or path-like
        An .obj, .ply, .off or .stl file. Except for .stl, which has single precision, coordinates
        read back as they were, to the last bit.
    vertices : array_like, Poses of one shape, name of a file, or (vertices, faces)
        n x 3.
    faces : array_like, or an object with a mesh, optional
        As for `Poses`. Of poses that were read, polygons, materials and textures are written too.

    Returns
    -------
    list of str
        What of the mesh's appearance the file cannot hold: mostly nothing.
    """
    if isinstance(vertices, Path):
        raise TypeError("vertices: a Path has many shapes; its own `write` takes the file's name")
    if faces is None and _is_pair(vertices):
        vertices, faces = vertices
    elif faces is None and _has_mesh(vertices):
        faces = _mesh(vertices, None)
        vertices = faces[0]
    return _core.write(os.fspath(file), vertices, faces)


def check(vertices, faces=None):
    """Find what is worth saying about a mesh.

    Parameters
    ----------
    vertices : array_like, or (vertices, faces)
        n x 3.
    faces : array_like, optional
        m x 3 integers counted from 0, or a list of polygons.

    Returns
    -------
    list of Finding
        In order of falling severity: 'fatal', 'non-manifold', 'warning', 'note'. Messages count
        vertices and faces from 1, as files do.
    """
    if faces is None and _is_pair(vertices):
        vertices, faces = vertices
    return [Finding(*finding) for finding in _core.check(vertices, faces)]


def body(name, triangles=0):
    """Make a body whose poses are given by one parameter, to try things on.

    Parameters
    ----------
    name : str
        'tube', 'bar', 'sheet', ...; any other name raises an error that lists them all.
    triangles : int, optional
        About how many; 0 stands for the body's own number.

    Returns
    -------
    Body
    """
    return _core.body(name, triangles)


def skinned_body(name, triangles=0, proportions=""):
    """Make a body with bones, whose poses have names, to try things on.

    Parameters
    ----------
    name : str
        'quadruped'.
    triangles : int, optional
        About how many; 0 stands for the body's own number.
    proportions : str, optional
        'normal', 'long', 'short' or 'heavy'.

    Returns
    -------
    SkinnedBody
    """
    return _core.skinned_body(name, triangles, proportions)


@takes("FilmStripOptions")
def film_strip(shapes, faces=None, *more, **options):
    """Draw shapes side by side.

    Parameters
    ----------
    shapes : Path, or as the poses of `interpolate`
        Of a path, given shapes are blue, those between them green, extrapolated ones purple, and
        each has its number and time below it.
    faces, *more
        As for `interpolate`.
    {options}

    Returns
    -------
    Image
    """
    if isinstance(shapes, Path):
        _leave_out(faces, "the path has")
        return shapes._film_strip(options)
    return _core.film_strip(_poses(shapes, faces, more, "shapes"), options)


@takes("GeodesicOptions")
def interpolate(poses, faces=None, *more, progress=None, **options):
    """Find the geodesic through two or more poses.

    Parameters
    ----------
    poses : Poses, or sequence of array_like, of names of files, or of pairs (vertices, faces)
        Vertices of each pose, n x 3, in any unit. Poses are aligned rigidly first.
    faces : array_like, optional
        Triangles that all poses share, m x 3, or anything else that `Poses` takes.
    *more
        Poses may be given one by one, and their faces last: ``interpolate(V0, V1, F)``.
    progress : callable or bool, optional
        Called as progress(stage, done, total, share); `share` of the work is done, or None if that
        is not known. If it returns False, the best path so far is returned; before there is one,
        `Cancelled` is raised. True shows a bar.
    {options}

    Returns
    -------
    GeodesicResult
        The path, with the poses among its shapes, and a summary. Look at `summary.converged`.

    Raises
    ------
    MeshError, MismatchError, InvalidOptions
        The arguments cannot serve.
    SolverError
        The memory limit, or poses that turn too far for a rigid metric.
    Cancelled
        `progress` returned False before there was any path.

    Notes
    -----
    A frozen `Metric` as `metric` makes several paths comparable. See Kilian, Mitra and Pottmann,
    "Geometric Modeling in Shape Space" (SIGGRAPH 2007), section 3.
    """
    poses = _poses(poses, faces, more)
    with told(progress) as report:
        return _told(GeodesicResult(*_core.interpolate(poses, options, report)))


def _path(path, faces, geodesic, report, name):
    """A path as it is, or the geodesic through poses."""
    if not isinstance(path, Path):
        poses = _poses(path, faces, name=name)
        return _told(GeodesicResult(*_core.interpolate(poses, dict(geodesic), report))).path
    _leave_out(faces, f"{name} has")
    return path


@takes("SkinningOptions")
def skin(shapes, faces=None, *more, bones=20, progress=None, **options):
    """Find bones and weights of vertices that reproduce a motion, for engines and animators.

    Parameters
    ----------
    shapes : Path, or as the poses of `interpolate`
        Of the motion, two or more: they are taken as they are, and not interpolated. Those that
        are no path are evenly spaced in time.
    faces, *more
        As for `interpolate`.
    bones : int or 'auto', optional
        How many, 1 to 500. 'auto': as few as are found with which the error is at most `error`.
        Default: 20.
    progress : callable or bool, optional
        As for `interpolate`; the best bones so far are returned.
    {options}

    Returns
    -------
    Skinning
        Joints, weights, transforms and errors as arrays; its `write` makes a .glb.

    Raises
    ------
    MeshError, InvalidOptions
        The arguments cannot serve.
    Cancelled
        `progress` returned False before there were any bones.

    Notes
    -----
    After B. H. Le and Z. Deng, "Smooth Skinning Decomposition with Rigid Bones" (SIGGRAPH Asia
    2012).
    """
    if bones != "auto":
        for name in {"error", "most_bones"} & set(options):
            raise TypeError(f"{name}: goes with bones='auto'")
        if _count(bones, "bones") < 1:
            raise ValueError(f"bones: must be 1 or more, or 'auto', not {bones!r}")
    options["bones"] = 0 if bones == "auto" else bones
    if isinstance(shapes, Path):
        _leave_out(faces, "the path has")
    else:
        poses = _poses(shapes, faces, more, "shapes")
        shapes = Path(poses, Metric(poses[:1], poses))
    with told(progress) as report:
        result = _told(_core.skin(shapes, options, report))
    for warning in result.summary.warnings:
        warn(warning)
    return result


@takes("SkinningOptions")
def _skin_of_path(self, bones=20, *, progress=None, **options):
    """Find bones and weights that reproduce the motion: `skin`.

    Parameters
    ----------
    bones : int or 'auto', optional
    progress : callable or bool, optional
    {options}

    Returns
    -------
    Skinning
    """
    return skin(self, bones=bones, progress=progress, **options)


_skin_of_path.__name__ = "skin"
Path.skin = _skin_of_path


@takes("SplineOptions")
def spline(poses, faces=None, *more, progress=None, **options):
    """Find a smooth motion through several poses.

    Parameters
    ----------
    poses, faces, *more
        As for `interpolate`; three poses or more, since two give the geodesic.
    progress : callable or bool, optional
        As for `interpolate`.
    {options}

    Returns
    -------
    SplineResult
        The path, with the poses among its shapes, and a summary.

    Raises
    ------
    MeshError, MismatchError, InvalidOptions
        The arguments cannot serve.
    SolverError
        The memory limit.

    Notes
    -----
    The geodesics between neighbouring poses are corrected such that the velocity does not jump at
    the poses: rotations and stretches of triangles follow cubic splines.
    """
    poses = _poses(poses, faces, more)
    with told(progress) as report:
        return _told(SplineResult(*_core.spline(poses, options, report)))


@takes("AverageOptions")
def average(poses, faces=None, *more, progress=None, **options):
    """Find the mean of poses: the shape whose strains and angles are nearest to their means.

    Parameters
    ----------
    poses, faces, *more
        As for `interpolate`.
    progress : callable or bool, optional
        As for `interpolate`.
    {options}

    Returns
    -------
    AverageResult
        The shape, and a summary. `summary.ratio` says how far it can be from the best: 1 is a proof
        that no shape is a better mean, and without `certify` it is not a number.

    Raises
    ------
    MeshError, MismatchError, InvalidOptions
        The arguments cannot serve.
    SolverError
        The memory limit.
    """
    poses = _poses(poses, faces, more)
    with told(progress) as report:
        return _told(AverageResult(*_core.average(poses, options, report)))


def stand(path, parts, *, progress=None):
    """Deform the shapes between the poses of a path such that parts stand, as feet do.

    Parameters
    ----------
    path : Path
        With two poses or more.
    parts : sequence of (vertices, poses)
        `vertices` are the part: numbers of vertices, or a truth value for each. `poses` are the
        first and the last pose between which it stands, counted from 0, or a list of such pairs.
    progress : callable or bool, optional
        As for `interpolate`.

    Returns
    -------
    StandingResult
        The path and a summary. Poses are as they were. While a part stands, its vertices are where
        the poses have them; a smooth path remains smooth.

    Raises
    ------
    InvalidOptions
        A part has no vertex, or one of another part, or poses that the path does not have.
    """
    path = _as(Path, path, "path")
    standing = []
    for vertices, poses in parts:
        single = np.ndim(poses) == 1
        standing.append((vertices, [tuple(pair) for pair in ([poses] if single else poses)]))
    with told(progress) as report:
        return StandingResult(*_core.stand(path, standing, report))


@takes("ExponentialOptions")
def extrapolate(path, faces=None, steps=None, *, geodesic=None, progress=None, **options):
    """Go on along a path, beyond its last shape.

    Parameters
    ----------
    path : Path, or poses as for `interpolate`
        Of two or more shapes. Paths under the strain metric can always go on. Poses are
        interpolated first.
    faces : array_like, optional
        Of poses that are arrays.
    steps : int
        Shapes to add, at the distance in time of the last two: ``extrapolate(path, 3)``,
        ``extrapolate([V0, V1], F, 3)``.
    geodesic : GeodesicOptions, optional
        How poses are interpolated, by default to a tolerance of 1e-6, because errors grow from
        step to step.
    progress : callable or bool, optional
        As for `interpolate`.
    {options}

    Returns
    -------
    ExponentialResult
    """
    faces, steps = _without_faces(faces, steps)
    steps = _count(steps, "steps")
    with told(progress) as report:
        path = _path(path, faces, {"tolerance": 1e-6, **(geodesic or {})}, report, "path")
        return _told(ExponentialResult(*_core.extrapolate(path, steps, options, report)))


@takes("ExponentialOptions")
def shoot(metric, shape, velocity, steps=16, *, progress=None, **options):
    """Follow the geodesic that begins at a shape with a velocity, over unit time.

    Parameters
    ----------
    metric : Metric
    shape, velocity : array_like
        n x 3, in the unit of the metric's poses.
    steps : int, optional
    progress : callable or bool, optional
        As for `interpolate`.
    {options}

    Returns
    -------
    ExponentialResult
    """
    with told(progress) as report:
        metric, steps = _as(Metric, metric, "metric"), _count(steps, "steps")
        shot = _core.shoot(metric, shape, velocity, steps, options, report)
        return _told(ExponentialResult(*shot))


@takes("ExponentialOptions")
def exponential(metric, shape, velocity, steps=16, *, progress=None, **options):
    """Find the end of the geodesic that begins at a shape with a velocity: exp.

    Parameters
    ----------
    metric : Metric
    shape, velocity : array_like
        n x 3, in the unit of the metric's poses.
    steps : int, optional
    progress : callable or bool, optional
        As for `interpolate`.
    {options}

    Returns
    -------
    ndarray
        n x 3.

    Raises
    ------
    SolverError
        Some step did not converge on the mesh itself; `shoot` goes on coarser ones.
    """
    with told(progress) as report:
        metric, steps = _as(Metric, metric, "metric"), _count(steps, "steps")
        return _core.exponential(metric, shape, velocity, steps, options, report)


@takes("LogarithmOptions")
def logarithm(metric, shape, end, steps=16, *, progress=None, **options):
    """Find the initial velocity of the geodesic from one shape to another: log.

    Parameters
    ----------
    metric : Metric
    shape, end : array_like
        n x 3; `end` is first moved rigidly onto `shape`.
    steps : int, optional
        Of the geodesic, at least 2: as many as `exponential` is to make.
    progress : callable or bool, optional
        As for `interpolate`.
    {options}

    Returns
    -------
    ndarray
        n x 3, per unit of time: `exponential` with as many steps leads to `end`.
    """
    with told(progress) as report:
        metric, steps = _as(Metric, metric, "metric"), _count(steps, "steps")
        return _core.logarithm(metric, shape, end, steps, options, report)


@takes("TransportOptions")
def transport(path, tangents, *, progress=None, **options):
    """Carry tangents along a path to its last shape.

    Parameters
    ----------
    path : Path
    tangents : sequence of array_like
        n x 3 each, at the path's first shape.
    progress : callable or bool, optional
        As for `interpolate`.
    {options}

    Returns
    -------
    TransportResult
        Tangents, k x n x 3, and a summary.
    """
    with told(progress) as report:
        carried = _core.transport(_as(Path, path, "path"), tangents, options, report)
        return _told(TransportResult(*carried))


@takes("CorrectionOptions")
def correct_path(path, *, progress=None, **options):
    """Bring the edge lengths of an extrapolated path back towards those of its first shape.

    Parameters
    ----------
    path : Path
    progress : callable or bool, optional
        As for `interpolate`.
    {options}

    Returns
    -------
    CorrectionResult
    """
    with told(progress) as report:
        corrected = _core.correct_path(_as(Path, path, "path"), options, report)
        return _told(CorrectionResult(*corrected))


@takes("TransferOptions")
def transfer(source, target, faces=None, *, geodesic=None, progress=None, **options):
    """Move a body as another one moves.

    Parameters
    ----------
    source : Path, or poses as for `interpolate`
        How the other body moves. Poses are interpolated first.
    target : array_like, name of a file, or (vertices, faces)
        The body in the source's first pose, n x 3, of the same connectivity.
    faces : array_like, optional
        Of poses that are arrays.
    geodesic : GeodesicOptions, optional
        How poses are interpolated.
    progress : callable or bool, optional
        As for `interpolate`.
    {options}

    Returns
    -------
    TransferResult
        The target's path, hybrids (None unless asked for), and a summary.
    """
    with told(progress) as report:
        source = _path(source, faces, geodesic or {}, report, "source")
        shape = _pose_of(target, source, "target")
        return _told(TransferResult(*_core.transfer(source, shape, options, report)))


@takes("TransferOptions")
def transfer_poses(poses, target, faces=None, *, geodesic=None, progress=None, **options):
    """Put a body into the poses of another one.

    Parameters
    ----------
    poses : as for `interpolate`
        The other body's; the first is the pose that the target is in.
    target : array_like, name of a file, or (vertices, faces)
        n x 3, of the same connectivity.
    faces : array_like, optional
        Of both, where the poses are arrays.
    geodesic : GeodesicOptions, optional
        Of the ladder, on which each pose is reached by a geodesic.
    progress : callable or bool, optional
        As for `interpolate`.
    {options}

    Returns
    -------
    PoseTransferResult
        A path of the target in each pose (no motion between them), hybrids (None unless asked
        for), and a summary.
    """
    poses = _poses(poses, faces)
    with told(progress) as report:
        shape = _pose_of(target, poses, "target")
        moved = _core.transfer_poses(poses, shape, geodesic, options, report)
        return PoseTransferResult(*moved)


def read_handles(file, vertices, faces=None):
    """Read a file of handles, as shape-deform does.

    Parameters
    ----------
    file : str or path-like
    vertices, faces
        The mesh, in which the file selects vertices, as for `deform`.

    Returns
    -------
    list of Handle
    """
    return _core.read_handles(os.fspath(file), _mesh(vertices, faces))


@takes("DeformationOptions")
def deform(vertices, faces=None, handles=None, *, progress=None, **options):
    """Deform a mesh by handles.

    Parameters
    ----------
    vertices : array_like, Poses of one shape, name of a file, or (vertices, faces)
        The mesh at rest, n x 3.
    faces : array_like, or an object with a mesh
        As for `Poses`. Left out where the mesh has faces: ``deform("a.obj", handles)``.
    handles : sequence of Handle
        What is held, and where it is to be; `read_handles` reads them.
    progress : callable or bool, optional
        As for `interpolate`.
    {options}

    Returns
    -------
    DeformationResult
        A path from the mesh to the deformed one, which is `path[-1]`, and a summary.
    """
    faces, handles = _without_faces(faces, handles)
    mesh, handles = _mesh(vertices, faces), _handles(handles)
    with told(progress) as report:
        return _told(DeformationResult(*_core.deform(mesh, handles, options, report)))


class Interpolator:
    """Find geodesics between many pairs of shapes of one mesh, all under one metric.

    A geodesic does not depend on those before it. What all of them need is computed once.

    Parameters
    ----------
    poses : Poses, or sequence of array_like
        On which the metric is frozen, and between which the shapes lie.
    faces : array_like, optional
        As for `Poses`.
    {options}
    """

    def __init__(self, poses, faces=None, **options):
        self._poses, self._options = _poses(poses, faces), options
        self._solver = _core._Interpolator(self._poses, options)

    @property
    def metric(self):
        """The metric that all geodesics have."""
        return self._solver.metric

    def between(self, first, last, *, progress=None):
        """Find the geodesic between two shapes.

        Parameters
        ----------
        first, last : array_like
            n x 3.
        progress : callable or bool, optional
            As for `interpolate`.

        Returns
        -------
        GeodesicResult
        """
        ends = Poses([first, last], self._poses)
        with told(progress) as report:
            return _told(GeodesicResult(*self._solver.between(ends, report)))

    def __reduce__(self):
        return _again, (Interpolator, (self._poses, None), self._options)


takes("GeodesicOptions")(Interpolator)


def _again(kind, arguments, options):
    """An object as it was made, in another process."""
    return kind(*arguments, **options)


class Deformer:
    """Deform one mesh again and again, as `deform` does, each time from the last solution.

    Parameters
    ----------
    vertices, faces
        The mesh at rest, as for `deform`.
    **options
        As for `deform`.
    """

    def __init__(self, vertices, faces=None, **options):
        self._mesh, self._options = _mesh(vertices, faces), options
        self._solver = _core._Deformer(self._mesh, options)

    def deform(self, handles, *, progress=None):
        """Deform the mesh.

        Parameters
        ----------
        handles : sequence of Handle
        progress : callable or bool, optional
            As for `interpolate`.

        Returns
        -------
        DeformationResult
        """
        with told(progress) as report:
            return _told(DeformationResult(*self._solver.deform(_handles(handles), report)))

    def __reduce__(self):
        return _again, (Deformer, (self._mesh, None), self._options)


takes("DeformationOptions")(Deformer)


@takes("RepairOptions")
def repair(reference, distorted, faces=None, *, vertices=None, progress=None, **options):
    """Restore a reference's geometry in a distorted pose of the same mesh.

    Parameters
    ----------
    reference, distorted : array_like, Poses of one shape, name of a file, or (vertices, faces)
        n x 3.
    faces : array_like, or an object with a mesh, optional
        As for `Poses`, where the reference is an array.
    vertices : array_like, optional
        Whose places in the distorted shape are to be kept as far as that can be: numbers of
        vertices, or a truth value for each. Without, all.
    progress : callable or bool, optional
        As for `interpolate`.
    {options}

    Returns
    -------
    RepairResult
        A path from the reference to the repaired shape, which is `path[-1]`, and a summary.
    """
    mesh = _mesh(reference, faces, "reference")
    distorted = _pose_of(distorted, mesh, "distorted")
    with told(progress) as report:
        return _told(RepairResult(*_core.repair(mesh, distorted, vertices, options, report)))


class Correspondence:
    """A template fitted onto another body, and the map between the two: what `correspond` returns.

    Attributes
    ----------
    fitted : ndarray
        The template's vertices on the target's surface, n x 3.
    map : SurfaceMap
    markers : ndarray
        k x 2, from 0: those that constrained the fit, given ones and of those that were found up
        to 40.
    summary : CorrespondenceSummary
    """

    def __init__(self, result, template, target, shown):
        self._result = result
        self._template = template
        self._target = target
        self._shown = shown

    @property
    def fitted(self):
        return self._result.fitted

    @property
    def map(self) -> SurfaceMap:
        return self._result.map

    @property
    def markers(self):
        return self._result.markers

    @property
    def summary(self):
        return self._result.summary

    def carry(self, path):
        """Move the target's own mesh as the fitted template moves.

        Parameters
        ----------
        path : Path
            Of the template, from `fitted` on.

        Returns
        -------
        Path
        """
        return self._result.carry(_as(Path, path, "path"), self._target)

    def to_template(self, values):
        """Values at the target's vertices, n or n x d, as values at the template's."""
        return _pull(self._result.map.to_target, self._target, values)

    def to_target(self, values):
        """Values at the template's vertices, n or n x d, as values at the target's."""
        return _pull(self._result.map.to_template, self._template, values)

    def picture(self):
        """A picture to judge the correspondence by."""
        return self._result.picture(self._template, self._target, self._shown)

    def _repr_html_(self):
        return f"{self.picture()._repr_html_()}<pre>{escape(repr(self.summary))}</pre>"

    def __repr__(self):
        return f"<shapespace.Correspondence: {self.summary!r}>"


def _pull(points, mesh, values):
    array = np.asarray(values, dtype=np.float64)
    if array.ndim == 1:
        return points._pull(mesh, array[:, np.newaxis])[:, 0]
    return points._pull(mesh, array)


@takes("CorrespondenceOptions")
def correspond(template, target, *more, markers=None, progress=None, **options):
    """Fit a template onto another body of any connectivity, and map the two onto each other.

    Parameters
    ----------
    template, target : Poses of one shape, name of a file, or (vertices, faces)
        The two meshes. Vertices and faces may also be given one by one:
        ``correspond(V, F, other_V, other_F)``.
    *more
        What of that follows, and `markers`: ``correspond("a.obj", "b.obj", markers)``.
    markers : array_like, optional
        k x 2: a vertex of the template and one of the target that belong together, from 0. With
        fewer than three, further ones are found from the shapes of both bodies.
    progress : callable or bool, optional
        As for `interpolate`.
    {options}

    Returns
    -------
    Correspondence
    """
    arguments = [template, target, *more]
    source = _take_mesh(arguments, "template")
    if not arguments:
        raise TypeError("target: is missing")
    goal = _take_mesh(arguments, "target")
    if len(arguments) > (1 if markers is None else 0):
        raise TypeError("correspond: takes a template, a target and markers, and no more")
    markers = arguments[0] if arguments else markers
    with told(progress) as report:
        result = _told(_core.correspond(source, goal, markers, options, report))
    shown = result.markers if result.summary.candidates else markers
    return Correspondence(result, source, goal, shown)


def read_surface_map(file, template, target):
    """Read a map that `SurfaceMap.write` or shape-correspond wrote.

    Parameters
    ----------
    file : str or path-like
    template, target : as for `correspond`
        The two meshes.

    Returns
    -------
    SurfaceMap
    """
    return SurfaceMap._read(file, _mesh(template, None, "template"), _mesh(target, None, "target"))


def read_markers(file, template, target):
    """Read a file of markers, as shape-correspond does.

    Parameters
    ----------
    file : str or path-like, or two of them
        Pairs of vertices; or two files of landmarks, the template's and the target's: .fcsv or
        .mrk.json of 3D Slicer, or text with x y z in each line.
    template, target : as for `correspond`
        The two meshes.

    Returns
    -------
    ndarray
        k x 2, from 0.
    """
    template, target = _mesh(template, None, "template"), _mesh(target, None, "target")
    if isinstance(file, (tuple, list)):
        if len(file) != 2:
            raise ValueError("file: name one file of pairs of vertices, or two files of landmarks")
        first, second = map(os.fspath, file)
        return _core.match_landmarks(first, second, template, target)
    return _core.read_markers(os.fspath(file), template, target)


def read_vertex_field(source):
    """Read one number a vertex, such as a stiffness.

    Parameters
    ----------
    source : str or path-like
        A text with a number a line, or "body.ply:name" for a property of a PLY file's vertices;
        of "body.vtk:name" and "body.vtp:name" an array of the point data.

    Returns
    -------
    ndarray
        In the order of the mesh.
    """
    return _core.read_vertex_field(os.fspath(source))


def select(vertices, faces=None, selection=None):
    """Find the vertices that a selection names, as the files of handles have it.

    Parameters
    ----------
    vertices, faces
        The mesh, n x 3, as for `deform`: ``select("a.obj", selection)``.
    selection : dict or str
        Such as ``{"ball": {"centre": [0, 0, 0], "radius": 2}}``, or that as JSON; 'vertices' in it
        are counted from 1 (docs/file-formats.md).

    Returns
    -------
    ndarray
        Numbers of vertices, counted from 0.
    """
    faces, selection = _without_faces(faces, selection)
    text = selection if isinstance(selection, str) else json.dumps(selection)
    return _core.select(_mesh(vertices, faces), text)


def intersections(shapes, faces=None, *more):
    """Count the pairs of triangles of a body that pass through each other.

    Parameters
    ----------
    shapes : array_like, or as the poses of `interpolate`
        n x 3 each; one is enough.
    faces, *more
        As for `interpolate`.

    Returns
    -------
    ndarray
        Of each shape the number of pairs that have no vertex in common; triangles that only touch
        do not count.
    """
    if isinstance(shapes, np.ndarray) and shapes.ndim == 2 and not more:
        shapes = [shapes]
    return _core.intersections(_poses(shapes, faces, more, "shapes"))


class EmbeddingResult(typing.NamedTuple):
    """Points of the plane, k x 2, and how well their distances are those that were given."""

    points: np.ndarray
    stress: float
    converged: bool


@takes("EmbeddingOptions")
def embed(distances, **options):
    """Place objects on the plane, of which only the distances are known.

    Parameters
    ----------
    distances : array_like
        k x k, symmetric: such as `distance_matrix` returns.
    {options}

    Returns
    -------
    EmbeddingResult
        Kruskal's stress is 0 where the plane has all distances.
    """
    return EmbeddingResult(*_core.embed(distances, options))


def triangulate(points):
    """The Delaunay triangulation of points of the plane.

    Parameters
    ----------
    points : array_like
        k x 2.

    Returns
    -------
    ndarray
        Three numbers of points a row, counterclockwise; no row if all points lie on a line.
    """
    return _core.triangulate(points)


class BlendErrors(typing.NamedTuple):
    """How far blends of a space are from blends along geodesics.

    `mean` and `max` are shares of the greatest distance between two poses; `within` is the share of
    the samples that are within the threshold.
    """

    mean: float
    max: float
    within: float


@takes("ExploreOptions")
def measure_blends(space, samples=100, *, progress=None, **options):
    """Compare shapes of a space with blends along geodesics, at random points of its plane.

    Parameters
    ----------
    space : Space
    samples : int, optional
    progress : callable or bool, optional
        As for `interpolate`.
    {options}

    Returns
    -------
    BlendErrors
    """
    space, samples = _as(_core.Space, space, "space"), _count(samples, "samples")
    with told(progress) as report:
        return BlendErrors(*space._measure_blends(samples, options, report))


def read_curve(file, space):
    """Read a curve on the plane of a space, as shape-explore does.

    Parameters
    ----------
    file : str or path-like
    space : Space

    Returns
    -------
    ndarray
        k x 2, for `Space.along`.
    """
    return _as(_core.Space, space, "space")._read_curve(file)


@takes("ExploreOptions")
def distance_matrix(poses, faces=None, *more, progress=None, **options):
    """Measure the lengths of the geodesics between every two poses.

    Parameters
    ----------
    poses, faces, *more
        As for `interpolate`.
    progress : callable or bool, optional
        As for `interpolate`.
    {options}

    Returns
    -------
    ndarray
        k x k, symmetric: pure numbers.
    """
    poses = _poses(poses, faces, more)
    with told(progress) as report:
        return _core.distance_matrix(poses, options, report)


@takes("ExploreOptions")
def explore(poses, faces=None, *more, names=(), progress=None, **options):
    """Spread poses out on a plane, with the shapes between them.

    Parameters
    ----------
    poses, faces, *more
        As for `interpolate`.
    names : sequence of str, optional
        Of the poses. Without, those of `Poses.names`, without folders.
    progress : callable or bool, optional
        As for `interpolate`.
    {options}

    Returns
    -------
    ExploreResult
        The `Space` and a summary.
    """
    poses = _poses(poses, faces, more)
    with told(progress) as report:
        return ExploreResult(*_core.explore(poses, list(names), options, report))


def compare_shapes(metric, reference, shape):
    """Measure how far a shape is from another one in what rigid motion does not change.

    Parameters
    ----------
    metric : Metric
    reference, shape : array_like
        n x 3, in one unit.

    Returns
    -------
    ShapeError
    """
    return _core.compare_shapes(_as(Metric, metric, "metric"), reference, shape)


def set_threads(threads):
    """Let solvers use so many threads from now on; 0 stands for one a core.

    Results do not depend on it.
    """
    _core.set_threads(threads)


def threads():
    """The number of threads in use."""
    return _core.threads()
