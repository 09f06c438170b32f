"""Input and result of a computation, the same for all engines."""

from dataclasses import dataclass, field

from .topology import Topology


@dataclass
class Body:
    """Poses of one mesh, with names for messages."""

    names: list
    shapes: list  # n x 3 each
    topology: Topology


@dataclass
class Task:
    """A motion through poses, perhaps continued, perhaps transferred to other bodies."""

    poses: Body
    shapes: int  # between neighbouring poses; 0, which only a transfer may have: poses alone
    metric: str  # a preset of the metric
    steps: int = 0  # beyond the last pose
    ends: str = ""  # of a spline, "natural" or "periodic"; else a chain of geodesics
    modes: int | None = None  # instead of a motion: the average and this number of modes
    targets: list = field(default_factory=list)  # bodies of one pose each


@dataclass
class Result:
    """Motions, and what is worth saying about them."""

    motions: list  # k x n x 3 each: one of the poses' body, or one of each target
    notes: list
