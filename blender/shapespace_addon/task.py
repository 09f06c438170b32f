"""Input and result of a computation, the same for all engines."""

from dataclasses import dataclass, field

import numpy as np

from .topology import Topology


@dataclass
class Body:
    """Poses of one mesh, with names for messages."""

    names: list
    shapes: list  # n x 3 each
    topology: Topology


@dataclass
class Metric:
    """What motions cost, and of what surface. None stands for the preset's own, or without a preset
    for what suits the mesh."""

    preset: str = ""
    bending: float | None = None
    volume: float | None = None
    stiffness: np.ndarray | None = None  # n factors
    loose_components: bool = False  # that stay near others, and would be tied to these
    open_seams: bool = False  # where borders lie on each other in all poses


@dataclass
class Task:
    """A motion through poses, perhaps continued, perhaps transferred to other bodies."""

    poses: Body
    shapes: int  # between neighbouring poses; 0, which only a transfer may have: poses alone
    metric: Metric
    steps: int = 0  # beyond the last pose
    ends: str = ""  # of a spline, "natural" or "periodic"; else a chain of geodesics
    avoid_contact: bool = False  # with no steps
    modes: int | None = None  # instead of a motion: the average and this number of modes
    targets: list = field(default_factory=list)  # bodies of one pose each
    tolerance: float | None = None
    allow_mirrored: bool = False  # poses that look like mirror images of the first
    anchor: np.ndarray | None = None  # numbers of vertices
    ground: float | None = None  # the third coordinate of each shape's lowest vertex


@dataclass
class Motion:
    """A turn by `angle`, in radians, about an axis through a point, and then a translation."""

    axis: np.ndarray
    angle: float
    point: np.ndarray
    translation: np.ndarray


@dataclass
class Handle:
    """Vertices that stay or, with a motion, are moved. Met exactly unless there is a weight."""

    name: str
    vertices: np.ndarray
    motion: Motion | None
    weight: float | None


@dataclass
class Deformation:
    """A mesh to be deformed by handles."""

    poses: Body  # one shape
    handles: list
    shapes: int  # on the way, the deformed one included
    balance: float
    metric: Metric
    tolerance: float | None = None


@dataclass
class Repair:
    """A distorted pose to be given the geometry of a sound one."""

    poses: Body  # two shapes: the distorted, and the sound
    kept: np.ndarray | None  # vertices whose positions count; None: all
    balance: float
    metric: Metric
    tolerance: float | None = None


@dataclass
class Fit:
    """A template to be fitted onto a body of other faces."""

    poses: Body  # the template, one shape
    targets: list  # the body, of one shape
    markers: list = field(default_factory=list)  # pairs of a vertex of each that belong together
    open_seams: bool = False

    @property
    def finds_markers(self) -> bool:
        """Whether others are found beside them: a few decide between maps, and do not make one."""
        return len(self.markers) <= 10


@dataclass
class Skinning:
    """A motion to be reproduced by bones."""

    poses: Body  # a shape for each moment, the first one at rest
    bones: int | None  # None: as few as `error` needs
    error: float  # permitted rms distance, as a share of half the diagonal
    weights: int  # bones that may move a vertex
    scale: bool  # whether bones may be stretched
    open_seams: bool = False


@dataclass
class Result:
    """Motions, and what is worth saying about them."""

    motions: list  # k x n x 3 each: one of the poses' body, or one of each target; or a `Skin`
    notes: list
    report: dict  # of the last solve, as --report report.json of the tools has it
